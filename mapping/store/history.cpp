// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/history.hpp"

#include <array>
#include <bit>
#include <sstream>
#include <string>
#include <utility>

#include "core/grid/grid_patch.hpp"
#include "mapping/store/guarded_rows.hpp"
#include "mapping/store/map_codec.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::uint32_t kRefusals = 1000;
constexpr int kMostCells = 32767;  // along a side

/// In the order of the columns.
constexpr std::array<std::pair<int, int>, 6> kUpperTriangle{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

/// Nothing where the columns are empty.
std::optional<PoseCovariance> covariance_in(const Statement& row, int first_column) {
  if (row.is_null(first_column)) return std::nullopt;
  PoseCovariance covariance;
  for (const auto& [one, other] : kUpperTriangle) {
    covariance(one, other) = covariance(other, one) = row.real(first_column++);
  }
  return covariance;
}

}  // namespace

std::int64_t signed_hash(const OccupancyGrid& grid) { return std::bit_cast<std::int64_t>(grid_hash(grid)); }

bool is_storable(const GridGeometry& geometry) {
  return geometry.width > 0 && geometry.height > 0 && geometry.width <= kMostCells && geometry.height <= kMostCells;
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

// --- writing ---

bool History::find_geometry() {
  Statement row{database, "SELECT width, height, resolution_m, origin_x_m, origin_y_m FROM map WHERE hash = ?"};
  row.bind(map);
  if (!row.step()) return false;
  geometry = {
      static_cast<int>(row.number(0)), static_cast<int>(row.number(1)), row.real(2), {row.real(3), row.real(4)}};
  if (!is_storable(geometry)) database.fail_as_unsound("damaged: size of the map");
  return true;
}

void History::begin_without_first(const GridGeometry& of_all) {
  geometry = of_all;
  Statement row{database,
                "INSERT INTO map (hash, width, height, resolution_m, origin_x_m, origin_y_m, used) "
                "VALUES (?, ?, ?, ?, ?, ?, 0)"};
  row.bind(map).bind(std::int64_t{geometry.width}).bind(std::int64_t{geometry.height});
  row.bind(geometry.resolution_m).bind(geometry.origin.x()).bind(geometry.origin.y());
  row.step();
  guard(database, Table::kMap, "hash = " + std::to_string(map));
}

void History::begin(const OccupancyGrid& first) {
  begin_without_first(first.geometry());
  StoredRevision summary;
  summary.note.cause = "first map";
  write(summary, map, {}, encoded_grid(first));
}

void History::remember_as_last_used() {
  Statement row{database, "UPDATE map SET used = (SELECT max(used) + 1 FROM map) WHERE hash = ?"};
  row.bind(map);
  row.step();
  guard(database, Table::kMap, "hash = " + std::to_string(map));
}

void History::write(const StoredRevision& summary, std::int64_t hash, std::span<const std::uint8_t> changes,
                    std::span<const std::uint8_t> grid, std::optional<std::int64_t> id) {
  Statement row{database,
                "INSERT INTO revision (id, map, number, refused, time_ns, phase, acceptance, cause, occupied, freed, "
                "unknown, first_column, first_row, last_column, last_row, grid_hash, changes, grid, xx_m2, xy_m2, "
                "xh_m_rad, yy_m2, yh_m_rad, hh_rad2) "
                "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"};
  if (id) {
    row.bind(*id);
  } else {
    row.skip();
  }
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
  guard(database, Table::kRevision, "id = " + std::to_string(database.number("SELECT last_insert_rowid()")));
}

void History::rewrite(std::uint32_t number, const std::vector<CellChange>& changes, const OccupancyGrid& to) {
  const StoredRevision summary = summary_of(number, {}, {}, changes);
  Statement row{database,
                "UPDATE revision SET changes = ?, grid_hash = ?, occupied = ?, freed = ?, unknown = ?, first_column = "
                "?, first_row = ?, last_column = ?, last_row = ? WHERE map = ? AND refused = 0 AND number = ?"};
  row.bind(encoded_changes(changes, geometry)).bind(signed_hash(to));
  for (const std::uint32_t cells : {summary.occupied, summary.freed, summary.unknown}) row.bind(std::int64_t{cells});
  const CellBox& box = summary.box;
  for (const int side : {box.first.column, box.first.row, box.last.column, box.last.row}) row.bind(std::int64_t{side});
  row.bind(map).bind(std::int64_t{number});
  row.step();
  guard(database, Table::kRevision,
        "map = " + std::to_string(map) + " AND refused = 0 AND number = " + std::to_string(number));
}

void History::append(const MapRevision& revision, const RevisionNote& note, bool whole) {
  Transaction all{database};
  if (newest_written() != newest) database.fail("another program writes to this store");
  write(summary_of(revision.number, revision.time, note, revision.changes), signed_hash(*revision.map),
        encoded_changes(revision.changes, geometry), whole ? encoded_grid(*revision.map) : std::vector<std::uint8_t>{});
  if (note.provisional) set_provisional(*note.provisional);
  all.commit();
  newest = revision.number;
}

void History::prune_refusals() {
  refusals_since_pruning = 0;
  const std::string of_map = "map = " + std::to_string(map) + " AND refused = 1";
  remove_rows(database, Table::kRevision,
              of_map + " AND id <= (SELECT id FROM revision WHERE " + of_map + " ORDER BY id DESC LIMIT 1 OFFSET " +
                  std::to_string(kRefusals) + ")");
}

void History::set_provisional(const std::vector<std::uint32_t>& numbers) {
  if (numbers == provisional()) return;
  std::string text;
  for (const std::uint32_t number : numbers) text += (text.empty() ? "" : " ") + std::to_string(number);
  Statement row{database, "UPDATE map SET provisional = ? WHERE hash = ?"};
  row.bind(text).bind(map);
  row.step();
  guard(database, Table::kMap, "hash = " + std::to_string(map));
}

// --- reading ---

std::vector<std::uint32_t> History::provisional() {
  Statement row{database, "SELECT provisional FROM map WHERE hash = ?"};
  row.bind(map);
  std::vector<std::uint32_t> numbers;
  if (!row.step()) return numbers;
  std::istringstream text{row.text(0)};
  for (std::uint32_t number = 0; text >> number;) numbers.push_back(number);
  return numbers;
}

std::uint32_t History::newest_written() {
  Statement row{database, "SELECT max(number) FROM revision WHERE map = ? AND refused = 0"};
  row.bind(map);
  return row.step() ? static_cast<std::uint32_t>(row.number(0)) : 0;
}

std::uint32_t History::number_before(std::uint32_t number) {
  Statement row{database, "SELECT max(number) FROM revision WHERE map = ? AND refused = 0 AND number < ?"};
  row.bind(map).bind(std::int64_t{number});
  return row.step() && !row.is_null(0) ? static_cast<std::uint32_t>(row.number(0)) : 0;
}

std::vector<std::uint32_t> History::numbers_after(std::uint32_t number, const CellBox& box) {
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

std::vector<CellChange> History::changes_of(std::uint32_t number) {
  Statement row{database, "SELECT changes FROM revision WHERE map = ? AND refused = 0 AND number = ?"};
  row.bind(map).bind(std::int64_t{number});
  auto changes = row.step() ? decoded_changes(row.blob(0), geometry) : std::nullopt;
  if (!changes) fail_to_restore(number);
  return *std::move(changes);
}

std::optional<OccupancyGrid> History::restored(std::uint32_t number) {
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

std::vector<StoredRevision> History::all() {
  Statement rows{database,
                 "SELECT number, refused, time_ns, phase, acceptance, cause, occupied, freed, unknown, first_column, "
                 "first_row, last_column, last_row, xx_m2, xy_m2, xh_m_rad, yy_m2, yh_m_rad, hh_rad2, name FROM "
                 "revision WHERE map = ? ORDER BY id"};
  rows.bind(map);
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
    revision.note.phase = whole(3);
    revision.note.acceptance = rows.real(4);
    revision.note.cause = rows.text(5);
    revision.note.covariance = covariance_in(rows, 13);
    revision.occupied = whole(6);
    revision.freed = whole(7);
    revision.unknown = whole(8);
    revision.box = {cell(9), cell(11)};
    revision.name = rows.text(19);
    all.push_back(std::move(revision));
  }
  return all;
}

// --- what goes wrong ---

void History::fail_as_missing(std::uint32_t number) const {
  database.fail("no revision " + std::to_string(number) + " (newest: " + std::to_string(newest) + ")");
}

void History::fail_to_restore(std::uint32_t number) {
  Statement row{database, "SELECT min(number) FROM revision WHERE map = ? AND refused = 0 AND number >= ?"};
  row.bind(map).bind(std::int64_t{number});
  if (row.step() && !row.is_null(0) && row.number(0) != std::int64_t{number}) {
    database.fail("revision " + std::to_string(number) + " is not in the store: revision " +
                  std::to_string(row.number(0)) + " holds it and what came after it");
  }
  database.fail_as_unsound("damaged: revision " + std::to_string(number) + " cannot be restored");
}

}  // namespace deltamap::mapping::store
