// SPDX-License-Identifier: Apache-2.0
// `deltamap export tum|csv|carmen|mcap`: runs and recordings for other programs.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tool/draft.hpp"
#include "tool/export/mcap_export.hpp"
#include "tool/export/posed_scans.hpp"
#include "tool/export/text_exports.hpp"
#include "tool/output_file.hpp"
#include "tool/subcommands.hpp"
#include "tool/view/run_folder.hpp"

namespace deltamap::tool {
namespace {

struct ExportOptions {
  std::string source;
  std::string output;
  std::string recording;  // beside a run
  std::string config;
  std::vector<std::string> overrides;
  bool as_json = false;

  [[nodiscard]] bool is_run() const { return std::filesystem::is_directory(source); }
  [[nodiscard]] daemon::Settings settings() const { return daemon::settings_or_defaults(config, overrides); }
};

/// What was written.
struct Exported {
  std::uint64_t count = 0;
  std::string what;
  std::vector<std::string> warnings;
};

Exported recorded(const std::string& what, std::uint64_t count, const drivers::port::LogFaults& faults) {
  return {count, what, faults.lines()};
}

Exported export_tum(const ExportOptions& options, std::ostream& out) {
  std::vector<daemon::TrajectoryPoint> points;
  if (options.is_run()) {
    const RunFolder run = read_run_folder(options.source);
    for (const daemon::LocalizationRow& row : run.rows) points.push_back({row.time, row.map_from_robot});
    write_tum(points, out);
    return {points.size(), "poses in the map", run.notes};
  }
  const drivers::port::LogFaults faults = read_posed_scans(options.source, options.settings(),
                                                           {[&](const Odometry& odometry, const Pose2& pose) {
                                                              points.push_back({odometry.time, pose});
                                                            },
                                                            [](const Scan&, const Pose2&) {}});
  write_tum(points, out);
  return recorded("poses by the wheels", points.size(), faults);
}

Exported export_csv(const ExportOptions& options, std::ostream& out) {
  if (options.is_run()) {
    const RunFolder run = read_run_folder(options.source);
    write_run_csv(run.rows, out);
    return {run.rows.size(), "localized scans", run.notes};
  }
  out << scan_csv_header();
  std::uint64_t scans = 0;
  const drivers::port::LogFaults faults = read_posed_scans(options.source, options.settings(),
                                                           {[](const Odometry&, const Pose2&) {},
                                                            [&](const Scan& scan, const Pose2& odom_from_robot) {
                                                              ++scans;
                                                              out << scan_csv_line(scan, odom_from_robot);
                                                            }});
  return recorded("scans", scans, faults);
}

Exported export_carmen(const ExportOptions& options, std::ostream& out) {
  if (options.is_run()) {
    throw std::runtime_error(options.source + ": is a run's folder, which holds no scans: give its recording");
  }
  std::optional<Timestamp> began;
  std::uint64_t scans = 0;
  const auto begin = [&](Timestamp time) {
    if (!began) began = time;
  };
  const drivers::port::LogFaults faults =
      read_posed_scans(options.source, options.settings(),
                       {[&](const Odometry& odometry, const Pose2& odom_from_robot) {
                          begin(odometry.time);
                          out << carmen_odometry_line(odometry, odom_from_robot, *began);
                        },
                        [&](const Scan& scan, const Pose2& odom_from_robot) {
                          begin(scan.time);
                          ++scans;
                          out << carmen_scan_line(scan, odom_from_robot, *began);
                        }});
  return recorded("scans", scans, faults);
}

void tell(const Exported& done, const ExportOptions& options) {
  for (const std::string& line : done.warnings) std::cerr << "deltamap: warning: " << line << '\n';
  if (options.as_json) {
    const nlohmann::ordered_json json{
        {"file", options.output}, {"count", done.count}, {"what", done.what}, {"warnings", done.warnings}};
    std::cout << json.dump(2) << '\n';
    return;
  }
  std::cout << options.output << ": " << done.count << ' ' << done.what << '\n';
}

/// Neither the file nor its draft is what is read.
void require_beside_what_is_read(const ExportOptions& options) {
  for (const std::string& read : {options.source, options.recording}) {
    require_output_beside(options.output, read);
    require_output_beside(Draft::path_of(options.output), read);
  }
}

/// Writes the file whole or not at all.
void export_text(const ExportOptions& options, Exported (*write)(const ExportOptions&, std::ostream&)) {
  require_beside_what_is_read(options);
  Draft draft{options.output};
  std::ofstream out{draft.path()};
  const Exported done = write(options, out);
  out.close();
  if (!out) throw std::runtime_error(options.output + ": cannot be written");
  draft.keep();
  tell(done, options);
}

void export_as_mcap(const ExportOptions& options) {
  require_beside_what_is_read(options);
  if (!options.recording.empty() && !options.is_run()) {
    throw CLI::ValidationError("--recording", options.source + " is no run's folder; --recording stands beside one");
  }
  McapSource source;
  source.settings = options.settings();
  if (options.is_run()) source.run = options.source;
  if (!options.is_run()) source.recording = options.source;
  if (!options.recording.empty()) source.recording = options.recording;
  Draft draft{options.output};
  const McapResult result = export_mcap(source, draft.path());
  draft.keep();
  tell({result.messages, "messages", result.warnings}, options);
}

CLI::App* add_format(CLI::App& group, const std::string& name, const std::string& about,
                     const std::shared_ptr<ExportOptions>& options) {
  CLI::App* command = group.add_subcommand(name, about);
  command->add_option("SOURCE", options->source, "a recording, or a run's folder (--out)")->required();
  command->add_option("OUT", options->output, "file to write")->required();
  command->add_option("--config", options->config, "settings for a recording: mount, ranges; as delivered without it");
  command->add_option("--set", options->overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
  command->add_flag("--json", options->as_json, "print the result as JSON");
  return command;
}

}  // namespace

void add_export(CLI::App& app) {
  CLI::App& group = *app.add_subcommand("export", "runs and recordings for other programs")->require_subcommand(1);
  const auto add_text = [&](const char* name, const char* about,
                            Exported (*write)(const ExportOptions&, std::ostream&)) {
    auto options = std::make_shared<ExportOptions>();
    add_format(group, name, about, options)->callback([options, write] { export_text(*options, write); });
  };
  add_text("tum", "the trajectory: in the map of a run, by the wheels of a recording", export_tum);
  add_text("csv", "a line a scan: of a run its pose, of a recording its ranges", export_csv);
  add_text("carmen", "a recording as CARMEN log (ROBOTLASER1, ODOM)", export_carmen);
  auto options = std::make_shared<ExportOptions>();
  CLI::App* mcap = add_format(group, "mcap", "scans, poses, maps and log lines as MCAP, for Foxglove", options);
  mcap->add_option("--recording", options->recording,
                   "the recording of the run: its scans, where the run has placed them");
  mcap->callback([options] { export_as_mcap(*options); });
}

}  // namespace deltamap::tool
