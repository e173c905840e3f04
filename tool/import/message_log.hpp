// SPDX-License-Identifier: Apache-2.0
// Scans and poses of other programs as the CARMEN log that they would be.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tool/import/ros_messages.hpp"

namespace deltamap::tool {

struct WrittenLog {
  std::optional<double> no_return_m;  ///< how the log says that nothing came back; none: it never says so
  std::uint64_t no_returns = 0;       ///< beams
  std::uint64_t not_valid = 0;        ///< beams without a number, or nearer than the laser measures
};

/// RAWLASER1 and ODOM lines in the order of their times; both vectors are sorted. `no_return_m`: longer ranges are
/// none, whatever the scans say. Throws std::runtime_error naming the file.
[[nodiscard]] WrittenLog write_carmen_log(const std::filesystem::path& file, std::vector<RosScan>& scans,
                                          std::vector<RosPose>& poses, std::optional<double> no_return_m);

/// Where the scans' frame lies in `base`, by the transforms; nothing where no chain of them leads there.
[[nodiscard]] std::optional<PlanarPose> mount_by(const std::vector<RosPose>& transforms, const std::string& laser_frame,
                                                 const std::string& base);

}  // namespace deltamap::tool
