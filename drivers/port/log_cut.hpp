// SPDX-License-Identifier: Apache-2.0
// Where a recording ends before its file does: the power failed, the disk was full, or a sector is damaged.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/time.hpp"

namespace deltamap::drivers::port {

struct LogCut {
  std::uint64_t byte = 0;                ///< of the file: the first that is not read
  std::uint64_t unread_bytes = 0;        ///< from there to the end of the file
  std::optional<Timestamp> last_record;  ///< stamp of the last whole record; nothing where there is none
  std::string text;                      ///< one line that names file, byte, reason and time
};

}  // namespace deltamap::drivers::port
