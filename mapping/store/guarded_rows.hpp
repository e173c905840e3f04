// SPDX-License-Identifier: Apache-2.0
// What keeps a map store whole where a disk damages some of it: each row carries a checksum, and lies in the file
// twice, in `revision` and `revision_copy`, `map` and `map_copy`, which share no page. The copies hold no whole maps
// but the first: all others follow from their steps.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mapping/store/database.hpp"

namespace deltamap::mapping::store {

enum class Table : std::uint8_t { kMap, kRevision };

struct GuardedTable {
  std::string_view name;
  std::string_view copy;
  std::string_view columns;  ///< separated by commas: all but the checksum
  std::string_view copied;   ///< what stands in the copy for each of them
};
[[nodiscard]] GuardedTable guarded(Table table);

/// Of a table as it stands in this file: what an older version had no column for is NULL.
[[nodiscard]] std::string selected(Database& database, std::string_view table, std::string_view columns);

/// Once rows were written, in the same transaction: makes their checksums and copies. `which` is an SQL condition.
void guard(Database& database, Table table, const std::string& which);
/// Takes rows away with their copies.
void remove_rows(Database& database, Table table, const std::string& which);
/// Does the condition hold for no damaged row of the table itself?
[[nodiscard]] bool are_sound(Database& database, Table table, const std::string& which);
/// "revision 70 is not what was written"; empty where every row is what was written and lies there twice.
[[nodiscard]] std::string damaged_row(Database& database);

}  // namespace deltamap::mapping::store
