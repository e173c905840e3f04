// SPDX-License-Identifier: Apache-2.0
// `deltamap decode REC.pcapng`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/port/replay_port.hpp"

namespace deltamap::tool {

struct RecordingToDecode {
  std::string file;
  drivers::port::ReplayWindow window;
  std::vector<std::string> kinds;  ///< names of frames, "note", "garbage"; empty: all
  std::optional<std::uint8_t> measuring_mode;
  bool as_json = false;
};

/// Prints its frames. Throws std::runtime_error with one line: what ByteLogReader throws, or a kind that does not
/// occur.
void decode_recording(const RecordingToDecode& wanted);

}  // namespace deltamap::tool
