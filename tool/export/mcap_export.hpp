// SPDX-License-Identifier: Apache-2.0
// A recording, a run, or both as MCAP for Foxglove: /scan, /odom and /log of the recording; /pose, /map and /log of the
// run. With both, scans lie in the map where the run has placed them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"

namespace deltamap::tool {

struct McapSource {
  std::optional<std::filesystem::path> run;  ///< a folder of --out
  std::optional<std::string> recording;
  daemon::Settings settings;  ///< of the recording: mount, ranges
};

struct McapResult {
  std::uint64_t messages = 0;
  std::vector<std::string> warnings;
};

/// Throws std::runtime_error with one line where something cannot be read or written.
[[nodiscard]] McapResult export_mcap(const McapSource& source, const std::filesystem::path& file);

}  // namespace deltamap::tool
