// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/recorded_drive.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "daemon/replay/replay.hpp"
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

 private:
  const RecordedDrive& drive_;
  std::size_t next_ = 0;
};

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
  ReplayStart begun = replay_start(drive.recorded, job, map);
  require_pose_on(begun.start.map->geometry(), job.settings);
  if (begun.journal == "obeyed") begun.journal = "not obeyed: settings and seeds are held against each other";
  KeptMessages source{drive};
  Replay replay{{job, drive.recorded, begun, source, output}, {.tells_times = false}};
  replay.run(progress);
  RunReport report = replay.finish();
  report.cpu_total_s = thread_cpu_s() - began_cpu_s;
  return report;
}

}  // namespace deltamap::daemon
