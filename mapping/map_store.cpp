// SPDX-License-Identifier: Apache-2.0
#include "mapping/map_store.hpp"

#include <bit>
#include <optional>
#include <stdexcept>
#include <utility>

#include "mapping/database.hpp"
#include "mapping/map_codec.hpp"

namespace deltamap::mapping {
namespace {

constexpr std::int64_t kApplicationId = 0x444D4150;  // "DMAP"
constexpr std::int64_t kSchemaVersion = 1;
constexpr std::uint32_t kGridEvery = 64;  // revisions between whole grids

constexpr const char* kSchema = R"(
CREATE TABLE map (hash INTEGER PRIMARY KEY, width INTEGER, height INTEGER, resolution_m REAL, origin_x_m REAL,
                  origin_y_m REAL, used INTEGER);
CREATE TABLE revision (id INTEGER PRIMARY KEY, map INTEGER NOT NULL, number INTEGER NOT NULL, refused INTEGER NOT NULL,
                       time_ns INTEGER, phase INTEGER, acceptance REAL, cause TEXT,
                       occupied INTEGER, freed INTEGER, unknown INTEGER,
                       first_column INTEGER, first_row INTEGER, last_column INTEGER, last_row INTEGER,
                       grid_hash INTEGER, changes BLOB, grid BLOB);
CREATE UNIQUE INDEX accepted ON revision (map, number) WHERE refused = 0;
)";

std::int64_t signed_hash(const OccupancyGrid& grid) { return std::bit_cast<std::int64_t>(grid_hash(grid)); }

/// Throws where the file holds something else, or is broken.
void check(Database& database) {
  const std::int64_t id = database.number("PRAGMA application_id");
  if (id != kApplicationId) database.fail("not a map store");
  const std::int64_t version = database.number("PRAGMA user_version");
  if (version != kSchemaVersion) database.fail("map store of version " + std::to_string(version) + ", not 1");
  const std::string sound = database.text("PRAGMA quick_check(1)");
  if (sound != "ok") database.fail("damaged: " + sound.substr(0, sound.find('\n')));
}

Database opened(const std::filesystem::path& file, bool create) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw std::runtime_error(file.string() + ": is a directory");
  if (!create && !std::filesystem::exists(file, ignored)) throw std::runtime_error(file.string() + ": no such file");
  Database database{file, create ? Database::Mode::kCreate : Database::Mode::kExisting};
  if (create && database.number("SELECT count(*) FROM sqlite_master") == 0) {
    database.run("PRAGMA journal_mode = WAL");
    Transaction all{database};
    if (database.number("SELECT count(*) FROM sqlite_master") == 0) {  // nobody else was faster
      database.run(kSchema);
      database.run("PRAGMA application_id = " + std::to_string(kApplicationId));
      database.run("PRAGMA user_version = " + std::to_string(kSchemaVersion));
    }
    all.commit();
  }
  check(database);
  database.run("PRAGMA journal_mode = WAL");
  database.run("PRAGMA synchronous = FULL");
  return database;
}

StoredRevision summary_of(std::uint32_t number, Timestamp time, const RevisionNote& note,
                          const std::vector<CellChange>& changes) {
  StoredRevision summary;
  summary.number = number;
  summary.time = time;
  summary.note = note;
  summary.box = bounding_box(changes);
  for (const CellChange& change : changes) {
    summary.occupied += change.after == CellState::kOccupied ? 1 : 0;
    summary.freed += change.after == CellState::kFree ? 1 : 0;
    summary.unknown += change.after == CellState::kUnknown ? 1 : 0;
  }
  return summary;
}

}  // namespace

struct MapStore::State {
  Database database;
  std::int64_t map = 0;  // hash of M_0
  GridGeometry geometry;
  std::uint32_t newest = 0;
  std::uint32_t dropped = 0;

  explicit State(Database opened_database) : database{std::move(opened_database)} {}

  [[nodiscard]] bool find_geometry() {
    Statement row{database, "SELECT width, height, resolution_m, origin_x_m, origin_y_m FROM map WHERE hash = ?"};
    row.bind(map);
    if (!row.step()) return false;
    geometry = {
        static_cast<int>(row.number(0)), static_cast<int>(row.number(1)), row.real(2), {row.real(3), row.real(4)}};
    if (geometry.width <= 0 || geometry.height <= 0 || geometry.width > 32767 || geometry.height > 32767) {
      database.fail("damaged: size of the map");
    }
    return true;
  }

  void write(const StoredRevision& summary, std::int64_t hash, std::span<const std::uint8_t> changes,
             std::span<const std::uint8_t> grid) {
    Statement row{database,
                  "INSERT INTO revision (map, number, refused, time_ns, phase, acceptance, cause, occupied, freed, "
                  "unknown, first_column, first_row, last_column, last_row, grid_hash, changes, grid) "
                  "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"};
    row.bind(map).bind(std::int64_t{summary.number}).bind(std::int64_t{summary.refused});
    row.bind(unix_ns(summary.time)).bind(std::int64_t{summary.note.phase}).bind(summary.note.acceptance);
    row.bind(summary.note.cause).bind(std::int64_t{summary.occupied}).bind(std::int64_t{summary.freed});
    row.bind(std::int64_t{summary.unknown});
    for (const int side :
         {summary.box.first.column, summary.box.first.row, summary.box.last.column, summary.box.last.row}) {
      row.bind(std::int64_t{side});
    }
    row.bind(hash).bind(changes).bind(grid);
    row.step();
  }

  /// M_k from the whole grid at or before it; nothing where something in between is missing or damaged.
  [[nodiscard]] std::optional<OccupancyGrid> restored(std::uint32_t number) {
    Statement rows{
        database,
        "SELECT number, grid_hash, changes, grid FROM revision WHERE map = ? AND refused = 0 AND number <= ? AND "
        "number >= (SELECT max(number) FROM revision WHERE map = ? AND refused = 0 AND number <= ? AND grid "
        "IS NOT NULL) ORDER BY number"};
    rows.bind(map).bind(std::int64_t{number}).bind(map).bind(std::int64_t{number});
    std::optional<OccupancyGrid> grid;
    std::int64_t last = -1;
    std::int64_t hash = 0;
    while (rows.step()) {
      if (!grid) {
        grid = decoded_grid(rows.blob(3), geometry);
      } else {
        const auto changes = decoded_changes(rows.blob(2), geometry);
        if (!changes || rows.number(0) != last + 1) return std::nullopt;
        grid = patched(*std::move(grid), *changes);
      }
      if (!grid) return std::nullopt;
      last = rows.number(0);
      hash = rows.number(1);
    }
    if (!grid || last != std::int64_t{number} || signed_hash(*grid) != hash) return std::nullopt;
    return grid;
  }

  [[nodiscard]] std::uint32_t newest_written() {
    Statement row{database, "SELECT max(number) FROM revision WHERE map = ? AND refused = 0"};
    row.bind(map);
    return row.step() ? static_cast<std::uint32_t>(row.number(0)) : 0;
  }

  void find_newest_good() {
    const std::uint32_t written = newest_written();
    newest = written;
    while (!restored(newest)) {
      if (newest == 0) database.fail("damaged: no revision can be restored");
      --newest;
    }
    dropped = written - newest;
    if (dropped == 0) return;
    Statement rest{database, "DELETE FROM revision WHERE map = ? AND refused = 0 AND number > ?"};
    rest.bind(map).bind(std::int64_t{newest});
    rest.step();
  }

  void begin_history(const OccupancyGrid& first) {
    geometry = first.geometry();
    Statement row{database, "INSERT INTO map VALUES (?, ?, ?, ?, ?, ?, 0)"};
    row.bind(map).bind(std::int64_t{geometry.width}).bind(std::int64_t{geometry.height});
    row.bind(geometry.resolution_m).bind(geometry.origin.x()).bind(geometry.origin.y());
    row.step();
    StoredRevision summary;
    summary.note.cause = "first map";
    write(summary, map, {}, encoded_grid(first));
  }

  void remember_as_last_used() {
    Statement row{database, "UPDATE map SET used = (SELECT max(used) + 1 FROM map) WHERE hash = ?"};
    row.bind(map);
    row.step();
  }
};

MapStore::MapStore(const std::filesystem::path& file, const OccupancyGrid& first)
    : state_{std::make_unique<State>(opened(file, true))} {
  Transaction all{state_->database};
  state_->map = signed_hash(first);
  if (!state_->find_geometry()) state_->begin_history(first);
  state_->remember_as_last_used();
  state_->find_newest_good();
  all.commit();
}

MapStore::MapStore(const std::filesystem::path& file) : state_{std::make_unique<State>(opened(file, false))} {
  if (state_->database.number("SELECT count(*) FROM map") == 0) state_->database.fail("holds no map yet");
  state_->map = state_->database.number("SELECT hash FROM map ORDER BY used DESC LIMIT 1");
  (void)state_->find_geometry();
  state_->newest = state_->newest_written();
}

MapStore::~MapStore() = default;
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;

std::uint32_t MapStore::newest() const { return state_->newest; }
std::uint32_t MapStore::dropped() const { return state_->dropped; }

OccupancyGrid MapStore::grid(std::uint32_t number) const {
  if (number > state_->newest) {
    state_->database.fail("no revision " + std::to_string(number) + " (newest: " + std::to_string(state_->newest) +
                          ")");
  }
  auto grid = state_->restored(number);
  if (!grid) state_->database.fail("damaged: revision " + std::to_string(number) + " cannot be restored");
  return *std::move(grid);
}

std::vector<StoredRevision> MapStore::history() const {
  Statement rows{state_->database,
                 "SELECT number, refused, time_ns, phase, acceptance, cause, occupied, freed, unknown, first_column, "
                 "first_row, last_column, last_row FROM revision WHERE map = ? ORDER BY id"};
  rows.bind(state_->map);
  std::vector<StoredRevision> all;
  const auto whole = [&](int column) { return static_cast<std::uint32_t>(rows.number(column)); };
  const auto cell = [&](int column) {
    return Cell{static_cast<int>(rows.number(column)), static_cast<int>(rows.number(column + 1))};
  };
  while (rows.step()) {
    StoredRevision revision;
    revision.number = whole(0);
    revision.refused = rows.number(1) != 0;
    revision.time = timestamp_from_ns(rows.number(2));
    revision.note = {whole(3), rows.real(4), rows.text(5)};
    revision.occupied = whole(6);
    revision.freed = whole(7);
    revision.unknown = whole(8);
    revision.box = {cell(9), cell(11)};
    all.push_back(std::move(revision));
  }
  return all;
}

void MapStore::append(const MapRevision& revision, const RevisionNote& note) {
  State& s = *state_;
  if (revision.number != s.newest + 1) {
    s.database.fail("revision " + std::to_string(revision.number) + " does not follow " + std::to_string(s.newest));
  }
  Transaction all{s.database};
  if (s.newest_written() != s.newest) s.database.fail("another program writes to this store");
  const bool whole = revision.number % kGridEvery == 0;
  s.write(summary_of(revision.number, revision.time, note, revision.changes), signed_hash(*revision.map),
          encoded_changes(revision.changes, s.geometry),
          whole ? encoded_grid(*revision.map) : std::vector<std::uint8_t>{});
  all.commit();
  s.newest = revision.number;
}

void MapStore::append_refusal(Timestamp time, const RevisionNote& note) {
  StoredRevision refusal;
  refusal.number = state_->newest;
  refusal.refused = true;
  refusal.time = time;
  refusal.note = note;
  state_->write(refusal, 0, {}, {});
}

std::uint32_t MapStore::roll_back(std::uint32_t number, Timestamp time) {
  MapRevision revision;
  revision.number = state_->newest + 1;
  revision.time = time;
  revision.map = std::make_shared<const OccupancyGrid>(grid(number));
  revision.changes = changes_between(grid(state_->newest), *revision.map);
  append(revision, {.cause = "rolled back to " + std::to_string(number)});
  return revision.number;
}

}  // namespace deltamap::mapping
