// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/store_schema.hpp"

#include <string>
#include <system_error>

#include "mapping/store/guarded_rows.hpp"
#include "mapping/store/store_upgrade.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::int64_t kApplicationId = 0x444D4150;  // "DMAP"
constexpr int kCache_kB = 256;  // of the file in memory: an append touches a few pages; SQLite would keep 2 MB a store

/// Tables before indexes: so they begin on the same pages once a file has been compacted.
constexpr const char* kMapColumns =
    "(hash INTEGER PRIMARY KEY, width INTEGER, height INTEGER, resolution_m REAL, origin_x_m REAL, origin_y_m REAL, "
    "used INTEGER, provisional TEXT, checksum INTEGER)";
constexpr const char* kRevisionColumns =
    "(id INTEGER PRIMARY KEY, map INTEGER NOT NULL, number INTEGER NOT NULL, refused INTEGER NOT NULL, "
    "time_ns INTEGER, phase INTEGER, acceptance REAL, cause TEXT, occupied INTEGER, freed INTEGER, unknown INTEGER, "
    "first_column INTEGER, first_row INTEGER, last_column INTEGER, last_row INTEGER, grid_hash INTEGER, changes BLOB, "
    "grid BLOB, xx_m2 REAL, xy_m2 REAL, xh_m_rad REAL, yy_m2 REAL, yh_m_rad REAL, hh_rad2 REAL, name TEXT, "
    "checksum INTEGER)";
constexpr const char* kIndex = "CREATE UNIQUE INDEX accepted ON revision (map, number) WHERE refused = 0";

/// Throws where the file holds something else.
void require_store(Database& database) {
  const std::int64_t id = database.number("PRAGMA application_id");
  if (id != kApplicationId) database.fail_as_unsound("not a map store");
  const std::int64_t version = database.number("PRAGMA user_version");
  if (version < 1 || version > kSchemaVersion) {
    database.fail_as_unsound("map store of version " + std::to_string(version) + ", not 1 to " +
                             std::to_string(kSchemaVersion));
  }
}

void require_sound_pages(Database& database) {
  const std::string sound = database.text("PRAGMA integrity_check(1)");
  if (sound != "ok") database.fail_as_unsound("damaged: " + sound.substr(0, sound.find('\n')));
}

void require_sound_rows(Database& database) {
  if (const std::string row = damaged_row(database); !row.empty()) database.fail_as_unsound("damaged: " + row);
}

}  // namespace

void make_tables(Database& database) {
  for (const char* name : {"map", "map_copy"}) {
    database.run("CREATE TABLE " + std::string(name) + " " + kMapColumns);
  }
  for (const char* name : {"revision", "revision_copy"}) {
    database.run("CREATE TABLE " + std::string(name) + " " + kRevisionColumns);
  }
  database.run(kIndex);
}

void mark_as_store(Database& database) {
  database.run("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.run("PRAGMA user_version = " + std::to_string(kSchemaVersion));
}

Database opened_store(const std::filesystem::path& file, Database::Mode mode) {
  const bool create = mode == Database::Mode::kCreate || mode == Database::Mode::kMemory;
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw StoreError(file.string() + ": is a directory", StoreError::Kind::kOther);
  if (!create && !std::filesystem::exists(file, error)) {
    const std::string why = error ? "cannot be opened: " + error.message() : "no such file";
    throw StoreError(file.string() + ": " + why, StoreError::Kind::kOther);
  }
  Database database{file, mode};
  database.run("PRAGMA cache_size = -" + std::to_string(kCache_kB));  // negative: in kB, not in pages
  if (create && database.number("SELECT count(*) FROM sqlite_master") == 0) {
    database.run("PRAGMA journal_mode = WAL");
    Transaction all{database};
    if (database.number("SELECT count(*) FROM sqlite_master") == 0) {  // nobody else was faster
      make_tables(database);
      mark_as_store(database);
    }
    all.commit();
  }
  require_store(database);
  require_sound_pages(database);
  if (database.number("PRAGMA user_version") < kSchemaVersion) {
    if (mode == Database::Mode::kReadAsIs)
      database.fail("of an older version, and may not be written", StoreError::Kind::kReadOnly);
    bring_up_to_date(database);
  }
  require_sound_rows(database);
  if (mode == Database::Mode::kReadAsIs) return database;
  database.run("PRAGMA journal_mode = WAL");
  database.run("PRAGMA synchronous = FULL");
  return database;
}

}  // namespace deltamap::mapping::store
