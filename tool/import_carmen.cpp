// SPDX-License-Identifier: Apache-2.0
#include "tool/import_carmen.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/counted.hpp"
#include "drivers/carmen/carmen_bytes.hpp"
#include "drivers/port/byte_log.hpp"
#include "tool/draft.hpp"
#include "tool/progress.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

/// The robot's pose at any time, from the ODOM lines of a log; held where the lines end, the origin where there are
/// none.
class OdometryTrack {
 public:
  explicit OdometryTrack(const std::vector<drivers::carmen::TimedPose>& poses) : poses_{poses} {}

  /// The lines up to a time that were not answered before.
  [[nodiscard]] std::span<const drivers::carmen::TimedPose> until(Timestamp time) {
    const std::size_t from = next_;
    while (next_ < poses_.size() && poses_[next_].time <= time) ++next_;
    return std::span(poses_).subspan(from, next_ - from);
  }
  [[nodiscard]] Pose2 at(Timestamp time) const {
    const auto after =
        std::upper_bound(poses_.begin(), poses_.end(), time,
                         [](Timestamp t, const drivers::carmen::TimedPose& pose) { return t < pose.time; });
    if (poses_.empty()) return {};
    if (after == poses_.begin()) return after->odom_from_robot;
    const auto before = std::prev(after);
    if (after == poses_.end()) return before->odom_from_robot;
    return interpolated(before->odom_from_robot, after->odom_from_robot,
                        seconds(time - before->time) / seconds(after->time - before->time));
  }

 private:
  const std::vector<drivers::carmen::TimedPose>& poses_;
  std::size_t next_ = 0;
};

void send_log(drivers::carmen::CarmenLog& lines, const drivers::carmen::CarmenSurvey& survey,
              drivers::carmen::CarmenBytes& bytes, Progress& progress) {
  OdometryTrack track{survey.odometry};
  while (const auto record = lines.next()) {
    progress.show(lines.read_bytes());
    const auto* scan = std::get_if<drivers::carmen::CarmenScan>(&*record);
    if (scan == nullptr || scan->is_repeated || (survey.scans_carry_poses && !scan->poses)) continue;
    for (const drivers::carmen::TimedPose& pose : track.until(scan->time)) {
      if (pose.time != scan->time) bytes.add_pose(pose.time, pose.odom_from_robot);
    }
    bytes.add_pose(scan->time, scan->poses ? drivers::carmen::without_resets(survey.resets, scan->line,
                                                                             scan->poses->odom_from_robot)
                                           : track.at(scan->time));
    bytes.add_scan(*scan);
  }
  for (const drivers::carmen::TimedPose& pose : track.until(Timestamp::max()))
    bytes.add_pose(pose.time, pose.odom_from_robot);
  bytes.finish();
}

std::string_view pose_source(const drivers::carmen::CarmenSurvey& survey) {
  if (survey.scans_carry_poses) return "scan lines";
  return survey.odometry.empty() ? "none" : "ODOM lines";
}

void print_import_text(const CarmenImport& done, const std::string& recording) {
  const drivers::carmen::CarmenSurvey& survey = done.survey;
  const bool centimetres = survey.units == drivers::lms200::Units::kCentimetre;
  std::cout << recording << ": " << counted(survey.scans, "scan") << " as " << name_of(survey.variant) << " in "
            << (centimetres ? "cm" : "mm") << ", " << counted(done.poses, "odometry packet") << ", poses from "
            << pose_source(survey) << '\n';
  if (const std::string line = drivers::carmen::no_return_line(survey); !line.empty()) std::cout << line << '\n';
  if (survey.clock.by_logger) std::cout << "times: the logger's, since the time stamps do not tell the scans apart\n";
  if (survey.doubled_scans > 0) std::cout << drivers::carmen::doubled_line(survey) << '\n';
  if (pose_source(survey) == "none") std::cout << "the log has no pose: the robot is taken to stand still\n";
  for (const auto* notes : {&survey.notes, &survey.drive_notes}) {
    for (const std::string& note : *notes) std::cout << note << '\n';
  }
  if (done.gaps > 0)
    std::cout << counted(done.gaps, "pause of more than an hour is", "pauses of more than an hour are")
              << " left without odometry\n";
}

void print_import_json(const CarmenImport& done, const std::string& recording) {
  const drivers::carmen::CarmenSurvey& survey = done.survey;
  nlohmann::ordered_json json{{"recording", recording},
                              {"scans", survey.scans},
                              {"variant", name_of(survey.variant)},
                              {"units", survey.units == drivers::lms200::Units::kCentimetre ? "cm" : "mm"},
                              {"measuring_mode", survey.measuring_mode},
                              {"odometry_packets", done.poses},
                              {"poses_from", pose_source(survey)},
                              {"no_return_m", nullptr},
                              {"no_return_share", survey.no_return_share},
                              {"times_from", survey.clock.by_logger ? "logger" : "time stamps"},
                              {"cut", nullptr},
                              {"scans_left_out", survey.doubled_scans},
                              {"gaps", done.gaps},
                              {"laser_mount", nullptr},
                              {"odometry_resets", survey.resets.size()},
                              {"notes", survey.notes}};
  for (const std::string& note : survey.drive_notes) json["notes"].push_back(note);
  if (const auto& mount = survey.robot_from_laser)
    json["laser_mount"] = {{"x_m", mount->x}, {"y_m", mount->y}, {"yaw_deg", degrees(mount->theta)}};
  if (survey.no_return_m) json["no_return_m"] = *survey.no_return_m;
  if (survey.cut) json["cut"] = *survey.cut;
  std::cout << json.dump(2) << '\n';
}

}  // namespace

drivers::carmen::CarmenSurvey shown_survey_of(const fs::path& log, std::optional<double> no_return_m) {
  std::optional<Progress> progress;
  return drivers::carmen::survey_of(log, no_return_m, [&](std::uint64_t read, std::uint64_t total) {
    if (!progress) progress.emplace("looking through " + log.filename().string(), total);
    progress->show(read);
  });
}

CarmenImport import_carmen(const fs::path& log, const fs::path& recording, std::optional<double> no_return_m) {
  std::error_code ignored;
  if (fs::equivalent(log, recording, ignored)) throw std::runtime_error(recording.string() + ": is the log itself");
  CarmenImport done;
  done.survey = shown_survey_of(log, no_return_m);
  if (!done.survey.no_clock.empty()) {
    throw std::runtime_error(log.string() + ": cannot be imported without times: " + done.survey.no_clock +
                             ", and the logger's times do not help (`map from-poses` needs none)");
  }
  drivers::carmen::CarmenLog lines{log, done.survey.clock, done.survey.headings};
  Draft draft{recording};
  drivers::port::ByteLogWriter writer{draft.path(), {drivers::carmen::kImportBaud, drivers::carmen::kImportBaud}};
  drivers::carmen::CarmenBytes bytes{done.survey,
                                     [&](const drivers::port::ByteRecord& record) { writer.write(record); }};
  {
    Progress progress{"importing " + log.filename().string(), lines.size_bytes()};
    send_log(lines, done.survey, bytes, progress);
  }
  writer.close();
  draft.keep();
  done.poses = bytes.poses();
  done.gaps = bytes.gaps();
  return done;
}

void tell_import(const CarmenImport& done, const std::string& recording, bool as_json) {
  as_json ? print_import_json(done, recording) : print_import_text(done, recording);
}

void add_import_carmen(CLI::App& import) {
  struct Options {
    std::string log;
    std::string recording;
    std::optional<double> no_return_m;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App& command = *import.add_subcommand("carmen", "a CARMEN log as the bytes of a P3-DX and an LMS200");
  command.add_option("LOG", options->log, "CARMEN log (FLASER, ROBOTLASER1, RAWLASER1, ODOM)")->required();
  command.add_option("OUT", options->recording, "recording to write (.pcapng)")->required();
  command.add_option("--no-return", options->no_return_m, drivers::carmen::kNoReturnHelp)
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--json", options->json, "print the result as JSON");
  command.callback([options] {
    const CarmenImport done = import_carmen(options->log, options->recording, options->no_return_m);
    if (done.survey.cut) std::cerr << "deltamap: warning: " << *done.survey.cut << '\n';
    tell_import(done, options->recording, options->json);
  });
}

}  // namespace deltamap::tool
