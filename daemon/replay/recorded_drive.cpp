// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/recorded_drive.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "daemon/replay/replay.hpp"
#include "daemon/steps/mount_watch.hpp"
#include "daemon/telemetry/stage.hpp"

namespace deltamap::daemon {
namespace {

class KeptMessages : public MessageSource {
 public:
  explicit KeptMessages(const RecordedDrive& drive) : drive_{drive} {}

  [[nodiscard]] std::optional<RecordedMessage> next() override {
    if (next_ == drive_.messages.size()) return std::nullopt;
    return drive_.messages[next_++];
  }
  [[nodiscard]] double done() const override {
    return static_cast<double>(next_) / static_cast<double>(drive_.messages.size());
  }
  [[nodiscard]] drivers::port::LogFaults faults() const override { return drive_.recorded.faults; }
  [[nodiscard]] std::map<std::string, std::uint64_t> wire() const override { return drive_.wire; }
  [[nodiscard]] OutsideWindow outside_window() override { return drive_.outside_window; }
  [[nodiscard]] double cpu_s() const override { return 0.0; }

 private:
  const RecordedDrive& drive_;
  std::size_t next_ = 0;
};

/// The watch depends on the messages alone, and costs a quarter of a replay.
void watch_mount(RecordedDrive& drive, const Settings& settings) {
  MountWatch watch{settings.localizer.odometry, settings.laser.session.is_upside_down};
  std::optional<Timestamp> first;
  for (const RecordedMessage& recorded : drive.messages) {
    if (const auto* odometry = std::get_if<Odometry>(&recorded.message)) {
      watch.observe(*odometry);
      continue;
    }
    const Scan& scan = std::get<Scan>(recorded.message);
    if (!first) first = scan.time;
    const LogLine line = watch.observe(scan);
    if (line.text.empty()) continue;
    drive.known_mount.told_at = scan.number;
    drive.mount_line = "after " + std::to_string(std::lround(seconds(scan.time - *first))) + " s: " + line.text;
    return;
  }
}

}  // namespace

RecordedDrive recorded_drive(const ReplayJob& job) {
  RecordedDrive drive;
  drive.recorded = recorded_run(job);
  FileMessages file{job.recording, {job.from_s, job.to_s}, job.settings};
  while (auto next = file.next()) {
    drive.scans += std::holds_alternative<Scan>(next->message) ? 1 : 0;
    drive.messages.push_back(*std::move(next));
  }
  if (drive.scans == 0) throw std::runtime_error(why_no_scan(file.faults(), job.recording));
  drive.recorded.faults = file.faults();
  drive.wire = file.wire();
  drive.outside_window = file.outside_window();
  watch_mount(drive, job.settings);
  return drive;
}

std::string decoding_settings(const Settings& settings) {
  Settings copy = settings;
  std::string text;
  for (const SettingKey& key : keys_of(copy)) {
    const bool decides = key.name.starts_with("robot.") || key.name.starts_with("laser.") ||
                         key.name.starts_with("navigation.safety.") || key.name.starts_with("localization.odometry");
    if (decides) text += key.name + ": " + key.text() + "\n";
  }
  return text;
}

RunReport replay_again(const ReplayJob& job, const RecordedDrive& drive, const FirstMap& map, ReplayOutput& output,
                       const ReplayProgress& progress) {
  const double began_cpu_s = thread_cpu_s();
  const ReplayStart begun = replay_start(drive.recorded, job, map);
  require_pose_on(begun.start.map->geometry(), job.settings);
  KeptMessages source{drive};
  // A journal that is obeyed leaves out scans and reports, so that the watch sees others.
  const auto known_mount = begun.journal == "obeyed" ? std::nullopt : std::optional{drive.known_mount};
  Replay replay{{job, drive.recorded, begun, source, output}, {.known_mount = known_mount, .tells_times = false}};
  replay.run(progress);
  RunReport report = replay.finish();
  report.cpu_total_s = thread_cpu_s() - began_cpu_s;
  return report;
}

}  // namespace deltamap::daemon
