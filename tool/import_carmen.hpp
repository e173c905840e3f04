// SPDX-License-Identifier: Apache-2.0
// Turns a CARMEN log into a recording: the bytes that a P3-DX and an LMS200 would have sent.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "drivers/carmen/carmen_survey.hpp"

namespace deltamap::tool {

struct CarmenImport {
  drivers::carmen::CarmenSurvey survey;
  std::size_t poses = 0;  ///< packets of odometry
  std::size_t gaps = 0;   ///< pauses of more than an hour, left unfilled
};

/// drivers::carmen::survey_of behind a progress bar.
[[nodiscard]] drivers::carmen::CarmenSurvey shown_survey_of(const std::filesystem::path& log,
                                                            std::optional<double> no_return_m);

/// Writes the recording whole or not at all. Throws std::runtime_error: one line that names file and place.
[[nodiscard]] CarmenImport import_carmen(const std::filesystem::path& log, const std::filesystem::path& recording,
                                         std::optional<double> no_return_m);

/// On the standard output.
void tell_import(const CarmenImport& done, const std::string& recording, bool as_json);

}  // namespace deltamap::tool
