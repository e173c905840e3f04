// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/measured_run.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <utility>

#include "core/grid/near_occupied.hpp"
#include "daemon/settings/fingerprint.hpp"

namespace deltamap::tool::tune {
namespace {

constexpr std::size_t kLookedAtScans = 400;  // of a drive, evenly: they tell the share to a percent
constexpr std::size_t kLookedAtBeams = 60;   // of a scan
constexpr double kAgreesM = 0.1;

/// Takes what a replay brings, and measures it when it has ended.
class Measuring : public daemon::ReplayOutput {
 public:
  explicit Measuring(std::size_t scans) : every_{std::max<std::size_t>(1, scans / kLookedAtScans)} {}

  void localized(const daemon::LocalizationRow& row) override {
    add({row.time, row.map_from_robot});
    n_eff_ += row.n_eff;
    ++localized_;
  }
  void passed_over(const daemon::TrajectoryPoint& point) override { add(point); }
  void changed(const daemon::MapStep::Result& result, std::string_view /*method*/) override {
    ++(result.revision ? revisions_ : refused_);
  }
  void told(const mapping::bays::BayEvent& /*event*/) override {}
  void look(const TrackedScan& /*tracked*/) override {}
  void settled() override {}
  void finish(const OccupancyGrid& newest) override {
    agreement_ = agreement(newest, ends_);
    map_ = grid_hash(newest);
  }

  void look_at(const TrackedScan& tracked) {
    if (localized_ % every_ != 0) return;
    const std::size_t step = std::max<std::size_t>(1, tracked.rays.size() / kLookedAtBeams);
    for (std::size_t i = 0; i < tracked.rays.size(); i += step) {
      if (tracked.scan.beams[i].kind != BeamKind::kRange) continue;
      ends_.push_back(tracked.estimate.map_from_robot * tracked.rays[i].end.cast<double>().eval());
    }
  }

  [[nodiscard]] MeasuredRun run_of(const TunedDrive& drive, const daemon::RunReport& report,
                                   const daemon::Settings& settings) && {
    MeasuredRun run{drive.errors_of(poses_, settings), daemon::hex_of(trajectory_), daemon::hex_of(map_)};
    const double recorded_s = report.recorded_s > 0.0 ? report.recorded_s : std::numeric_limits<double>::quiet_NaN();
    const daemon::VerdictTimes& verdicts = report.verdict_times;
    const double scans = static_cast<double>(localized_);
    run.numbers.emplace_back("agreement", agreement_);
    run.numbers.emplace_back("n_eff", n_eff_ / scans);
    run.numbers.emplace_back("right_share", verdicts.right_s / recorded_s);
    run.numbers.emplace_back("undecided_share", verdicts.undecided_s / recorded_s);
    run.numbers.emplace_back("wrong_share", verdicts.wrong_s / recorded_s);
    run.numbers.emplace_back("untracked_share", (report.time_lost_s + report.time_global_s) / recorded_s);
    run.numbers.emplace_back("revisions", static_cast<double>(revisions_));
    run.numbers.emplace_back("refused", static_cast<double>(refused_));
    run.numbers.emplace_back("cpu_ms", 1e3 * report.cpu_total_s / scans);
    run.poses = std::move(poses_);
    return run;
  }

 private:
  void add(const daemon::TrajectoryPoint& point) {
    poses_.push_back({point.time, point.map_from_robot});
    trajectory_ = daemon::fingerprint_of(daemon::tum_line(point), trajectory_);
  }

  std::size_t every_;
  std::vector<TunedDrive::StampedPose> poses_;
  std::uint64_t trajectory_ = daemon::fingerprint_of("");
  std::vector<Point2> ends_;
  std::size_t localized_ = 0;
  std::size_t revisions_ = 0;
  std::size_t refused_ = 0;
  double n_eff_ = 0.0;
  double agreement_ = 0.0;
  std::uint64_t map_ = 0;
};

}  // namespace

double agreement(const OccupancyGrid& map, const std::vector<Point2>& ends_in_map) {
  const GridGeometry& geometry = map.geometry();
  const int reach = static_cast<int>(std::ceil(kAgreesM / geometry.resolution_m - 1e-6));
  const auto agrees = [&](const Point2& end) { return has_occupied_within(map, geometry.cell_at(end), reach); };
  const auto count = std::count_if(ends_in_map.begin(), ends_in_map.end(), agrees);
  if (ends_in_map.empty()) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(count) / static_cast<double>(ends_in_map.size());
}

MeasuredRun measured_run(TunedDrive& drive, const daemon::Settings& settings, const daemon::ReplayProgress& progress) {
  const auto decoded = drive.decoded(settings);
  Measuring measuring{decoded->scans};
  daemon::ReplayJob job;
  job.recording = drive.files().recording;
  job.settings = settings;
  job.from_s = drive.files().from_s;
  job.to_s = drive.files().to_s;
  job.watch.scan = [&](const daemon::ReplayedScan& replayed) { measuring.look_at(replayed.tracked); };
  if (drive.is_first_run()) {
    job.warn = [&drive](const std::string& line) {
      std::cerr << "deltamap: warning: " + drive.files().name + ": " + line + '\n';
    };
  }
  const daemon::RunReport report = daemon::replay_again(job, *decoded, drive.map(), measuring, progress);
  return std::move(measuring).run_of(drive, report, settings);
}

}  // namespace deltamap::tool::tune
