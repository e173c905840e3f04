// SPDX-License-Identifier: Apache-2.0
// Turns a ROS 1 bag or an MCAP file into a recording: its scans and odometry become the CARMEN log that they would be,
// and this the bytes that a P3-DX and an LMS200 would have sent (tool/import_carmen).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tool/import/message_file.hpp"
#include "tool/import_carmen.hpp"

namespace deltamap::tool {

struct MessageImport {
  std::filesystem::path file;
  bool is_bag = false;                ///< else MCAP
  std::string scan_topic;             ///< empty: the only one with scans
  std::string odom_topic;             ///< empty: the only one with Odometry
  std::string odom_frame = "odom";    ///< of transforms, those from this frame are the robot's pose
  std::optional<double> no_return_m;  ///< this range and longer ones are no return, beside what the messages say
  std::filesystem::path recording;
};

struct ImportedMessages {
  CarmenImport carmen;
  std::vector<std::string> notes;  ///< what was left out or doubted, and settings to use, one line each
  std::string cut;                 ///< where the file could be read no farther; empty: nowhere
};

/// Throws std::runtime_error: one line that names the file and, for a topic that is not there, which are.
[[nodiscard]] ImportedMessages import_messages(const MessageImport& wanted);

}  // namespace deltamap::tool
