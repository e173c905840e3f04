// SPDX-License-Identifier: Apache-2.0
// A thin hold on SQLite: opens a file, runs statements, and turns every failure into one line that names the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/store/store_error.hpp"

struct sqlite3;
struct sqlite3_stmt;
struct sqlite3_value;

namespace deltamap::mapping::store {

class Statement;

/// What stands in a column of a row, kept beyond the row.
using Value = std::shared_ptr<sqlite3_value>;

class Database {
 public:
  /// kReadAsIs looks at the file alone: not at its log, and at nobody's locks. kMemory: a new database in memory, which
  /// has no more of the file than its name.
  enum class Mode : std::uint8_t { kCreate, kExisting, kRead, kReadAsIs, kMemory };

  /// Throws StoreError, as everything here does.
  Database(std::filesystem::path file, Mode mode);
  ~Database();
  Database(Database&& other) noexcept;
  Database& operator=(Database&&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  void run(const std::string& sql);
  /// The first column of the first row.
  [[nodiscard]] std::int64_t number(const std::string& sql);
  [[nodiscard]] std::string text(const std::string& sql);
  /// Puts what lies in the log into the file, where nobody reads it just now and there is room: else the next one does.
  void empty_log();
  [[noreturn]] void fail(const std::string& why, StoreError::Kind kind = StoreError::Kind::kOther) const;
  /// The file is damaged or no map store.
  [[noreturn]] void fail_as_unsound(const std::string& why) const { fail(why, StoreError::Kind::kUnsound); }

 private:
  friend class Statement;
  [[noreturn]] void fail_by_code() const;
  std::filesystem::path file_;
  sqlite3* handle_ = nullptr;
};

/// True where this user may not write the file or a log beside it, and no log lies there: the file then holds all, and
/// no program is writing to it.
[[nodiscard]] bool is_read_as_is(const std::filesystem::path& file);

/// One prepared statement: bind in order, then step.
class Statement {
 public:
  Statement(Database& database, std::string_view sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(std::int64_t value);
  Statement& bind(double value);
  Statement& bind(const std::string& value);
  /// An empty blob binds NULL.
  Statement& bind(std::span<const std::uint8_t> blob);
  /// NULL.
  Statement& skip();
  Statement& bind(const Value& value);

  /// Is there a (further) row?
  bool step();
  /// Anew, with this as the one value that is bound: is there a row, and can it be read?
  bool finds(std::int64_t value);

  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] std::int64_t number(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::vector<std::uint8_t> blob(int column) const;
  [[nodiscard]] Value value(int column) const;

 private:
  Database& database_;
  sqlite3_stmt* handle_ = nullptr;
  int bound_ = 0;
};

/// Everything until commit() happens or nothing of it.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace deltamap::mapping::store
