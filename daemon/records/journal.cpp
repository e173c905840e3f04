// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/journal.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "daemon/settings/fingerprint.hpp"

namespace deltamap::daemon {
namespace {

using Kind = Decision::Kind;

template <typename... Fields>
bool matches(const std::string& note, const char* format, Fields*... fields) {
  int read = -1;
  const int found = std::sscanf(note.c_str(), format, fields..., &read);
  return found == static_cast<int>(sizeof...(fields)) && read == static_cast<int>(note.size());
}

/// The note of a relocalization, with as many digits as keep every bit of the pose.
std::string words_of_relocalization(const Pose2& pose) {
  char text[96];
  (void)std::snprintf(text, sizeof text, "relocalized to %.17g %.17g %.17g", pose.x, pose.y, pose.theta);
  return text;
}

/// "… before scan 12 at 1700000000000000000": Unix time of the scan's first beam, ns.
std::string note_of_command(const std::string& words, const Decision& command) {
  const std::string note = words + " before scan " + std::to_string(command.scan);
  return command.scan_time ? note + " at " + std::to_string(unix_ns(*command.scan_time)) : note;
}

std::optional<Decision> command_of_note(const std::string& note) {
  const std::size_t at = note.rfind(" at ");
  std::int64_t time_ns = 0;
  const bool has_time = at != std::string::npos && matches(note.substr(at), " at %" SCNd64 "%n", &time_ns);
  const std::string text = has_time ? note.substr(0, at) : note;
  Decision command;
  Pose2& pose = command.map_from_robot;
  if (matches(text, "mapping paused before scan %" SCNu32 "%n", &command.scan)) {
    command.kind = Kind::kPaused;
  } else if (matches(text, "mapping resumed before scan %" SCNu32 "%n", &command.scan)) {
    command.kind = Kind::kResumed;
  } else if (matches(text, "relocalized to %lf %lf %lf before scan %" SCNu32 "%n", &pose.x, &pose.y, &pose.theta,
                     &command.scan)) {
    command.kind = Kind::kRelocalized;
  } else {
    return std::nullopt;
  }
  if (has_time) command.scan_time = timestamp_from_ns(time_ns);
  return command;
}

}  // namespace

std::string note_of(const RunIdentity& run) {
  const std::string note = "run settings " + hex_of(run.settings) + " map " + hex_of(run.map);
  return run.memory == 0 ? note : note + " memory " + hex_of(run.memory);
}

std::optional<RunIdentity> run_of_note(std::string_view note) {
  const std::string text{note};
  RunIdentity run;
  if (matches(text, "run settings %16" SCNx64 " map %16" SCNx64 "%n", &run.settings, &run.map)) return run;
  if (matches(text, "run settings %16" SCNx64 " map %16" SCNx64 " memory %16" SCNx64 "%n", &run.settings, &run.map,
              &run.memory))
    return run;
  return std::nullopt;
}

std::string note_of(const Decision& decision) {
  const std::string scan = std::to_string(decision.scan);
  const std::string number = std::to_string(decision.number);
  switch (decision.kind) {
    case Kind::kRevision:
      return "revision " + number + " before scan " + scan;
    case Kind::kTransients:
      return "temporary " + number + " before scan " + scan;
    case Kind::kScanDropped:
      return "scan " + scan + " dropped";
    case Kind::kScanLost:
      return "scan " + scan + " lost";
    case Kind::kOdometryLost:
      return "odometry " + number + " lost";
    case Kind::kTrackedLost:
      return "tracked scan " + scan + " lost";
    case Kind::kSetLost:
      return "set of phase " + number + " lost";
    case Kind::kPhaseClosed:
      return "phase " + number + " closed at scan " + scan;
    case Kind::kPaused:
      return note_of_command("mapping paused", decision);
    case Kind::kResumed:
      return note_of_command("mapping resumed", decision);
    case Kind::kRelocalized:
      return note_of_command(words_of_relocalization(decision.map_from_robot), decision);
    case Kind::kMapSet:
    case Kind::kSiteSet:
      break;
  }
  return {};
}

std::optional<Decision> decision_of_note(std::string_view note) {
  const std::string text{note};
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  if (matches(text, "revision %" SCNu32 " before scan %" SCNu32 "%n", &a, &b)) return Decision{Kind::kRevision, b, a};
  if (matches(text, "temporary %" SCNu32 " before scan %" SCNu32 "%n", &a, &b))
    return Decision{Kind::kTransients, b, a};
  if (matches(text, "scan %" SCNu32 " dropped%n", &a)) return Decision{Kind::kScanDropped, a, 0};
  if (matches(text, "scan %" SCNu32 " lost%n", &a)) return Decision{Kind::kScanLost, a, 0};
  if (matches(text, "odometry %" SCNu32 " lost%n", &a)) return Decision{Kind::kOdometryLost, 0, a};
  if (matches(text, "tracked scan %" SCNu32 " lost%n", &a)) return Decision{Kind::kTrackedLost, a, 0};
  if (matches(text, "set of phase %" SCNu32 " lost%n", &a)) return Decision{Kind::kSetLost, 0, a};
  if (matches(text, "phase %" SCNu32 " closed at scan %" SCNu32 "%n", &a, &b))
    return Decision{Kind::kPhaseClosed, b, a};
  return command_of_note(text);
}

void Journal::read(std::string_view note) {
  if (const auto run = run_of_note(note)) {
    *this = Journal{};
    run_ = run;
    return;
  }
  has_gap_ = has_gap_ || note == kGapNote;
  is_part_ = is_part_ || note == kPartNote;
  if (auto set = set_cells_.read(note)) {
    Decision command{.kind = Kind::kMapSet, .scan = set->order.scan};
    command.scan_time = set->order.scan_time;
    command.set = std::move(set);
    return add_command(std::move(command));
  }
  if (const auto set = set_site_.read(note)) {
    Decision command{.kind = Kind::kSiteSet, .scan = set->scan};
    command.scan_time = set->scan_time;
    command.site = set->site;
    if (!is_repeated(command)) add_command(std::move(command));
    return;
  }
  if (const auto decision = decision_of_note(note)) take(*decision);
}

void Journal::take(const Decision& decision) {
  switch (decision.kind) {
    case Kind::kRevision:
      revisions_[decision.scan] = decision.number;
      break;
    case Kind::kTransients:
      transients_[decision.scan] = decision.number;
      break;
    case Kind::kScanDropped:
      dropped_.insert(decision.scan);
      break;
    case Kind::kScanLost:
      lost_.insert(decision.scan);
      break;
    case Kind::kOdometryLost:
      lost_odometry_.insert(decision.number);
      break;
    case Kind::kTrackedLost:
      lost_tracked_.insert(decision.scan);
      break;
    case Kind::kSetLost:
      lost_sets_.insert(decision.number);
      break;
    case Kind::kPhaseClosed:
      closed_[decision.number] = decision.scan;
      break;
    case Kind::kPaused:
    case Kind::kResumed:
    case Kind::kRelocalized:
      if (!is_repeated(decision)) add_command(decision);
      break;
    case Kind::kMapSet:
    case Kind::kSiteSet:
      break;
  }
}

/// A recording repeats behind a gap which command is in force: that one is no new command.
bool Journal::is_repeated(const Decision& command) const {
  return std::any_of(commands_.begin(), commands_.end(), [&](const Decision& known) {
    Decision other = known;
    const bool is_one_site = command.site && known.site && *command.site == *known.site;
    if (is_one_site) other.site = command.site;
    return other == command;
  });
}

/// Inserts a command by its scan: the map thread notes a command later than the localization thread notes its own of
/// the same time.
void Journal::add_command(Decision command) {
  const auto place = std::upper_bound(commands_.begin(), commands_.end(), command.scan,
                                      [](std::uint32_t scan, const Decision& other) { return scan < other.scan; });
  commands_.insert(place, std::move(command));
}

std::strong_ordering Journal::place_of(const Decision& command, const Scan& scan) const {
  const bool scans_count_as_live = run_ && !has_gap_ && !is_part_;
  if (command.scan_time && !scans_count_as_live) return *command.scan_time <=> scan.time;
  return command.scan <=> scan.number;
}

std::optional<std::uint32_t> Journal::revision_before(std::uint32_t scan) const {
  const auto found = revisions_.find(scan);
  return found == revisions_.end() ? std::nullopt : std::optional{found->second};
}

std::optional<std::uint32_t> Journal::transients_before(std::uint32_t scan) const {
  const auto found = transients_.find(scan);
  return found == transients_.end() ? std::nullopt : std::optional{found->second};
}

std::optional<std::uint32_t> Journal::closing_scan(std::uint32_t phase) const {
  const auto found = closed_.find(phase);
  return found == closed_.end() ? std::nullopt : std::optional{found->second};
}

}  // namespace deltamap::daemon
