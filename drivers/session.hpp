// SPDX-License-Identifier: Apache-2.0
// What a device session asks of its port each time it is fed. Sessions know no port: they take bytes and time and
// answer packets and requests, so that they can be replayed, fuzzed and simulated.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace deltamap::drivers {

enum class SessionMode {
  kLive,       ///< talks: synchronizes, configures, keeps alive, times out
  kListenOnly  ///< a replay: decodes what comes; no writes, no time-outs, no reconnect
};

/// One thing for the port to do, in order.
struct PortRequest {
  enum class Kind { kWrite, kSetBaud, kDiscardInput } kind = Kind::kWrite;
  std::vector<std::uint8_t> bytes;  ///< kWrite
  unsigned baud = 0;                ///< kSetBaud
};

struct SessionOutput {
  std::vector<PortRequest> requests;
  std::vector<std::string> log;       ///< short lower-case lines worth telling the operator
  std::vector<std::string> warnings;  ///< the same, of what he has to mend
  std::optional<Timestamp> wake_at;   ///< call on_time() no later than this
  std::optional<std::string> failed;  ///< the session is over; reconnect after a pause
};

}  // namespace deltamap::drivers
