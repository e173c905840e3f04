// SPDX-License-Identifier: Apache-2.0
#include "tool/score/run_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <variant>

#include "core/files/text_of_file.hpp"
#include "core/statistics/summary.hpp"
#include "tool/told_grid.hpp"
#include "tool/tune/measured_run.hpp"
#include "tool/view/run_folder.hpp"

namespace deltamap::tool::tune {
namespace {

namespace fs = std::filesystem;
using FolderJson = nlohmann::ordered_json;

struct Told {
  daemon::Settings settings;
  fs::path recording;
};

/// What report.json tells of the run: its settings, and what it replayed.
Told told_by(const fs::path& report_file) {
  FolderJson report;
  try {
    report = FolderJson::parse(text_of_file(report_file));
  } catch (const std::exception&) {
    throw std::runtime_error(report_file.string() + ": cannot be read: is this the folder of a run?");
  }
  std::vector<std::string> overrides;
  const FolderJson changed = report.value("settings", FolderJson::object()).value("changed", FolderJson::object());
  daemon::Settings as_delivered;
  const std::vector<daemon::SettingKey> keys = daemon::keys_of(as_delivered);
  for (const auto& [key, value] : changed.items()) {  // what this version does not know is left out
    const auto is_it = [&name = key](const daemon::SettingKey& known) { return known.name == name; };
    if (std::any_of(keys.begin(), keys.end(), is_it)) overrides.push_back(key + "=" + value.dump());
  }
  const FolderJson recording = report.value("recording", FolderJson::object());
  const std::string file = recording.is_object() ? recording.value("file", std::string{}) : std::string{};
  return {daemon::parse_settings("", report_file.string(), overrides), file};
}

/// Time that passes until the next row counts for what a row says.
void add_shares(Numbers& numbers, const std::vector<daemon::LocalizationRow>& rows) {
  std::map<PoseVerdict, double> verdict_s;
  double untracked_s = 0.0;
  double all_s = 0.0;
  std::vector<double> n_eff;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    n_eff.push_back(rows[i].n_eff);
    if (i + 1 == rows.size()) break;
    const double passed_s = std::max(0.0, seconds(rows[i + 1].time - rows[i].time));
    verdict_s[rows[i].belief.verdict] += passed_s;
    untracked_s += rows[i].state == LocalizerState::kTracking ? 0.0 : passed_s;
    all_s += passed_s;
  }
  if (all_s == 0.0) all_s = std::numeric_limits<double>::quiet_NaN();
  numbers.emplace_back("n_eff", mean_of(n_eff));
  numbers.emplace_back("right_share", verdict_s[PoseVerdict::kRight] / all_s);
  numbers.emplace_back("undecided_share", verdict_s[PoseVerdict::kUndecided] / all_s);
  numbers.emplace_back("wrong_share", verdict_s[PoseVerdict::kWrong] / all_s);
  numbers.emplace_back("untracked_share", untracked_s / all_s);
}

/// Where the beams of the recording ended, by the poses of the rows, which tell the numbers of their scans. A hundred
/// scans of the drive and more.
std::vector<Point2> ends_of(const daemon::RecordedDrive& drive, const std::vector<daemon::LocalizationRow>& rows) {
  constexpr std::size_t kLookedAtRows = 400;
  const std::size_t every = std::max<std::size_t>(1, rows.size() / kLookedAtRows);
  std::map<Timestamp, const daemon::LocalizationRow*> looked_at;
  for (std::size_t i = 0; i < rows.size(); i += every) looked_at[rows[i].time] = &rows[i];
  std::vector<Point2> ends;
  for (const daemon::RecordedMessage& message : drive.messages) {
    const auto* scan = std::get_if<Scan>(&message.message);
    const auto found = scan == nullptr ? looked_at.end() : looked_at.find(scan->time);
    if (found == looked_at.end()) continue;
    const Pose2 map_from_laser = found->second->map_from_robot * scan->robot_from_laser;
    for (std::size_t beam = 0; beam < scan->beams.size(); ++beam) {
      if (scan->beams[beam].kind != BeamKind::kRange) continue;
      const double bearing = scan->bearing_rad(beam);
      const double range_m = static_cast<double>(scan->beams[beam].range_m);
      ends.push_back(map_from_laser * (range_m * Point2{std::cos(bearing), std::sin(bearing)}));
    }
  }
  return ends;
}

}  // namespace

ScoredFolder scored_folder(const fs::path& folder, const fs::path& map, const TrueWay& way) {
  const Told told = told_by(folder / "report.json");
  const RunFolder read = read_run_folder(folder);
  ScoredFolder scored{{}, read.notes};
  TunedDrive drive{{.name = folder.string(),
                    .recording = told.recording,
                    .map = map.empty() ? folder / "map.yaml" : map,
                    .way = way}};
  scored.numbers = drive.errors_of(simulation::score::read_trajectory(folder / "trajectory.tum"), told.settings);
  if (way.kind == TrueWay::Kind::kNone)
    scored.notes.emplace_back("no true way is given: errors are not known (--reference, --relations, --truth)");
  if (told.recording.empty() || !fs::exists(told.recording)) {
    scored.notes.push_back(
        (told.recording.empty() ? "the run's recording is not told" : told.recording.string() + " is not there") +
        std::string{": whether scans agree with the map is not measured"});
  } else {
    const auto ends = ends_of(*drive.decoded(told.settings), read.rows);
    scored.numbers.emplace_back("agreement", agreement(*drive.map().grid, ends));
  }
  add_shares(scored.numbers, read.rows);
  std::size_t revisions = 0;
  for (const daemon::ChangeNote& change : read.changes) revisions += change.revision ? 1 : 0;
  scored.numbers.emplace_back("revisions", static_cast<double>(revisions));
  scored.numbers.emplace_back("refused", static_cast<double>(read.changes.size() - revisions));
  return scored;
}

double repeatability_m(const std::vector<std::vector<TunedDrive::StampedPose>>& of_seeds) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (of_seeds.size() < 2) return kUnknown;
  const std::size_t scans = of_seeds.front().size();
  for (const auto& poses : of_seeds) {
    if (poses.size() != scans || scans == 0) return kUnknown;
  }
  std::vector<double> away_m;
  for (std::size_t scan = 0; scan < scans; ++scan) {
    Point2 middle{0.0, 0.0};
    for (const auto& poses : of_seeds)
      middle += poses[scan].map_from_robot.position() / static_cast<double>(of_seeds.size());
    for (const auto& poses : of_seeds) away_m.push_back((poses[scan].map_from_robot.position() - middle).norm());
  }
  return root_mean_square(away_m);
}

}  // namespace deltamap::tool::tune
