// SPDX-License-Identifier: Apache-2.0
// What the files of a finished run tell of it, in the measures of measures.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tool/tune/measures.hpp"
#include "tool/tune/tuned_drive.hpp"

namespace deltamap::tool::tune {

struct ScoredFolder {
  Numbers numbers;
  std::vector<std::string> notes;  ///< what could not be measured, and why
};

/// Of trajectory.tum, localization.csv, map.yaml and report.json. `recording`: of the run; empty: the one that
/// report.json names. `map`: what scans are held against; empty: the folder's own. Throws std::runtime_error that names
/// the file.
[[nodiscard]] ScoredFolder scored_folder(const std::filesystem::path& folder, const std::filesystem::path& map,
                                         const TrueWay& way);

/// Distance of the seeds' poses from their middle, scan by scan, root mean square, m. NaN with fewer than two seeds, or
/// where they tell of different scans.
[[nodiscard]] double repeatability_m(const std::vector<std::vector<TunedDrive::StampedPose>>& of_seeds);

}  // namespace deltamap::tool::tune
