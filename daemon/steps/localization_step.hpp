// SPDX-License-Identifier: Apache-2.0
// What the localization thread does with each message, and what a replay does in its place: odometry, revisions, scans
// and an operator's pose to the localizer; a trajectory point and a line of localization.csv for every scan.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/pose_spread.hpp"
#include "core/messages.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/site/site.hpp"
#include "daemon/steps/fit_watch.hpp"
#include "daemon/steps/ignored_ground.hpp"
#include "daemon/steps/mount_watch.hpp"
#include "daemon/steps/wheel_watch.hpp"
#include "localization/localizer.hpp"
#include "mapping/paper/divergence_ratio.hpp"

namespace deltamap::daemon {

/// A revision that may have been written by a wrong pose.
struct ProvisionalRevision {
  std::uint32_t number = 0;
  std::vector<CellChange> changes;
};

/// What a run starts on: M_0, or the newest revision of the store, and what an earlier run has left.
struct StartMap {
  std::shared_ptr<const OccupancyGrid> map;
  std::uint32_t revision = 0;
  /// map_from_robot at the end of the run before; the settings' pose takes precedence.
  std::optional<Pose2> remembered{};
  /// Of `remembered`, where the run goes on in the midst of another: that was believed with these deviations.
  std::optional<PoseDeviation> believed{};
  std::optional<localization::belief::StabilityRecord> stability{};     ///< what earlier runs have learned of this map
  std::optional<localization::motion::DriveCalibration> calibration{};  ///< and of wheels and mount
  std::vector<ProvisionalRevision> provisional{};                       ///< of `map`, oldest first
  SharedSite site{};                                                    ///< what people have drawn on it; null: nothing
};

/// Throws SettingsError where `localization.initial_pose` lies outside the map: one line that names the map's extent.
void require_pose_on(const GridGeometry& map, const Settings& settings);
/// One line where `localization.initial_pose` lies on a cell of the map on which no robot was seen to fit; else "".
[[nodiscard]] std::string doubt_of_pose(const OccupancyGrid& map, const Settings& settings);
/// One line where the first estimate lies farther from `localization.initial_pose` than a pose that a person gives is
/// taken to be off; else "".
[[nodiscard]] std::string shift_from_given_pose(const Pose2& first_estimate, const Settings& settings);

class LocalizationStep {
 public:
  /// Throws std::runtime_error where the map has no free cell.
  LocalizationStep(const Settings& settings, const StartMap& start);

  void observe(const Odometry& odometry);
  [[nodiscard]] TrackedScan observe(Scan scan);
  /// A scan that a newer one has overtaken: where odometry alone says that it was taken.
  [[nodiscard]] TrajectoryPoint pass_over(const Scan& scan);
  void apply(const MapRevision& revision);
  /// What is different from the map for now; null: nothing is known any more.
  void apply(std::shared_ptr<const TransientObstacles> transients);
  /// From the next scan on: what the map has in ignored zones is kept from the localizer.
  void set_zones(const Zones& zones);
  /// Starts again around a pose that a person gave (σ 0.2 m and 10°). False where nobody can stand there:
  /// the pose stays as it was.
  bool relocalize(const Pose2& map_from_robot);

  /// Of the newest scan that was localized.
  [[nodiscard]] const LocalizationRow& row() const { return row_; }
  /// As Localizer::fit().
  [[nodiscard]] std::optional<double> fit() const { return localizer_.fit(); }
  /// What a person should know of the newest scan's pose or of the laser's mount: lines for the log, seldom any.
  [[nodiscard]] const std::vector<LogLine>& lines() const { return lines_; }
  /// As FitWatch::start_fits().
  [[nodiscard]] bool start_fits() const { return fit_watch_.start_fits(); }
  /// What is known of wheels and mount, without what was learned on the last way: whether scans and wheels contradict
  /// each other there is not known yet.
  [[nodiscard]] const std::optional<localization::motion::DriveCalibration>& calibration() const {
    return calibration_;
  }
  /// What the newest pose rests on; null where not on particles (localizer.hpp).
  [[nodiscard]] const localization::particles::ParticleSet* particles() const { return localizer_.particles(); }
  [[nodiscard]] localization::belief::StabilityRecord stability() const { return localizer_.stability(); }
  [[nodiscard]] double time_lost_s() const { return time_lost_s_; }
  [[nodiscard]] double time_global_s() const { return time_global_s_; }
  [[nodiscard]] const VerdictTimes& verdict_times() const { return verdict_times_; }
  /// What befell the localizer (localization/localizer_counts.hpp), by name.
  [[nodiscard]] std::map<std::string, std::uint64_t> counts() const;
  /// From the first scan to the last.
  [[nodiscard]] double covered_s() const;

 private:
  void count_time(Timestamp time);
  void learn_or_forget(const TrackedScan& tracked);
  void tell(LogLine line);
  [[nodiscard]] SensorDoubt sensor_doubt() const;
  void tell_of_ground(bool is_new);

  localization::LocalizerParams params_;
  IgnoredGround ignored_;
  std::uint32_t revision_;  // number of the map
  localization::Localizer localizer_;
  std::optional<localization::motion::DriveCalibration> calibration_;      // before the newest metre
  std::optional<localization::motion::DriveCalibration> calibration_now_;  // after the one before
  double since_kept_m_ = 0.0;
  FitWatch fit_watch_;
  MountWatch mount_watch_;
  WheelWatch wheel_watch_;
  std::vector<LogLine> lines_;
  mapping::paper::DivergenceRatio ratio_;
  bool is_on_new_ground_ = false;
  LocalizationRow row_;
  Pose2 last_map_from_robot_;
  std::optional<Pose2> last_odom_from_robot_;
  LocalizerState last_state_ = LocalizerState::kGlobal;
  PoseVerdict last_verdict_ = PoseVerdict::kUndecided;
  std::optional<Timestamp> first_scan_;
  std::optional<Timestamp> last_scan_;
  double time_lost_s_ = 0.0;
  double time_global_s_ = 0.0;
  VerdictTimes verdict_times_;
};

/// What the report of a run says of its localizer.
void add_to(RunReport& report, const LocalizationStep& step);

}  // namespace deltamap::daemon
