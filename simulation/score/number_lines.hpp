// SPDX-License-Identifier: Apache-2.0
// Files of eight numbers a line, as trajectories and relations are published.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace deltamap::simulation::score {

/// What comes after the eighth number of a line is passed over, and so are lines that begin with #. `what` a line is,
/// and its `columns`, for errors. Throws std::runtime_error naming file and line; so does a file without any.
[[nodiscard]] std::vector<std::array<double, 8>> number_lines(const std::filesystem::path& file,
                                                              const std::string& what, const std::string& columns);

}  // namespace deltamap::simulation::score
