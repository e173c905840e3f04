// SPDX-License-Identifier: Apache-2.0
// What `deltamap ctl` may ask of the running daemon, and how both write it on the control socket: one JSON line a
// request, one a reply. Knows no socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/geometry/pose2.hpp"
#include "daemon/site/site_edit.hpp"
#include "daemon/telemetry/log_level.hpp"

namespace deltamap::daemon::control {

inline constexpr std::size_t kLongestLine = 4096;  ///< bytes of a request with its line end
inline constexpr std::size_t kLongestWords = 400;  ///< bytes of a mark's words

struct Request {
  enum class Kind : std::uint8_t {
    kStatus,
    kPause,        ///< the map stays as it is; the localizer goes on
    kResume,       ///< the map follows the world again
    kSave,         ///< map and pose on disk, now
    kReload,       ///< the settings file again: what can change is taken
    kRelocalize,   ///< the robot stands at map_from_robot
    kUndo,         ///< Δ `revision` alone is taken back
    kUndoThing,    ///< `thing` is taken back
    kThings,       ///< what has come, gone and moved
    kBays,         ///< what stands in the bays
    kEditSite,     ///< a bay or zone is drawn, changed or taken away: `edit`
    kRollBack,     ///< the map is M_`revision` again
    kRecordStart,  ///< a recording that was stopped goes on
    kRecordStop,   ///< the recording stops; the daemon goes on
    kMark,         ///< a person wants this moment kept as an incident, with `words`
    kIncidents,    ///< which are kept
    kLogLevel,     ///< the log shows `log_level` and above
    kDriveOff,
    kDriveWander
  } kind = Kind::kStatus;
  Pose2 map_from_robot{};                ///< kRelocalize
  std::uint32_t thing = 0;               ///< kUndoThing
  std::uint32_t revision = 0;            ///< kUndo, kRollBack
  LogLevel log_level = LogLevel::kInfo;  ///< kLogLevel
  std::string words{};                   ///< kMark: one line, at most kLongestWords bytes
  SiteEdit edit{};                       ///< kEditSite
  friend bool operator==(const Request&, const Request&) = default;
};

/// A request, or one line that says what is wrong with it.
struct RequestAnswer {
  std::optional<Request> request;
  std::string refused;
};
[[nodiscard]] RequestAnswer request_of_line(std::string_view line);

/// Whether a line asks for `drive off`.
[[nodiscard]] bool is_stop(std::string_view line);

// Lines without their line end.
[[nodiscard]] std::string line_of(const Request& request);
/// {"ok":true,"message":…}, and "doubt":true where a person should look at it again.
[[nodiscard]] std::string done_line(std::string_view message, bool doubt = false);
/// {"ok":false,"error":…}
[[nodiscard]] std::string error_line(std::string_view error);

/// The request as a person would type it: "relocalize 1.00,2.00,90".
[[nodiscard]] std::string words_of(const Request& request);

}  // namespace deltamap::daemon::control
