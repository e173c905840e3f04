// SPDX-License-Identifier: Apache-2.0
// `deltamap replay REC --to-pty DIR`: the devices of a recording on two pseudo-terminals, in real time, for any client.
#pragma once

#include <filesystem>

#include "drivers/port/replay_port.hpp"

namespace deltamap::tool {

/// Waits until a client has opened both ports, plays until the recording ends or a signal comes, and tells on standard
/// error where the client has said something else than was recorded; at the end a line of it all on standard output.
/// Throws std::runtime_error with one line.
void play_recording(const std::filesystem::path& recording, const std::filesystem::path& links,
                    const drivers::port::ReplayWindow& window);

}  // namespace deltamap::tool
