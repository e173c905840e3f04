// SPDX-License-Identifier: Apache-2.0
// An incident: the minutes around something that went wrong, or that a person has marked, as a folder that holds a
// recording that replays, the map that it begins on, the settings, the log and a page in words. Here what its
// incident.json says.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"

namespace deltamap::daemon {

enum class IncidentKind : std::uint8_t { kMark, kLost, kKidnapped, kRefusals, kSafetyStop, kDeviceFault, kDaemonEnded };
inline constexpr std::size_t kIncidentKinds = 7;
/// "mark", "lost", "kidnapped", "refusals", "safety-stop", "device-fault", "daemon-ended"
[[nodiscard]] std::string_view name_of(IncidentKind kind);
[[nodiscard]] std::optional<IncidentKind> incident_kind_of(std::string_view name);

struct IncidentEvent {
  IncidentKind kind = IncidentKind::kMark;
  Timestamp time;
  std::string words;  ///< one line: what happened
};

struct Incident {
  std::string name;                   ///< of its folder: "20261130T030012Z-lost"
  std::vector<IncidentEvent> events;  ///< the first is why it was kept; the others came while it was
  Timestamp from;                     ///< its recording begins
  std::optional<Timestamp> to;        ///< its recording ends; nothing: the daemon has ended before
  bool begins_in_mid_run = true;
  /// Of the newest scan before; nothing: no scan had been localized.
  std::optional<Pose2> map_from_robot{};
  bool is_sure = false;  ///< that pose was tracked, and nothing spoke against it
  double deviation_m = 0.0;
  std::uint32_t revision = 0;        ///< of the map, by then
  std::uint32_t first_revision = 0;  ///< of the map that the recording begins on: map.yaml
  std::string first_map;             ///< map.file of the settings
  std::string version;
  std::string lacks{};  ///< what of its recording is missing, and why: one line; empty: nothing that is known

  [[nodiscard]] bool is_complete() const { return to && lacks.empty(); }
};

// What its folder holds.
inline constexpr const char* kIncidentRecording = "recording.pcapng";
inline constexpr const char* kIncidentMap = "map.yaml";
inline constexpr const char* kIncidentSettings = "settings.yaml";
inline constexpr const char* kIncidentLog = "log.txt";
inline constexpr const char* kIncidentWords = "words.txt";
inline constexpr const char* kIncidentFacts = "incident.json";
inline constexpr const char* kIncidentPicture = "picture.png";  ///< where a scan had been localized
inline constexpr const char* kIncidentPin = "pinned";

[[nodiscard]] std::string json_text(const Incident& incident);
/// Throws std::runtime_error with what is wrong where that is no such text.
[[nodiscard]] Incident incident_of(const std::string& json_text);
/// Throws std::runtime_error "FILE: …" where the folder holds no incident.
[[nodiscard]] Incident read_incident(const std::filesystem::path& folder);
/// The page for people: what happened, when, where, on which revision, what is kept and what to do.
[[nodiscard]] std::string words_of(const Incident& incident, bool has_picture);

}  // namespace deltamap::daemon
