// SPDX-License-Identifier: Apache-2.0
// The messages of a file that other programs have recorded, in the order of the file.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/time.hpp"

namespace deltamap::tool {

struct MessageView {
  std::string_view topic;
  std::string_view type;      ///< "sensor_msgs/LaserScan", "foxglove.LaserScan"
  std::string_view encoding;  ///< "ros1", "cdr", "json"
  Timestamp logged;
  std::string_view data;  ///< valid during the call
};

/// What a file holds, and how far it could be read.
struct MessageFile {
  struct Topic {
    std::string type;
    std::string encoding;
    std::uint64_t messages = 0;
  };
  std::map<std::string, Topic> topics;
  /// Empty: to its end. Else one line: what is wrong from which byte on; all before it was read.
  std::string cut;
};

using TakeMessage = std::function<void(const MessageView&)>;

/// A ROS 1 bag (format 2.0), its chunks uncompressed, bz2 or lz4. Throws std::runtime_error where it is none at all.
[[nodiscard]] MessageFile read_bag(std::string_view bytes, const TakeMessage& take);
/// MCAP (https://mcap.dev/spec), its chunks uncompressed, lz4 or zstd. Throws std::runtime_error where it is none at
/// all.
[[nodiscard]] MessageFile read_mcap(std::string_view bytes, const TakeMessage& take);

}  // namespace deltamap::tool
