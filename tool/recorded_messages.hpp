// SPDX-License-Identifier: Apache-2.0
// A recording, message by message, with a line of progress.
#pragma once

#include <string>

#include "daemon/records/recording_decoder.hpp"
#include "daemon/settings/settings.hpp"
#include "drivers/port/replay_port.hpp"

namespace deltamap::tool {

/// Answers what the recording lacks. `what`: what is done with it, for the line of progress. Throws
/// what ReplayPort throws.
drivers::port::LogFaults read_messages(const std::string& recording, const daemon::Settings& settings,
                                       const daemon::RecordingDecoder::Sinks& sinks, const std::string& what);

}  // namespace deltamap::tool
