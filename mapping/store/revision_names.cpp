// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/revision_names.hpp"

#include <algorithm>

namespace deltamap::mapping::store {
namespace {

constexpr std::size_t kLongestName = 80;  // bytes

/// Made with the first name: a store without names stays what older versions know.
constexpr const char* kTable =
    "CREATE TABLE IF NOT EXISTS named (map INTEGER, number INTEGER, name TEXT NOT NULL, PRIMARY KEY (map, number))";

bool has_names(Database& database) {
  return database.number("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'named'") > 0;
}

bool is_one_line(const std::string& name) {
  return std::none_of(name.begin(), name.end(), [](char letter) {
    const auto byte = static_cast<unsigned char>(letter);
    return byte < 0x20 || byte == 0x7F;
  });
}

void keep_whole(Database& database, std::int64_t map, std::uint32_t number, std::span<const std::uint8_t> grid) {
  Statement row{database, "UPDATE revision SET grid = ? WHERE map = ? AND refused = 0 AND number = ? AND grid IS NULL"};
  row.bind(grid).bind(map).bind(std::int64_t{number});
  row.step();
}

}  // namespace

std::map<std::uint32_t, std::string> names_in(Database& database, std::int64_t map) {
  std::map<std::uint32_t, std::string> names;
  if (!has_names(database)) return names;
  Statement rows{database, "SELECT number, name FROM named WHERE map = ?"};
  rows.bind(map);
  while (rows.step()) names.emplace(static_cast<std::uint32_t>(rows.number(0)), rows.text(1));
  return names;
}

void write_name(Database& database, std::int64_t map, std::uint32_t number, const std::string& name,
                std::span<const std::uint8_t> grid) {
  if (name.size() > kLongestName || !is_one_line(name)) {
    database.fail("a name is one line of at most " + std::to_string(kLongestName) + " bytes");
  }
  Transaction all{database};
  database.run(kTable);
  Statement row{database, name.empty() ? "DELETE FROM named WHERE map = ? AND number = ?"
                                       : "INSERT OR REPLACE INTO named (map, number, name) VALUES (?, ?, ?)"};
  row.bind(map).bind(std::int64_t{number});
  if (!name.empty()) row.bind(name);
  row.step();
  if (!name.empty()) keep_whole(database, map, number, grid);
  all.commit();
}

}  // namespace deltamap::mapping::store
