// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/written_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/near_occupied.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kRightShare = 0.8;     // of a written thing's cells
constexpr int kThingReach = 2;          // cells; written cells so near are one thing
constexpr std::size_t kLeastCells = 3;  // smaller groups are not counted as things

/// Written cells that are near each other.
std::vector<std::vector<CellChange>> things_of(std::vector<CellChange> left) {
  std::vector<std::vector<CellChange>> things;
  while (!left.empty()) {
    std::vector<CellChange> thing{left.back()};
    left.pop_back();
    for (std::size_t next = 0; next < thing.size(); ++next) {
      const Cell middle = thing[next].cell;
      const auto is_near = [&](const CellChange& other) {
        return std::abs(other.cell.column - middle.column) <= kThingReach &&
               std::abs(other.cell.row - middle.row) <= kThingReach;
      };
      const auto first = std::partition(left.begin(), left.end(), [&](const CellChange& c) { return !is_near(c); });
      thing.insert(thing.end(), first, left.end());
      left.erase(first, left.end());
    }
    things.push_back(std::move(thing));
  }
  return things;
}

/// What is drawn may lie a cell beside its surface. So a freed cell is right, too, where its surface still is drawn a
/// cell beside: a face that is moved by a cell has not gone.
bool agrees(const CellChange& change, const OccupancyGrid& map, const OccupancyGrid& truth) {
  if (change.after == CellState::kOccupied) return has_occupied_within(truth, change.cell, 1);
  if (change.after == CellState::kUnknown) return truth[change.cell] != CellState::kFree;
  return truth[change.cell] != CellState::kOccupied || has_occupied_within(map, change.cell, 1);
}

}  // namespace

template <typename IsRight>
void WrittenCells::count_things(const std::vector<CellChange>& written, IsRight&& is_right) {
  for (const std::vector<CellChange>& thing : things_of(written)) {
    if (thing.size() < kLeastCells) continue;
    ++things_;
    const auto right = static_cast<double>(std::count_if(thing.begin(), thing.end(), is_right));
    things_wrong_ += right < kRightShare * static_cast<double>(thing.size()) ? 1 : 0;
  }
}

void WrittenCells::observe(const Written& written, const simulation::score::MapTruth& truth,
                           const OccupancyGrid& standing) {
  ++revisions_;
  cells_ += written.changes.size();
  if (written.is_astray) cells_astray_ += written.changes.size();
  const auto is_right = [&](const CellChange& change) { return agrees(change, written.map, truth.visible()); };
  std::vector<CellChange> come;
  std::vector<CellChange> gone;
  for (const CellChange& change : written.changes) {
    const std::size_t cell = geometry_.index_of(change.cell);
    ++writes_[cell];
    cells_wrong_ += is_right(change) ? 0 : 1;
    if (truth.is_at_door(cell)) continue;  // it comes and goes
    if (change.after == CellState::kOccupied) come.push_back(change);
    if (change.before == CellState::kOccupied && change.after == CellState::kFree) gone.push_back(change);
  }
  // Who has stood there for so long that the map takes him in does stand there.
  count_things(come, [&](const CellChange& change) {
    return is_right(change) || has_occupied_within(standing, change.cell, 1);
  });
  count_things(gone, is_right);
}

void WrittenCells::observe_withdrawal(std::span<const CellChange> changes) {
  ++revisions_;
  cells_ += changes.size();
  cells_withdrawn_ += changes.size();
  for (const CellChange& change : changes) ++writes_[geometry_.index_of(change.cell)];
}

std::vector<std::pair<std::string, double>> WrittenCells::numbers(const simulation::score::CellMask& seen,
                                                                  double hours) const {
  std::size_t seen_cells = 0;
  std::size_t writes = 0;
  std::uint16_t most_writes = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == 0) continue;
    ++seen_cells;
    writes += writes_[i];
    most_writes = std::max(most_writes, writes_[i]);
  }
  const auto whole = [](std::size_t number) { return static_cast<double>(number); };
  const auto share = [&](std::size_t part, std::size_t all) {
    return all == 0 ? std::numeric_limits<double>::quiet_NaN() : whole(part) / whole(all);
  };
  return {{"things_written", whole(things_)},
          {"precision", 1.0 - share(things_wrong_, things_)},
          {"cells_written", whole(cells_)},
          {"cells_wrong", share(cells_wrong_, cells_)},
          {"cells_written_astray", whole(cells_astray_)},
          {"cells_withdrawn", whole(cells_withdrawn_)},
          {"writes_per_cell_hour", share(writes, seen_cells) / hours},
          {"most_writes_of_a_cell", static_cast<double>(most_writes)},
          {"revisions", whole(revisions_)},
          {"refused", whole(refused_)}};
}

}  // namespace deltamap::experiments
