// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/map_salvage.hpp"

#include <bit>
#include <utility>

#include "core/grid/grid_patch.hpp"
#include "mapping/store/database.hpp"
#include "mapping/store/map_codec.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::int64_t kBeyondDamage = 20'000;  // rows that are looked for behind the first that cannot be read

struct Row {
  std::uint32_t number = 0;
  Timestamp time;
  std::uint64_t hash = 0;
  std::vector<std::uint8_t> changes;
  std::vector<std::uint8_t> grid;
};

/// Row by row: one that cannot be read spoils no other.
class Rows {
 public:
  Rows(Database& database, const OccupancyGrid& first)
      : database_{database}, map_{std::bit_cast<std::int64_t>(grid_hash(first))} {}

  /// At least the highest: the page that holds it may be the one that is damaged.
  [[nodiscard]] std::int64_t last_id() {
    std::int64_t last = 0;
    try {
      return database_.number("SELECT max(id) FROM revision");
    } catch (const StoreError&) {  // from the beginning, up to the damage
    }
    try {
      Statement ids{database_, "SELECT id FROM revision ORDER BY id"};
      while (ids.step()) last = ids.number(0);
    } catch (const StoreError& error) {
      if (last == 0 && error.kind == StoreError::Kind::kOther) throw;  // not damaged: nothing of it can be read
    }
    return last + kBeyondDamage;
  }

  /// Nothing where it is a refusal, of another map, or cannot be read.
  [[nodiscard]] std::optional<Row> at(std::int64_t id) {
    try {
      Statement row{database_,
                    "SELECT number, time_ns, grid_hash, changes, grid FROM revision WHERE id = ? AND map = ? AND "
                    "refused = 0"};
      row.bind(id).bind(map_);
      if (!row.step()) return std::nullopt;
      return Row{static_cast<std::uint32_t>(row.number(0)), timestamp_from_ns(row.number(1)),
                 std::bit_cast<std::uint64_t>(row.number(2)), row.blob(3), row.blob(4)};
    } catch (const StoreError&) {
      return std::nullopt;
    }
  }

 private:
  Database& database_;
  std::int64_t map_;
};

std::optional<OccupancyGrid> if_whole(std::optional<OccupancyGrid> grid, std::uint64_t hash) {
  if (!grid || grid_hash(*grid) != hash) return std::nullopt;
  return grid;
}

/// The newest whole grid, and from there step by step as far as the steps are sound.
std::optional<SalvagedMap> newest_in(Database& database, const OccupancyGrid& first) {
  Rows rows{database, first};
  const std::int64_t last = rows.last_id();
  std::optional<SalvagedMap> newest;
  std::int64_t id = last;
  for (; id > 0 && !newest; --id) {
    const auto row = rows.at(id);
    if (!row || row->grid.empty()) continue;
    if (auto grid = if_whole(decoded_grid(row->grid, first.geometry()), row->hash)) {
      newest = SalvagedMap{row->number, row->time, *std::move(grid)};
    }
  }
  for (id += 2; newest && id <= last; ++id) {
    const auto row = rows.at(id);
    if (!row) continue;
    const auto changes = decoded_changes(row->changes, first.geometry());
    auto grid = changes ? if_whole(patched(newest->grid, *changes), row->hash) : std::nullopt;
    if (grid) newest = SalvagedMap{row->number, row->time, *std::move(grid)};
  }
  return newest;
}

}  // namespace

std::optional<SalvagedMap> newest_whole_map(const std::filesystem::path& store, const OccupancyGrid& first) {
  // Where nothing can be written beside it, its log cannot be taken into account: it is read as it is.
  for (const auto mode : {Database::Mode::kRead, Database::Mode::kReadAsIs}) {
    try {
      Database database{store, mode};
      database.run("PRAGMA writable_schema = ON");  // a file that was cut is read as far as it goes
      auto newest = newest_in(database, first);
      if (!newest || newest->number == 0) continue;
      return newest;
    } catch (const StoreError&) {  // the next way, or none
    }
  }
  return std::nullopt;
}

}  // namespace deltamap::mapping::store
