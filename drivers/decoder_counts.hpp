// SPDX-License-Identifier: Apache-2.0
// What a decoder has seen, by cause: good frames and every kind of garbage. Telemetry shows it.
#pragma once

#include <cstdint>

namespace deltamap::drivers {

struct DecoderCounts {
  std::uint64_t frames = 0;         ///< whole frames with a right checksum
  std::uint64_t garbage_bytes = 0;  ///< bytes that belong to no frame
  std::uint64_t bad_length = 0;     ///< headers whose length field cannot be
  std::uint64_t bad_checksum = 0;   ///< frames of full length whose checksum or CRC is wrong
  std::uint64_t truncated = 0;      ///< frames that began and never ended
  std::uint64_t malformed = 0;      ///< right checksum, but the content does not fit its type
  std::uint64_t unknown = 0;        ///< right checksum, of a type that we do not read

  [[nodiscard]] std::uint64_t errors() const {
    return garbage_bytes + bad_length + bad_checksum + truncated + malformed;
  }
};

}  // namespace deltamap::drivers
