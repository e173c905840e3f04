// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/guarded_rows.hpp"

#include <algorithm>

namespace deltamap::mapping::store {
namespace {

constexpr GuardedTable kMapTable{
    .name = "map",
    .copy = "map_copy",
    .columns = "hash, width, height, resolution_m, origin_x_m, origin_y_m, used, provisional",
    .copied = "hash, width, height, resolution_m, origin_x_m, origin_y_m, used, provisional"};

constexpr GuardedTable kRevisionTable{
    .name = "revision",
    .copy = "revision_copy",
    .columns =
        "id, map, number, refused, time_ns, phase, acceptance, cause, occupied, freed, unknown, first_column, "
        "first_row, last_column, last_row, grid_hash, changes, grid, xx_m2, xy_m2, xh_m_rad, yy_m2, yh_m_rad, "
        "hh_rad2, name",
    .copied =
        "id, map, number, refused, time_ns, phase, acceptance, cause, occupied, freed, unknown, first_column, "
        "first_row, last_column, last_row, grid_hash, changes, iif(number = 0 AND refused = 0, grid, NULL), "
        "xx_m2, xy_m2, xh_m_rad, yy_m2, yh_m_rad, hh_rad2, name"};

std::string sum_of(std::string_view columns) { return "row_sum(" + std::string(columns) + ")"; }

/// "revision 70", "the size of a map"
std::string damaged_in(Database& database, Table table, std::string_view name) {
  const std::string columns = std::string(guarded(table).columns);
  Statement row{database, "SELECT " + std::string(table == Table::kMap ? "0" : "number") + " FROM " +
                              std::string(name) + " NOT INDEXED WHERE checksum IS NOT " + sum_of(columns) + " LIMIT 1"};
  if (!row.step()) return "";
  return table == Table::kMap ? "the size of a map" : "revision " + std::to_string(row.number(0));
}

/// Rows without a copy, and copies without a row.
bool are_paired(Database& database, Table table) {
  const GuardedTable t = guarded(table);
  const std::string key = table == Table::kMap ? "hash" : "id";
  const std::string rows = "SELECT " + key + " FROM " + std::string(t.name) + " NOT INDEXED";
  const std::string copies = "SELECT " + key + " FROM " + std::string(t.copy) + " NOT INDEXED";
  return database.number("SELECT EXISTS (" + rows + " EXCEPT " + copies + ") OR EXISTS (" + copies + " EXCEPT " + rows +
                         ")") == 0;
}

}  // namespace

std::string selected(Database& database, std::string_view table, std::string_view columns) {
  std::string all;
  Statement present{database, "SELECT group_concat(name) FROM pragma_table_info(?)"};
  present.bind(std::string(table));
  const std::string names = "," + (present.step() ? present.text(0) : std::string{}) + ",";
  for (std::size_t begin = 0; begin < columns.size();) {
    const std::size_t end = std::min(columns.find(", ", begin), columns.size());
    const std::string column = std::string(columns.substr(begin, end - begin));
    if (begin > 0) all += ", ";
    all += names.find("," + column + ",") != std::string::npos ? column : "NULL AS " + column;
    begin = end + 2;
  }
  return all;
}

GuardedTable guarded(Table table) { return table == Table::kMap ? kMapTable : kRevisionTable; }

void guard(Database& database, Table table, const std::string& which) {
  const GuardedTable t = guarded(table);
  const std::string columns = std::string(t.columns);
  database.run("UPDATE " + std::string(t.name) + " SET checksum = " + sum_of(columns) + " WHERE " + which);
  database.run("INSERT OR REPLACE INTO " + std::string(t.copy) + " (" + columns + ", checksum) SELECT " +
               std::string(t.copied) + ", " + sum_of(t.copied) + " FROM " + std::string(t.name) + " WHERE " + which);
}

void remove_rows(Database& database, Table table, const std::string& which) {
  const GuardedTable t = guarded(table);
  const std::string key = table == Table::kMap ? "hash" : "id";
  database.run("DELETE FROM " + std::string(t.copy) + " WHERE " + key + " IN (SELECT " + key + " FROM " +
               std::string(t.name) + " WHERE " + which + ")");
  database.run("DELETE FROM " + std::string(t.name) + " WHERE " + which);
}

bool are_sound(Database& database, Table table, const std::string& which) {
  const GuardedTable t = guarded(table);
  return database.number("SELECT EXISTS (SELECT 1 FROM " + std::string(t.name) + " WHERE " + which +
                         " AND checksum IS NOT " + sum_of(t.columns) + ")") == 0;
}

std::string damaged_row(Database& database) {
  for (const Table table : {Table::kMap, Table::kRevision}) {
    for (const std::string_view name : {guarded(table).name, guarded(table).copy}) {
      if (const std::string row = damaged_in(database, table, name); !row.empty()) {
        return row + " is not what was written";
      }
    }
    if (!are_paired(database, table)) return "a row is missing";
  }
  return "";
}

}  // namespace deltamap::mapping::store
