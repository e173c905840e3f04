// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/map_store.hpp"

#include <array>
#include <bit>
#include <map>
#include <optional>
#include <utility>

#include "mapping/store/database.hpp"
#include "mapping/store/map_codec.hpp"
#include "mapping/store/revision_names.hpp"
#include "mapping/store/store_retention.hpp"
#include "mapping/store/store_schema.hpp"
#include "mapping/store/taken_back.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::uint32_t kGridEvery = 64;  // revisions between whole grids
constexpr std::uint32_t kRefusals = 1000;
constexpr std::uint32_t kPruneEvery = 100;  // refusals: looking for the oldest reads through many

/// In the order of the columns.
constexpr std::array<std::pair<int, int>, 6> kUpperTriangle{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

std::int64_t signed_hash(const OccupancyGrid& grid) { return std::bit_cast<std::int64_t>(grid_hash(grid)); }

/// Nothing where the columns are empty.
std::optional<PoseCovariance> covariance_in(const Statement& row, int first_column) {
  if (row.is_null(first_column)) return std::nullopt;
  PoseCovariance covariance;
  for (const auto& [one, other] : kUpperTriangle) {
    covariance(one, other) = covariance(other, one) = row.real(first_column++);
  }
  return covariance;
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
  std::uint32_t refusals_since_pruning = 0;

  explicit State(Database opened_database) : database{std::move(opened_database)} {}

  [[nodiscard]] bool find_geometry() {
    Statement row{database, "SELECT width, height, resolution_m, origin_x_m, origin_y_m FROM map WHERE hash = ?"};
    row.bind(map);
    if (!row.step()) return false;
    geometry = {
        static_cast<int>(row.number(0)), static_cast<int>(row.number(1)), row.real(2), {row.real(3), row.real(4)}};
    if (geometry.width <= 0 || geometry.height <= 0 || geometry.width > 32767 || geometry.height > 32767) {
      database.fail_as_unsound("damaged: size of the map");
    }
    return true;
  }

  void write(const StoredRevision& summary, std::int64_t hash, std::span<const std::uint8_t> changes,
             std::span<const std::uint8_t> grid) {
    Statement row{database,
                  "INSERT INTO revision (map, number, refused, time_ns, phase, acceptance, cause, occupied, freed, "
                  "unknown, first_column, first_row, last_column, last_row, grid_hash, changes, grid, xx_m2, xy_m2, "
                  "xh_m_rad, yy_m2, yh_m_rad, hh_rad2) "
                  "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"};
    row.bind(map).bind(std::int64_t{summary.number}).bind(std::int64_t{summary.refused});
    row.bind(unix_ns(summary.time)).bind(std::int64_t{summary.note.phase}).bind(summary.note.acceptance);
    row.bind(summary.note.cause).bind(std::int64_t{summary.occupied}).bind(std::int64_t{summary.freed});
    row.bind(std::int64_t{summary.unknown});
    for (const int side :
         {summary.box.first.column, summary.box.first.row, summary.box.last.column, summary.box.last.row}) {
      row.bind(std::int64_t{side});
    }
    row.bind(hash).bind(changes).bind(grid);
    if (const auto& covariance = summary.note.covariance) {
      for (const auto& [one, other] : kUpperTriangle) row.bind((*covariance)(one, other));
    }  // else NULL: what is not bound
    row.step();
  }

  [[noreturn]] void fail_as_missing(std::uint32_t number) const {
    database.fail("no revision " + std::to_string(number) + " (newest: " + std::to_string(newest) + ")");
  }

  /// Throws where the revision is no good or was never written.
  [[noreturn]] void fail_to_restore(std::uint32_t number) {
    Statement row{database, "SELECT min(number) FROM revision WHERE map = ? AND refused = 0 AND number >= ?"};
    row.bind(map).bind(std::int64_t{number});
    if (row.step() && !row.is_null(0) && row.number(0) != std::int64_t{number}) {
      database.fail("revision " + std::to_string(number) + " is not in the store: revision " +
                    std::to_string(row.number(0)) + " holds it and what came after it");
    }
    database.fail_as_unsound("damaged: revision " + std::to_string(number) + " cannot be restored");
  }

  /// 0: it is the first in the store.
  [[nodiscard]] std::uint32_t number_before(std::uint32_t number) {
    Statement row{database, "SELECT max(number) FROM revision WHERE map = ? AND refused = 0 AND number < ?"};
    row.bind(map).bind(std::int64_t{number});
    return row.step() && !row.is_null(0) ? static_cast<std::uint32_t>(row.number(0)) : 0;
  }

  /// Later revisions that may have changed something in the box. One that holds others may have changed cells and set
  /// them back, which its own box does not tell.
  [[nodiscard]] std::vector<std::uint32_t> numbers_after(std::uint32_t number, const CellBox& box) {
    Statement rows{database,
                   "SELECT number, first_column <= ? AND last_column >= ? AND first_row <= ? AND last_row >= ? FROM "
                   "revision WHERE map = ? AND refused = 0 AND number > ? ORDER BY number"};
    rows.bind(std::int64_t{box.last.column}).bind(std::int64_t{box.first.column});
    rows.bind(std::int64_t{box.last.row}).bind(std::int64_t{box.first.row});
    rows.bind(map).bind(std::int64_t{number});
    std::vector<std::uint32_t> numbers;
    std::uint32_t before = number;
    while (rows.step()) {
      const auto later = static_cast<std::uint32_t>(rows.number(0));
      const bool holds_others = later != before + 1;
      if (holds_others || rows.number(1) != 0) numbers.push_back(later);
      before = later;
    }
    return numbers;
  }

  void prune_refusals() {
    refusals_since_pruning = 0;
    Statement old{database,
                  "DELETE FROM revision WHERE map = ? AND refused = 1 AND id <= (SELECT id FROM revision WHERE map = ? "
                  "AND refused = 1 ORDER BY id DESC LIMIT 1 OFFSET ?)"};
    old.bind(map).bind(map).bind(std::int64_t{kRefusals});
    old.step();
  }

  [[nodiscard]] std::vector<CellChange> changes_of(std::uint32_t number) {
    Statement row{database, "SELECT changes FROM revision WHERE map = ? AND refused = 0 AND number = ?"};
    row.bind(map).bind(std::int64_t{number});
    auto changes = row.step() ? decoded_changes(row.blob(0), geometry) : std::nullopt;
    if (!changes) fail_to_restore(number);
    return *std::move(changes);
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
      if (newest == 0) database.fail_as_unsound("damaged: no revision can be restored");
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

  void append(const MapRevision& revision, const RevisionNote& note, bool whole) {
    Transaction all{database};
    if (newest_written() != newest) database.fail("another program writes to this store");
    write(summary_of(revision.number, revision.time, note, revision.changes), signed_hash(*revision.map),
          encoded_changes(revision.changes, geometry),
          whole ? encoded_grid(*revision.map) : std::vector<std::uint8_t>{});
    all.commit();
    newest = revision.number;
  }

  void remember_as_last_used() {
    Statement row{database, "UPDATE map SET used = (SELECT max(used) + 1 FROM map) WHERE hash = ?"};
    row.bind(map);
    row.step();
  }
};

MapStore::MapStore(const std::filesystem::path& file, const OccupancyGrid& first)
    : state_{std::make_unique<State>(opened_store(file, Database::Mode::kCreate))} {
  Transaction all{state_->database};
  state_->map = signed_hash(first);
  if (!state_->find_geometry()) state_->begin_history(first);
  state_->remember_as_last_used();
  state_->find_newest_good();
  state_->prune_refusals();
  all.commit();
}

MapStore::MapStore(std::unique_ptr<State> opened) : state_{std::move(opened)} {
  if (state_->database.number("SELECT count(*) FROM map") == 0) state_->database.fail("holds no map yet");
  state_->map = state_->database.number("SELECT hash FROM map ORDER BY used DESC LIMIT 1");
  (void)state_->find_geometry();
  state_->newest = state_->newest_written();
}

MapStore::MapStore(const std::filesystem::path& file)
    : MapStore{std::make_unique<State>(opened_store(file, Database::Mode::kExisting))} {}

MapStore MapStore::to_read(const std::filesystem::path& file) {
  const auto mode = is_read_as_is(file) ? Database::Mode::kReadAsIs : Database::Mode::kExisting;
  return MapStore{std::make_unique<State>(opened_store(file, mode))};
}

MapStore::~MapStore() = default;
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;

std::uint32_t MapStore::newest() const { return state_->newest; }
std::uint32_t MapStore::dropped() const { return state_->dropped; }

std::uint32_t MapStore::revisions_of_others() const {
  Statement row{state_->database, "SELECT count(*) FROM revision WHERE map != ? AND refused = 0 AND number > 0"};
  row.bind(state_->map);
  return row.step() ? static_cast<std::uint32_t>(row.number(0)) : 0;
}
void MapStore::catch_up() { state_->newest = state_->newest_written(); }

OccupancyGrid MapStore::grid(std::uint32_t number) const {
  if (number > state_->newest) state_->fail_as_missing(number);
  auto grid = state_->restored(number);
  if (!grid) state_->fail_to_restore(number);
  return *std::move(grid);
}

std::vector<StoredRevision> MapStore::history() const {
  Statement rows{state_->database,
                 "SELECT number, refused, time_ns, phase, acceptance, cause, occupied, freed, unknown, first_column, "
                 "first_row, last_column, last_row, xx_m2, xy_m2, xh_m_rad, yy_m2, yh_m_rad, hh_rad2 FROM revision "
                 "WHERE map = ? ORDER BY id"};
  rows.bind(state_->map);
  const std::map<std::uint32_t, std::string> names = names_in(state_->database, state_->map);
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
    revision.note = {whole(3), rows.real(4), rows.text(5), covariance_in(rows, 13)};
    revision.occupied = whole(6);
    revision.freed = whole(7);
    revision.unknown = whole(8);
    revision.box = {cell(9), cell(11)};
    if (const auto name = names.find(revision.number); name != names.end() && !revision.refused) {
      revision.name = name->second;
    }
    all.push_back(std::move(revision));
  }
  return all;
}

void MapStore::append(const MapRevision& revision, const RevisionNote& note) {
  State& s = *state_;
  if (revision.number != s.newest + 1) {
    s.database.fail("revision " + std::to_string(revision.number) + " does not follow " + std::to_string(s.newest));
  }
  s.append(revision, note, revision.number % kGridEvery == 0);
}

void MapStore::append_whole(std::uint32_t number, Timestamp time, const OccupancyGrid& map, const RevisionNote& note) {
  if (number <= newest()) state_->database.fail("revision " + std::to_string(number) + " is older than the newest");
  MapRevision revision;
  revision.number = number;
  revision.time = time;
  revision.changes = changes_between(grid(newest()), map);
  revision.map = std::make_shared<const OccupancyGrid>(map);
  state_->append(revision, note, true);
}

void MapStore::append_refusal(Timestamp time, const RevisionNote& note) {
  StoredRevision refusal;
  refusal.number = state_->newest;
  refusal.refused = true;
  refusal.time = time;
  refusal.note = note;
  Transaction all{state_->database};
  state_->write(refusal, 0, {}, {});
  if (++state_->refusals_since_pruning >= kPruneEvery) state_->prune_refusals();
  all.commit();
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

std::vector<CellChange> MapStore::changes(std::uint32_t number) const {
  if (number > state_->newest) state_->fail_as_missing(number);
  if (number == 0) return {};
  std::vector<CellChange> changes = state_->changes_of(number);
  std::erase_if(changes, [](const CellChange& change) { return change.before == change.after; });
  return changes;
}

bool MapStore::thin_out(const Retention& retention, Timestamp now) {
  State& s = *state_;
  return store::thin_out(s.database, s.map, s.geometry, retention, now);
}

void MapStore::set_name(std::uint32_t number, const std::string& name) {
  write_name(state_->database, state_->map, number, name, encoded_grid(grid(number)));
}

MapStore::Undoing MapStore::undoing(std::uint32_t number, const OccupancyGrid& newest_map) const {
  State& s = *state_;
  if (number == 0) s.database.fail("revision 0 is the first map: there is nothing to undo");
  std::vector<CellChange> delta = changes(number);
  const std::size_t all = delta.size();
  std::vector<bool> changed_later(s.geometry.cell_count(), false);
  for (const std::uint32_t later : s.numbers_after(number, bounding_box(delta))) {
    for (const CellChange& change : s.changes_of(later)) changed_later[s.geometry.index_of(change.cell)] = true;
  }
  std::erase_if(delta, [&](const CellChange& change) { return changed_later[s.geometry.index_of(change.cell)]; });

  Undoing undoing{.changes = taken_back(newest_map, delta)};
  if (undoing.changes.empty()) {
    s.database.fail("nothing of revision " + std::to_string(number) + " is left to undo");
  }
  undoing.kept = all - undoing.changes.size();
  undoing.held_before = number - s.number_before(number) - 1;
  return undoing;
}

std::uint32_t MapStore::undo(std::uint32_t number, Timestamp time) {
  OccupancyGrid map = grid(state_->newest);
  MapRevision revision;
  revision.number = state_->newest + 1;
  revision.time = time;
  revision.changes = undoing(number, map).changes;
  revision.map = std::make_shared<const OccupancyGrid>(patched(std::move(map), revision.changes));
  append(revision, {.cause = "undo of " + std::to_string(number)});
  return revision.number;
}

}  // namespace deltamap::mapping::store
