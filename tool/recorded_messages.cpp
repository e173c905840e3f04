// SPDX-License-Identifier: Apache-2.0
#include "tool/recorded_messages.hpp"

#include "tool/progress.hpp"

namespace deltamap::tool {

drivers::port::LogFaults read_messages(const std::string& recording, const daemon::Settings& settings,
                                       const daemon::RecordingDecoder::Sinks& sinks, const std::string& what) {
  drivers::port::ReplayPort port{recording, {}};
  daemon::RecordingDecoder decoder{settings};
  Progress progress{what, port.size_bytes()};
  while (const auto replayed = port.next()) {
    decoder.feed(replayed->record, sinks);
    progress.show(port.read_bytes());
  }
  return port.faults();
}

}  // namespace deltamap::tool
