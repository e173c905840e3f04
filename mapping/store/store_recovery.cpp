// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/store_recovery.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "core/counted.hpp"
#include "mapping/store/chain_recovery.hpp"
#include "mapping/store/history.hpp"
#include "mapping/store/map_codec.hpp"
#include "mapping/store/readable_rows.hpp"
#include "mapping/store/store_schema.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::uint32_t kMostMissing = 5000;  // revisions in a row of which no row can be read

/// First and last number.
using Range = std::pair<std::uint32_t, std::uint32_t>;

/// Of numbers in order.
std::vector<Range> ranges_of(const std::vector<std::uint32_t>& numbers) {
  std::vector<Range> ranges;
  for (const std::uint32_t number : numbers) {
    const bool goes_on = !ranges.empty() && ranges.back().second + 1 == number;
    if (!goes_on) ranges.emplace_back(number, number);
    ranges.back().second = number;
  }
  return ranges;
}

/// "12, 14 to 16"
std::string listed(const std::vector<Range>& ranges) {
  std::string text;
  for (const auto& [first, last] : ranges) {
    text += (text.empty() ? "" : ", ") + std::to_string(first);
    if (last > first) text += " to " + std::to_string(last);
  }
  return text;
}

/// With those behind the newest that are known to have been written.
std::vector<Range> all_lost(const Recovery& recovery) {
  std::vector<Range> lost = ranges_of(recovery.lost);
  const std::uint32_t told = std::max(recovery.newest, lost.empty() ? 0 : lost.back().second);
  if (recovery.known <= told) return lost;
  const bool goes_on = !lost.empty() && lost.back().second == told;
  if (!goes_on) lost.emplace_back(told + 1, told + 1);
  lost.back().second = recovery.known;
  return lost;
}

/// The order of rows is that of their numbers in the file; damage may have given two the same.
class RowIds {
 public:
  explicit RowIds(const ReadableRows& rows) {
    for (const auto& [hash, of_map] : rows.maps()) {
      for (const auto& [number, row] : of_map.revisions) known_.insert(row.id);
      for (const auto& [id, row] : of_map.refusals) known_.insert(id);
    }
  }
  std::int64_t of(const ReadableRow& row) { return used_.insert(row.id).second ? row.id : behind(row.id); }
  /// Of a row that cannot be read: where it must have been.
  std::int64_t behind(std::int64_t id) {
    do ++id;
    while (known_.contains(id) || used_.contains(id));
    used_.insert(id);
    return id;
  }

 private:
  std::set<std::int64_t> known_;
  std::set<std::int64_t> used_;
};

class HistoryRecovery {
 public:
  HistoryRecovery(ReadableRows& rows, RowIds& ids, History& target, const OccupancyGrid* first)
      : rows_{rows}, ids_{ids}, target_{target}, first_{first} {}

  Recovery run(const ReadableRows::OfMap& readable) {
    ChainParts parts;
    parts.geometry = target_.geometry;
    if (first_ != nullptr && !readable.revisions.contains(0)) {
      steps_.push_back(nullptr);
      parts.steps.push_back({.hash = target_.map, .is_sure = true, .has_grid = true});
    }
    for (const auto& [number, row] : readable.revisions) {
      const std::uint32_t last = parts.steps.empty() ? 0 : parts.steps.back().number;
      if (!row.is_sure && number - last > kMostMissing) continue;  // its number is what is damaged
      steps_.push_back(&row);
      parts.steps.push_back({number, row.hash, row.is_sure, row.has_grid, row.changes});
    }
    parts.grid = [this](std::size_t i) { return grid_of(i); };
    parts.made = [this](const MadeStep& made, const OccupancyGrid& map) { write(made, map); };
    recovery_.lost = remake_chain(parts);
    for (const auto& [id, refusal] : readable.refusals) {
      rows_.copy(refusal, ids_.of(refusal), target_.database, {});
    }
    return std::move(recovery_);
  }

 private:
  std::optional<OccupancyGrid> grid_of(std::size_t i) {
    const ReadableRow* row = steps_[i];
    const bool is_first = row == nullptr || row->number == 0;
    if (is_first && first_ != nullptr) return *first_;
    return row != nullptr ? rows_.grid_of(*row, target_.geometry) : std::nullopt;
  }

  void write(const MadeStep& made, const OccupancyGrid& map) {
    recovery_.revisions += made.number > 0 ? 1 : 0;
    recovery_.newest = made.number;
    const ReadableRow* row = made.step ? steps_[*made.step] : nullptr;
    const bool is_whole = made.needs_grid || made.number % kGridEvery == 0 || (row != nullptr && row->is_named);
    const std::vector<std::uint8_t> grid = is_whole ? encoded_grid(map) : std::vector<std::uint8_t>{};
    if (made.is_computed) recovery_.computed.push_back(made.number);
    if (row != nullptr) {
      newest_ = *row;
      newest_.id = ids_.of(*row);
      rows_.copy(*row, newest_.id, target_.database, grid);
      if (!made.is_as_it_was) target_.rewrite(made.number, made.changes, map);
      recovery_.goes_on_without = recovery_.goes_on_without || made.lacks_something;
      return;
    }
    const std::string cause = made.number == 0 ? "first map" : "computed from its neighbours";
    newest_.id = ids_.behind(newest_.id);
    target_.write(summary_of(made.number, timestamp_from_ns(newest_.time_ns), {.cause = cause}, made.changes),
                  signed_hash(map), encoded_changes(made.changes, target_.geometry), grid, newest_.id);
  }

  ReadableRows& rows_;
  RowIds& ids_;
  History& target_;
  const OccupancyGrid* first_;
  std::vector<const ReadableRow*> steps_;  // null: M_0 as it was given
  ReadableRow newest_;                     // so far
  Recovery recovery_;
};

}  // namespace

std::string Recovery::words() const {
  const std::vector<Range> all = all_lost(*this);
  const std::string told_lost = all.empty() ? "" : "; lost for good: " + listed(all);
  if (revisions == 0) {
    const std::string nothing = "nothing of this first map's history can be recovered: begins with the first map";
    return known > 0 ? nothing + told_lost : nothing;
  }
  std::string text = counted(revisions, "revision") + " recovered";
  if (!computed.empty()) text += ", of these computed from their neighbours: " + listed(ranges_of(computed));
  text += told_lost;
  if (goes_on_without) text += " (later maps are without what these alone have changed)";
  if (elsewhere > 0) text += "; computed or lost of other first maps: " + std::to_string(elsewhere);
  return text;
}

Recovery recover(const std::filesystem::path& damaged, const OccupancyGrid* first, History& target) {
  ReadableRows rows{damaged};
  RowIds ids{rows};
  Recovery all;
  const std::int64_t asked = first != nullptr ? signed_hash(*first) : rows.last_used();
  Transaction transaction{target.database};
  for (const auto& [hash, of_map] : rows.maps()) {
    const OccupancyGrid* own_first = first != nullptr && hash == asked ? first : nullptr;
    if (of_map.revisions.empty() || (own_first == nullptr && !of_map.geometry)) continue;
    target.map = hash;
    target.geometry = own_first != nullptr ? own_first->geometry() : *of_map.geometry;
    if (!rows.copy_map(hash, target.geometry, target.database)) target.begin_without_first(target.geometry);
    Recovery one = HistoryRecovery{rows, ids, target, own_first}.run(of_map);
    if (hash == asked) {
      all.revisions = one.revisions;
      all.computed = std::move(one.computed);
      all.lost = std::move(one.lost);
      all.goes_on_without = one.goes_on_without;
      all.newest = one.newest;
    } else {
      all.elsewhere += static_cast<std::uint32_t>(one.computed.size() + one.lost.size());
    }
  }
  transaction.commit();
  return all;
}

Recovery recover(const std::filesystem::path& damaged, const OccupancyGrid& first,
                 const std::filesystem::path& target) {
  History history{opened_store(target, Database::Mode::kCreate)};
  return recover(damaged, &first, history);
}

}  // namespace deltamap::mapping::store
