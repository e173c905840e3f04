// SPDX-License-Identifier: Apache-2.0
// Bays and zones in a recording: those that a run begins with, and others that it has taken since. A replay takes them
// before the same scan.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/records/note_parts.hpp"
#include "daemon/site/site.hpp"

namespace deltamap::daemon {

struct SetSite {
  std::uint32_t scan = 0;  ///< before which they were taken
  Timestamp scan_time;     ///< Scan.time of that scan
  SharedSite site;         ///< never null
};

/// Each fits a pcapng comment.
[[nodiscard]] std::vector<std::string> notes_of(const SetSite& set);

/// Puts the notes of one site together again.
class SetSiteReader {
 public:
  SetSiteReader();
  /// Any note, in order; those of other kinds are passed over. An answer with the last note of a site; nothing where
  /// some are missing or damaged.
  [[nodiscard]] std::optional<SetSite> read(std::string_view note);

 private:
  PartsReader parts_;
};

}  // namespace deltamap::daemon
