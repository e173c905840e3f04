// SPDX-License-Identifier: Apache-2.0
// A small first map, revisions that follow it, and what a store complains of.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "core/messages.hpp"
#include "core/random.hpp"

namespace deltamap::test {

[[nodiscard]] inline OccupancyGrid first_map() { return OccupancyGrid{{40, 30, 0.1, {-1.0, -2.0}}, CellState::kFree}; }

/// The map with `cells` of its own for each number, a second apart.
[[nodiscard]] inline MapRevision revision_after(const OccupancyGrid& before, std::uint32_t number, int cells = 5) {
  OccupancyGrid after = before;
  Random random{number};
  const auto width = static_cast<std::uint32_t>(before.geometry().width);
  const auto height = static_cast<std::uint32_t>(before.geometry().height);
  for (int i = 0; i < cells; ++i) {
    const Cell cell{static_cast<int>(random.index_below(width)), static_cast<int>(random.index_below(height))};
    after.set(cell, static_cast<CellState>(random.index_below(3)));
  }
  MapRevision revision;
  revision.number = number;
  revision.time = timestamp_from_ns(std::int64_t{number} * 1'000'000'000);
  revision.changes = changes_between(before, after);
  revision.map = std::make_shared<const OccupancyGrid>(std::move(after));
  return revision;
}

/// What it says as it fails; empty: it does not.
[[nodiscard]] inline std::string complaint(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace deltamap::test
