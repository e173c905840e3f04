// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/store_retention.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mapping/store/guarded_rows.hpp"
#include "mapping/store/map_codec.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr double kDay_s = 86'400.0;

/// The oldest of the newest `count` revisions; 0 where there are not more.
std::int64_t first_by_count(Database& database, std::int64_t map, std::uint32_t count) {
  Statement row{database,
                "SELECT number FROM revision WHERE map = ? AND refused = 0 ORDER BY number DESC LIMIT 1 OFFSET ?"};
  row.bind(map).bind(std::int64_t{count} - 1);
  return row.step() ? row.number(0) : 0;
}

/// The oldest revision below `end` that is not older than `days`, as far as its time is credible; `end` where all are.
std::int64_t first_by_age(Database& database, std::int64_t map, double days, Timestamp now, std::int64_t end) {
  const std::int64_t now_ns = unix_ns(now);
  const std::int64_t oldest_ns = unix_ns(now - duration_from_seconds(days * kDay_s));
  Statement rows{database,
                 "SELECT number, time_ns FROM revision WHERE map = ? AND refused = 0 AND number < ? ORDER BY number"};
  rows.bind(map).bind(end);
  std::int64_t first = 0;
  std::int64_t latest_ns = std::numeric_limits<std::int64_t>::min();
  while (rows.step()) {
    const std::int64_t time_ns = rows.number(1);
    if (time_ns > now_ns || time_ns < latest_ns) continue;
    if (time_ns >= oldest_ns) return first;
    latest_ns = time_ns;
    first = rows.number(0) + 1;
  }
  return first;
}

/// Revisions below it are kept by no rule.
std::int64_t first_kept(Database& database, std::int64_t map, const Retention& retention,
                        std::uint32_t first_provisional, Timestamp now) {
  const std::int64_t by_state = first_provisional > 0 ? first_provisional : std::numeric_limits<std::int64_t>::max();
  const std::int64_t by_count = retention.revisions > 0 ? first_by_count(database, map, retention.revisions)
                                                        : std::numeric_limits<std::int64_t>::max();
  const std::int64_t by_rules =
      retention.days > 0.0 ? first_by_age(database, map, retention.days, now, by_count) : by_count;
  return std::min(by_state, by_rules);
}

struct Stretch {
  std::int64_t first = 0;  ///< the oldest that is not whole
  std::int64_t end = 0;    ///< the next whole one
};

std::optional<Stretch> oldest_stretch(Database& database, std::int64_t map, std::int64_t first_kept) {
  Statement first{database,
                  "SELECT number FROM revision WHERE map = ? AND refused = 0 AND number < ? AND grid IS NULL "
                  "ORDER BY number LIMIT 1"};
  first.bind(map).bind(first_kept);
  if (!first.step()) return std::nullopt;
  Statement end{database,
                "SELECT number FROM revision WHERE map = ? AND refused = 0 AND number > ? AND grid IS NOT NULL "
                "ORDER BY number LIMIT 1"};
  end.bind(map).bind(first.number(0));
  // What is kept one by one needs the steps from the whole map before it.
  if (!end.step() || end.number(0) > first_kept) return std::nullopt;
  return Stretch{first.number(0), end.number(0)};
}

/// What all steps of the stretch together have changed, its end's included; a cell that is again what it was remains as
/// one that was written. Nothing where a step cannot be read.
std::optional<std::vector<CellChange>> changes_in(Database& database, std::int64_t map, const GridGeometry& geometry,
                                                  const Stretch& stretch) {
  Statement rows{database,
                 "SELECT changes FROM revision WHERE map = ? AND refused = 0 AND number BETWEEN ? AND ? ORDER BY "
                 "number"};
  rows.bind(map).bind(stretch.first).bind(stretch.end);
  std::vector<CellChange> all;
  while (rows.step()) {
    const auto step = decoded_changes(rows.blob(0), geometry);
    if (!step) return std::nullopt;
    all.insert(all.end(), step->begin(), step->end());
  }
  std::stable_sort(all.begin(), all.end(), [&](const CellChange& a, const CellChange& b) {
    return geometry.index_of(a.cell) < geometry.index_of(b.cell);
  });
  std::vector<CellChange> merged;
  for (const CellChange& change : all) {
    if (merged.empty() || merged.back().cell != change.cell) {
      merged.push_back(change);
    } else {
      merged.back().after = change.after;
    }
  }
  return merged;
}

/// "evidence (65 to 128 in one)"
std::string told_cause(std::string cause, const Stretch& stretch) {
  if (const std::size_t old = cause.rfind(" ("); old != std::string::npos && cause.ends_with(" in one)")) {
    cause.resize(old);
  }
  return cause + " (" + std::to_string(stretch.first) + " to " + std::to_string(stretch.end) + " in one)";
}

std::string cause_of(Database& database, std::int64_t map, std::int64_t number) {
  Statement row{database, "SELECT cause FROM revision WHERE map = ? AND refused = 0 AND number = ?"};
  row.bind(map).bind(number);
  return row.step() ? row.text(0) : std::string{};
}

void write_end(Database& database, std::int64_t map, const GridGeometry& geometry, const Stretch& stretch,
               const std::vector<CellChange>& written) {
  std::vector<CellChange> changed = written;
  std::erase_if(changed, [](const CellChange& change) { return change.before == change.after; });
  const auto became = [&](CellState state) {
    return static_cast<std::int64_t>(
        std::count_if(changed.begin(), changed.end(), [&](const CellChange& change) { return change.after == state; }));
  };
  const CellBox box = bounding_box(changed);
  Statement row{database,
                "UPDATE revision SET changes = ?, cause = ?, occupied = ?, freed = ?, unknown = ?, first_column = ?, "
                "first_row = ?, last_column = ?, last_row = ? WHERE map = ? AND refused = 0 AND number = ?"};
  row.bind(encoded_changes(written, geometry)).bind(told_cause(cause_of(database, map, stretch.end), stretch));
  row.bind(became(CellState::kOccupied)).bind(became(CellState::kFree)).bind(became(CellState::kUnknown));
  for (const int side : {box.first.column, box.first.row, box.last.column, box.last.row}) row.bind(std::int64_t{side});
  row.bind(map).bind(stretch.end);
  row.step();
}

}  // namespace

bool thin_out(Database& database, std::int64_t map, const GridGeometry& geometry, const Retention& retention,
              std::uint32_t first_provisional, Timestamp now) {
  if (retention.keeps_all()) return false;
  const auto found = [&] {
    return oldest_stretch(database, map, first_kept(database, map, retention, first_provisional, now));
  };
  if (!found()) return false;
  Transaction all{database};
  const auto stretch = found();  // another program may have named one of them
  if (!stretch) return false;
  const std::string accepted = "map = " + std::to_string(map) + " AND refused = 0 AND number ";
  const std::string all_steps =
      accepted + "BETWEEN " + std::to_string(stretch->first) + " AND " + std::to_string(stretch->end);
  if (!are_sound(database, Table::kRevision, all_steps)) return false;
  const auto written = changes_in(database, map, geometry, *stretch);
  if (!written) return false;
  write_end(database, map, geometry, *stretch, *written);
  guard(database, Table::kRevision, accepted + "= " + std::to_string(stretch->end));
  remove_rows(database, Table::kRevision, all_steps + " AND grid IS NULL");
  all.commit();
  return true;
}

}  // namespace deltamap::mapping::store
