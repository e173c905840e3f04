// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/row_sum.hpp"

#include <sqlite3.h>

#include <bit>
#include <cstdint>
#include <span>

namespace deltamap::mapping::store {
namespace {

class Sum {
 public:
  void add(std::uint8_t byte) { value_ = (value_ ^ byte) * 1099511628211ULL; }
  void add_word(std::uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8) add(static_cast<std::uint8_t>(word >> shift));
  }
  void add(sqlite3_value* argument) {
    const int type = sqlite3_value_type(argument);
    add(static_cast<std::uint8_t>(type));
    if (type == SQLITE_INTEGER) {
      add_word(static_cast<std::uint64_t>(sqlite3_value_int64(argument)));
    } else if (type == SQLITE_FLOAT) {
      add_word(std::bit_cast<std::uint64_t>(sqlite3_value_double(argument)));
    } else if (type != SQLITE_NULL) {  // text or a blob
      const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_value_blob(argument));
      const auto size = static_cast<std::size_t>(sqlite3_value_bytes(argument));
      add_word(size);
      for (const std::uint8_t byte : std::span(bytes, size)) add(byte);
    }
  }
  [[nodiscard]] std::int64_t value() const { return std::bit_cast<std::int64_t>(value_); }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

void row_sum(sqlite3_context* context, int count, sqlite3_value** arguments) {
  Sum sum;
  for (sqlite3_value* argument : std::span(arguments, static_cast<std::size_t>(count))) sum.add(argument);
  sqlite3_result_int64(context, sum.value());
}

}  // namespace

void add_row_sum(sqlite3* connection) {
  sqlite3_create_function_v2(connection, "row_sum", -1, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY, nullptr,
                             row_sum, nullptr, nullptr, nullptr);
}

}  // namespace deltamap::mapping::store
