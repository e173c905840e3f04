// SPDX-License-Identifier: Apache-2.0
// What merges are tried on: a map, and beside it the world that local maps are cut from, which shares two thirds of it;
// a local map lies turned and shifted by a known transform.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/random.hpp"
#include "mapping/merge/overlay_score.hpp"

namespace deltamap::experiments {

struct MergePlace {
  std::string name;
  OccupancyGrid map;
  OccupancyGrid other;   ///< finer than the map where it is drawn
  Pose2 map_from_other;  ///< how the frames lie
  mapping::merge::OverlayMap overlay;
};

/// Cells of every map that is merged.
constexpr double kMergeResolution_m = 0.1;

/// The map is the left three quarters of the layout, the other world the right three quarters.
[[nodiscard]] MergePlace drawn_place(const std::string& layout, std::uint64_t seed);
/// The same of the maps `freiburg` (both from one map) and `gdc2` (the floor without furniture, and with). `data` holds
/// the folder maps with NAME.yaml and NAME.pgm or NAME.pgm.xz. Throws std::runtime_error where a file is broken.
[[nodiscard]] std::vector<std::string> recorded_places();
[[nodiscard]] std::optional<MergePlace> recorded_place(const std::string& name, const std::filesystem::path& data);

struct LocalMap {
  Pose2 local_from_other;
  OccupancyGrid grid;
};
/// Turned anyhow and shifted by up to 10 cells along each axis (paper §3.4.2); `whole`: by whole degrees and cells.
[[nodiscard]] LocalMap turned_local(const MergePlace& place, bool whole, Random& random);

struct MergeMeasure {
  double acceptance = 0.0;       ///< Eq. 11 at the pose found
  double true_acceptance = 0.0;  ///< Eq. 11 at the true pose: what the best merge would reach, but for chance
  double agreement = 0.0;        ///< share of the local contour found again at the pose found
  double off_cells = 0.0;        ///< at the local map's middle
  double turn_deg = 0.0;
};
[[nodiscard]] MergeMeasure measured(const MergePlace& place, const LocalMap& local, const Pose2& map_from_local);

/// Milliseconds of this thread's CPU time that the work takes: runs go on side by side.
[[nodiscard]] double cpu_ms(const std::function<void()>& work);

}  // namespace deltamap::experiments
