// SPDX-License-Identifier: Apache-2.0
// What can be had of a map store that is damaged, or may not be written: all of its histories, as far as they can be
// read or follow from what can, in another store. Only reads the damaged one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::store {

struct History;

struct Recovery {
  std::uint32_t revisions = 0;            ///< that are there again, M_0 not counted
  std::vector<std::uint32_t> computed{};  ///< of these: what they changed follows from their neighbours
  std::vector<std::uint32_t> lost{};      ///< cannot be had
  std::uint32_t elsewhere = 0;            ///< computed or lost of first maps that were not asked for
  bool goes_on_without = false;           ///< later maps lack what a lost revision alone has changed
  std::uint32_t newest = 0;               ///< that is there again
  std::uint32_t known = 0;                ///< so many are known to have been written; 0: not known

  /// "150 revisions recovered, of these computed from their neighbours: 70; lost for good: 12, 14 to 16". What was
  /// written behind the newest one is lost, too.
  [[nodiscard]] std::string words() const;
};

/// Into an empty store. `first`: M_0 of the history that is asked for, which need not be in the file; null: the one
/// used last. Throws StoreError where the one cannot be read at all, or the other not be written.
[[nodiscard]] Recovery recover(const std::filesystem::path& damaged, const OccupancyGrid* first, History& target);
/// Into a new file.
[[nodiscard]] Recovery recover(const std::filesystem::path& damaged, const OccupancyGrid& first,
                               const std::filesystem::path& target);

}  // namespace deltamap::mapping::store
