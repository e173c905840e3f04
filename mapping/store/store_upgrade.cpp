// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/store_upgrade.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "mapping/store/guarded_rows.hpp"
#include "mapping/store/history.hpp"
#include "mapping/store/map_codec.hpp"
#include "mapping/store/store_schema.hpp"

namespace deltamap::mapping::store {
namespace {

/// Throws where a step, or a whole map, is not what the ones around it say. A wrong step shows at the next whole map,
/// or at the newest one.
void require_sound_history(Database& database, std::int64_t map, const GridGeometry& geometry) {
  Statement rows{database,
                 "SELECT number, grid_hash, changes, grid FROM revision WHERE map = ? AND refused = 0 ORDER BY number"};
  rows.bind(map);
  std::optional<OccupancyGrid> grid;
  std::int64_t last = -1;
  std::int64_t hash = 0;
  const auto require = [&](bool is_sound) {
    if (!is_sound) database.fail_as_unsound("damaged: revision " + std::to_string(last) + " is not what was written");
  };
  while (rows.step()) {
    const std::int64_t before = std::exchange(last, rows.number(0));
    hash = rows.number(1);
    const auto changes = decoded_changes(rows.blob(2), geometry);
    require(changes.has_value());
    std::optional<OccupancyGrid> next;
    if (grid) next = patched(*std::move(grid), *changes);
    if (rows.is_null(3)) {
      require(next && last == before + 1);
      grid = std::move(next);
      continue;
    }
    grid = decoded_grid(rows.blob(3), geometry);
    require(grid && signed_hash(*grid) == hash && (!next || *next == *grid));
  }
  require(grid && signed_hash(*grid) == hash);
}

void require_sound_histories(Database& database) {
  Statement maps{database, "SELECT hash, width, height, resolution_m, origin_x_m, origin_y_m FROM map"};
  while (maps.step()) {
    const GridGeometry geometry{static_cast<int>(maps.number(1)), static_cast<int>(maps.number(2)), maps.real(3),
                                Point2{maps.real(4), maps.real(5)}};
    if (!is_storable(geometry)) database.fail_as_unsound("damaged: size of the map");
    require_sound_history(database, maps.number(0), geometry);
  }
}

void put_over(Database& database, Table table, const std::string& old) {
  const GuardedTable t = guarded(table);
  const std::string columns{t.columns};
  database.run("INSERT INTO " + std::string(t.name) + " (" + columns + ") SELECT " +
               selected(database, old, t.columns) + " FROM " + old);
}

bool has_table(Database& database, const std::string& name) {
  return database.number("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = '" + name + "'") > 0;
}

void rewrite(Database& database) {
  for (const char* table : {"map", "revision"}) {
    database.run("ALTER TABLE " + std::string(table) + " RENAME TO old_" + table);
  }
  for (const char* left : {"map_copy", "revision_copy"}) database.run("DROP TABLE IF EXISTS " + std::string(left));
  database.run("DROP INDEX IF EXISTS accepted");
  make_tables(database);
  put_over(database, Table::kMap, "old_map");
  put_over(database, Table::kRevision, "old_revision");
  if (has_table(database, "named")) {
    database.run(
        "UPDATE revision SET name = named.name FROM named WHERE named.map = revision.map AND named.number = "
        "revision.number AND revision.refused = 0");
    database.run("DROP TABLE named");
  }
  for (const Table table : {Table::kMap, Table::kRevision}) guard(database, table, "true");
  for (const char* table : {"old_map", "old_revision"}) database.run("DROP TABLE " + std::string(table));
  mark_as_store(database);
}

}  // namespace

void bring_up_to_date(Database& database) {
  {
    Transaction all{database};
    if (database.number("PRAGMA user_version") == kSchemaVersion) return;  // somebody else was faster
    require_sound_histories(database);
    rewrite(database);
    all.commit();
  }
  try {
    database.run("VACUUM");
  } catch (const StoreError&) {  // no room for it: the file stays larger than it need be
  }
}

}  // namespace deltamap::mapping::store
