// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/database.hpp"

#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/files/access.hpp"
#include "mapping/store/database_log.hpp"
#include "mapping/store/row_sum.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr int kBusy_ms = 3000;  // another program may be reading or writing

int flags_of(Database::Mode mode) {
  switch (mode) {
    case Database::Mode::kCreate:
    case Database::Mode::kMemory:
      return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
    case Database::Mode::kExisting:
      return SQLITE_OPEN_READWRITE;
    case Database::Mode::kRead:
      return SQLITE_OPEN_READONLY;
    case Database::Mode::kReadAsIs:
      return SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
  }
  return 0;
}

/// A file URI takes parameters; what would end its path is escaped.
std::string name_of(const std::filesystem::path& file, Database::Mode mode) {
  if (mode == Database::Mode::kMemory) return ":memory:";
  if (mode != Database::Mode::kReadAsIs) return file.string();
  std::string uri = "file:";
  for (const char letter : std::filesystem::absolute(file).string()) {
    if (letter == '?' || letter == '#' || letter == '%') {
      uri += letter == '?' ? "%3f" : letter == '#' ? "%23" : "%25";
    } else {
      uri += letter;
    }
  }
  return uri + "?immutable=1";
}

StoreError::Kind kind_of(int code) {
  switch (code & 0xFF) {
    case SQLITE_ERROR:  // tables or columns are missing
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_FORMAT:
      return StoreError::Kind::kUnsound;
    case SQLITE_READONLY:
      return StoreError::Kind::kReadOnly;
    default:
      return StoreError::Kind::kOther;
  }
}

/// The file itself, and no link to it: its log lies beside that one.
std::filesystem::path folder_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  return (error ? std::filesystem::absolute(file, error) : real).parent_path();
}

/// SQLite has one sentence for all that the system refuses: of the file, or of its log, which lies beside it.
std::string why_refused(const std::filesystem::path& file, int code, const std::string& otherwise) {
  const auto because = [](int reason) { return std::generic_category().message(reason); };
  const bool reads = code == SQLITE_CANTOPEN;
  if (!may_access(file, reads ? R_OK : W_OK) && errno != ENOENT) {
    return (reads ? "cannot be opened: " : "cannot be written: ") + because(errno);
  }
  if (!may_access(folder_of(file), W_OK | X_OK)) {
    return "cannot be opened: its log beside it cannot be written: " + because(errno);
  }
  return otherwise;
}

std::string reason_of(const std::filesystem::path& file, sqlite3* handle, int code) {
  const std::string told = handle == nullptr ? sqlite3_errstr(code) : sqlite3_errmsg(handle);
  const int refusal = code & 0xFF;
  return refusal == SQLITE_CANTOPEN || refusal == SQLITE_READONLY ? why_refused(file, refusal, told) : told;
}

}  // namespace

bool is_read_as_is(const std::filesystem::path& file) {
  if (may_access(file, W_OK) && may_access(folder_of(file), W_OK | X_OK)) return false;
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  return !error && !std::filesystem::exists(log_of(real).log, error) && !error;
}

Database::Database(std::filesystem::path file, Mode mode) : file_{std::move(file)} {
  const int result =
      sqlite3_open_v2(name_of(file_, mode).c_str(), &handle_, flags_of(mode) | SQLITE_OPEN_NOMUTEX, nullptr);
  if (result != SQLITE_OK) {
    const std::string why = reason_of(file_, handle_, result);
    sqlite3_close(handle_);
    handle_ = nullptr;
    fail(why, kind_of(result));
  }
  sqlite3_busy_timeout(handle_, kBusy_ms);
  add_row_sum(handle_);
}

Database::~Database() { sqlite3_close(handle_); }

Database::Database(Database&& other) noexcept
    : file_{std::move(other.file_)}, handle_{std::exchange(other.handle_, nullptr)} {}

void Database::fail(const std::string& why, StoreError::Kind kind) const {
  throw StoreError(file_.string() + ": " + why, kind);
}

void Database::fail_by_code() const {
  const int code = sqlite3_errcode(handle_);
  fail(reason_of(file_, handle_, code), kind_of(code));
}

void Database::run(const std::string& sql) {
  if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail_by_code();
}

/// What lies in the log alone is there once, and all of it from a damaged byte on is as if it had never been written.
void Database::empty_log() {
  sqlite3_busy_timeout(handle_, 0);
  sqlite3_wal_checkpoint_v2(handle_, nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
  sqlite3_busy_timeout(handle_, kBusy_ms);
}

std::int64_t Database::number(const std::string& sql) {
  Statement statement{*this, sql};
  return statement.step() ? statement.number(0) : 0;
}

std::string Database::text(const std::string& sql) {
  Statement statement{*this, sql};
  return statement.step() ? statement.text(0) : std::string{};
}

Statement::Statement(Database& database, std::string_view sql) : database_{database} {
  if (sqlite3_prepare_v2(database.handle_, sql.data(), static_cast<int>(sql.size()), &handle_, nullptr) != SQLITE_OK) {
    database.fail_by_code();
  }
}

Statement::~Statement() { sqlite3_finalize(handle_); }

Statement& Statement::bind(std::int64_t value) {
  sqlite3_bind_int64(handle_, ++bound_, value);
  return *this;
}

Statement& Statement::bind(double value) {
  sqlite3_bind_double(handle_, ++bound_, value);
  return *this;
}

Statement& Statement::bind(const std::string& value) {
  sqlite3_bind_text(handle_, ++bound_, value.c_str(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
  return *this;
}

Statement& Statement::bind(std::span<const std::uint8_t> blob) {
  sqlite3_bind_blob(handle_, ++bound_, blob.empty() ? nullptr : blob.data(), static_cast<int>(blob.size()),
                    SQLITE_TRANSIENT);
  return *this;
}

Statement& Statement::skip() {
  ++bound_;  // what is not bound is NULL
  return *this;
}

Statement& Statement::bind(const Value& value) {
  sqlite3_bind_value(handle_, ++bound_, value.get());
  return *this;
}

bool Statement::step() {
  const int result = sqlite3_step(handle_);
  if (result == SQLITE_ROW) return true;
  if (result != SQLITE_DONE) database_.fail_by_code();
  return false;
}

bool Statement::finds(std::int64_t value) {
  sqlite3_reset(handle_);
  sqlite3_bind_int64(handle_, 1, value);
  return sqlite3_step(handle_) == SQLITE_ROW;
}

bool Statement::is_null(int column) const { return sqlite3_column_type(handle_, column) == SQLITE_NULL; }
std::int64_t Statement::number(int column) const { return sqlite3_column_int64(handle_, column); }
double Statement::real(int column) const { return sqlite3_column_double(handle_, column); }

std::string Statement::text(int column) const {
  const auto* text = sqlite3_column_text(handle_, column);
  return text == nullptr ? std::string{} : std::string{reinterpret_cast<const char*>(text)};
}

std::vector<std::uint8_t> Statement::blob(int column) const {
  const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(handle_, column));
  const int size = sqlite3_column_bytes(handle_, column);
  return bytes == nullptr ? std::vector<std::uint8_t>{} : std::vector<std::uint8_t>{bytes, bytes + size};
}

Value Statement::value(int column) const {
  return {sqlite3_value_dup(sqlite3_column_value(handle_, column)), sqlite3_value_free};
}

Transaction::Transaction(Database& database) : database_{database} { database_.run("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const std::exception&) {  // the file is gone or full: SQLite rolls back by itself at the next opening
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
  database_.empty_log();
}

}  // namespace deltamap::mapping::store
