// SPDX-License-Identifier: Apache-2.0
// Drives whose trajectory is bent on purpose, as SLAM bends them where it fails, and how false the map is that they
// draw: known, for the truth is.
#pragma once

#include <string_view>
#include <vector>

#include "core/messages.hpp"
#include "core/random.hpp"
#include "surveying/quality/passes.hpp"

namespace deltamap::experiments {

/// Scans of one or two drives, in order of time.
struct DrivenScans {
  std::vector<localization::motion::PackedScan> scans;
  std::vector<std::uint32_t> drive;
  std::vector<Pose2> truth;
};

enum class Bend : std::uint8_t {
  kNone,     ///< poses off as those of a good map: 2 cm and 0.3°, slowly changing
  kKink,     ///< the heading turns by 3 to 20° within 2 m, and stays so
  kScale,    ///< 3 % too long or too short
  kShift,    ///< 6 to 20 m of way lie 0.5 to 2 m off
  kAlias,    ///< the rest of the drive lies 3 to 15 m off, as where an aisle was taken for the next
  kMirrored  ///< the second drive is joined half a turn round
};
inline constexpr Bend kBends[] = {Bend::kNone,  Bend::kKink,  Bend::kKink,  Bend::kScale,
                                  Bend::kShift, Bend::kShift, Bend::kAlias, Bend::kMirrored};
[[nodiscard]] std::string_view name_of(Bend bend);

[[nodiscard]] std::vector<Pose2> bent(Bend bend, const DrivenScans& driven, Random& random);

/// Each scan at its pose of `poses`.
[[nodiscard]] std::vector<surveying::quality::PlacedScan> placed_at(const DrivenScans& driven,
                                                                    const std::vector<Pose2>& poses);

/// Wall that two passes of the drive draw apart by more than 0.3 m, square to it, m.
[[nodiscard]] double doubled_wall_m(const DrivenScans& driven, const std::vector<Pose2>& poses);

}  // namespace deltamap::experiments
