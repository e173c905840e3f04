// SPDX-License-Identifier: Apache-2.0
// A thin hold on SQLite: opens a file, runs statements, and turns every failure into one line that names the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/store/store_error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace deltamap::mapping::store {

class Statement;

class Database {
 public:
  /// kReadAsIs looks at the file alone: not at its log, and at nobody's locks.
  enum class Mode : std::uint8_t { kCreate, kExisting, kRead, kReadAsIs };

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

  /// Is there a (further) row?
  bool step();

  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] std::int64_t number(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::vector<std::uint8_t> blob(int column) const;

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
