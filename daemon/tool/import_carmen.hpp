// SPDX-License-Identifier: Apache-2.0
// Turns a CARMEN log into a recording: the bytes that a P3-DX and an LMS200 would have sent.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "daemon/tool/carmen_survey.hpp"

namespace deltamap::daemon::tool {

struct CarmenImport {
  CarmenSurvey survey;
  std::size_t poses = 0;  ///< packets of odometry
  std::size_t gaps = 0;   ///< pauses of more than an hour, left unfilled
};

/// Writes the recording whole or not at all. Throws std::runtime_error: one line that names file and place.
[[nodiscard]] CarmenImport import_carmen(const std::filesystem::path& log, const std::filesystem::path& recording,
                                         std::optional<double> no_return_m);

}  // namespace deltamap::daemon::tool
