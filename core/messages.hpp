// SPDX-License-Identifier: Apache-2.0
// What flows through the house, in flow order: Odometry and Scan from the drivers, Estimate and TrackedScan from the
// localizer, ScanSet S(k) from Δ-awareness, MapRevision M_k from the map update, DriveCommand from the pilot.
// Plain data; each is stamped once, by its driver.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/time.hpp"

namespace deltamap {

/// Where the robot's wheels say it is, and the state that its controller reports with it (one SIP, protocols.md A6).
struct Odometry {
  Timestamp time;                    ///< when the packet's first byte arrived, less the controller's latency
  Pose2 odom_from_robot;             ///< integrated since the epoch's start
  double speed_m_per_s = 0.0;        ///< forward, as reported
  double turn_rate_rad_per_s = 0.0;  ///< counter-clockwise, from the wheel speeds
  std::uint32_t epoch = 0;           ///< grows when the controller's pose jumped: never integrate across epochs
  bool motors_enabled = false;
  bool stop_button = false;
  bool stalled = false;            ///< either motor
  std::uint8_t front_bumpers = 0;  ///< a bit a segment
  std::uint8_t rear_bumpers = 0;   ///< a bit a segment
  double battery_v = 0.0;          ///< 0: the controller tells none, or an empty one
  bool charging = false;           ///< a charger is plugged in, or its current flows
  bool low_battery = false;        ///< at or below what the controller's configuration calls low
  std::uint16_t fault_flags = 0;   ///< as the controller reports them; 0: no fault, or a controller that reports none
};

/// What a beam brought back (protocols.md B4). Only a range frees cells or scores a pose by default.
enum class BeamKind : std::uint8_t { kRange, kBeyondMaximum, kNotValid, kDazzled, kOther };

struct Beam {
  float range_m = 0.0F;   ///< from the laser; 0 where the kind is not kRange
  float offset_s = 0.0F;  ///< the beam's own time after Scan::time
  BeamKind kind = BeamKind::kNotValid;
};

/// 1 σ of a range of an LMS 200, laser and what it meets together, where nothing else is configured.
inline constexpr double kRangeDeviationM = 0.015;

/// One sweep of the laser, counter-clockwise. Beam i points to first_bearing_rad + i · bearing_step_rad in the laser
/// frame.
struct Scan {
  Timestamp time;            ///< of the first beam (protocols.md B7)
  Timestamp received;        ///< arrival of the last byte: what latency is measured from
  std::uint32_t number = 0;  ///< counts decoded scans from 0
  double first_bearing_rad = 0.0;
  double bearing_step_rad = 0.0;
  double max_range_m = 0.0;  ///< longest range that the configuration lets pass; longer ones are kBeyondMaximum
  double range_deviation_m = kRangeDeviationM;  ///< 1 σ of a range; the localizer puts in what is configured
  Pose2 robot_from_laser;                       ///< the mount
  std::uint8_t severity = 0;  ///< of the laser's status: 0 ok, 1 info, 2 warning, 3 error, 4 fatal (protocols.md B6)
  bool implausible = false;   ///< the laser itself flags its values as implausible (protocols.md B6, bit 6)
  std::vector<Beam> beams;

  [[nodiscard]] double bearing_rad(std::size_t beam) const {
    return first_bearing_rad + static_cast<double>(beam) * bearing_step_rad;
  }
};

/// The one stream that the localizer reads, in the order of arrival.
using SensorMessage = std::variant<Odometry, Scan>;

enum class LocalizerState : std::uint8_t {
  kGlobal,    ///< pose unknown: the whole map is searched, or a start pose is being checked
  kTracking,  ///< one hypothesis, fitting: what the paper requires for Δ-mapping
  kLost       ///< scans have stopped fitting and no change of the map explains it
};

/// What the beams of one scan say at the estimated pose, each held against the range that the map expects there.
struct BeamCounts {
  std::uint32_t expected = 0;  ///< beams of which the map expects a range: fit + short_of + beyond
  std::uint32_t fit = 0;       ///< ended where expected
  std::uint32_t short_of = 0;  ///< ended before: something stands in the way
  std::uint32_t beyond = 0;    ///< went through what the map knows as an obstacle
};

enum class PoseVerdict : std::uint8_t {
  kUndecided,  ///< too little in view that has proven stable, or another pose hypothesis fits as well
  kRight,
  kWrong
};

/// Am I lost, or is the map out of date? Two answers, not one label, and what they rest on.
struct Belief {
  double pose_right = 0.5;  ///< P(the robot is where the estimate says), [0, 1]
  double map_wrong = 0.5;   ///< P(what is in view differs from the map), [0, 1]
  PoseVerdict verdict = PoseVerdict::kUndecided;
  BeamCounts stable;     ///< beams on tiles that have long proven stable: they tell most of the pose
  BeamCounts elsewhere;  ///< all others: of the pose they tell half as much, against it less
  bool is_checked =
      false;  ///< the counts are of this scan; else of the last one held against the map, none since a kidnapping
  double other_share = 0.0;  ///< of the belief that the best other pose hypothesis holds, [0, 1]
  Pose2 map_from_other;      ///< that hypothesis; of no meaning where its share is 0
  /// The last scan at a tracked pose that did not follow from the one before; none: each has.
  std::optional<Timestamp> broke_off_at{};
  bool fits_worse = false;  ///< the map, than before scans broke off: the robot was carried, by all signs
  /// Wheels and scans have carried the pose here from where it was surely right: what the map does not explain is new.
  bool is_carried = false;
  /// The pose rests on what this run has drawn where the map knew nothing, and tells nothing of what it knew before.
  bool is_on_new_ground = false;
};

/// What the localizer believes at one scan.
struct Estimate {
  Timestamp time;                                      ///< of the scan's first beam
  Pose2 map_from_robot;                                ///< the believed pose
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of that pose
  /// Of that, what all scans are off by alike, for the map's surfaces are: it is drawn and read with the same error.
  PoseCovariance bias_covariance = PoseCovariance::Zero();
  LocalizerState state = LocalizerState::kGlobal;
  bool checks_pose = false;           ///< kGlobal, and yet a pose is followed: it is held against a few scans first
  std::uint32_t relocalizations = 0;  ///< grows when a person says where the robot is: it was believed elsewhere
  /// Effective sample size before resampling, Eq. 5; in [1, particles]. While surfaces lead no particle is weighed, and
  /// it is `particles`.
  double n_eff = 0.0;
  std::uint32_t particles = 0;
  Belief belief{};     ///< how right the pose is, and how wrong the map
  double w_avg = 0.0;  ///< exp of the mean log-likelihood of the used beams, averaged over the heaviest cluster; (0, 1]
  std::uint32_t revision = 0;                ///< number k of the map that the pose was computed on
  std::shared_ptr<const OccupancyGrid> map;  ///< that map, M_k

  /// What differs from scan to scan and from place to place: how far beams may be off from where the map has surfaces.
  [[nodiscard]] PoseCovariance noise_covariance() const { return covariance - bias_covariance; }
};

/// A beam with the robot's motion during the sweep taken out: both ends in the robot's frame at Scan::time.
struct RayInRobot {
  Eigen::Vector2f origin{0.0F, 0.0F};  ///< the laser when the beam was measured, m
  Eigen::Vector2f end{0.0F, 0.0F};     ///< where it ended, m; equal to origin where the beam has no range
};

/// How well scans of a tracked pose have fitted the map of late, and over the long run (paper Eq. 2).
struct WeightAverages {
  double w_fast = 0.0;  ///< 0 until the first tracked scan
  double w_slow = 0.0;

  /// r_d, Eq. 3. Positive: scans fit the map worse than they used to.
  [[nodiscard]] double divergence_ratio() const { return w_slow > 0.0 ? 1.0 - w_fast / w_slow : 0.0; }
};

/// What the scans of a run have shown to be other than believed: while it is, nothing can be drawn right.
enum class SensorDoubt : std::uint8_t {
  kNone,
  kWheels,  ///< they contradict the scans all the time
  kMount,   ///< the laser is mounted otherwise than set
  kScale    ///< ranges and map differ in scale
};

/// A scan with the pose it was taken from: what Δ-awareness and the pilot judge by.
struct TrackedScan {
  Scan scan;
  std::vector<RayInRobot> rays;  ///< one for each beam
  Estimate estimate;
  Pose2 odom_from_robot;  ///< at Scan::time, without what is known of the wheels' errors; in one frame over all epochs
  std::uint32_t odometry_epoch = 0;
  double speed_m_per_s = 0.0;        ///< measured around Scan::time
  double turn_rate_rad_per_s = 0.0;  ///< measured around Scan::time
  WeightAverages weights{};          ///< up to this scan
  /// Way that the wheels have claimed while the scans say that the robot stands, m; turns count 0.3 m a radian. 0: it
  /// moves as they say, or nothing speaks against them.
  double stood_m = 0.0;
  SensorDoubt sensor_doubt = SensorDoubt::kNone;
};

/// A cell that has proven to be persistently different from the map.
struct CellVerdict {
  Cell cell;
  CellState state = CellState::kUnknown;  ///< what it should become
};

enum class MappingMethod : std::uint8_t { kPaper, kEvidence };

/// Scans that outlive their stage: shared by whom they are handed to, without their maps.
using KeptScans = std::vector<std::shared_ptr<const TrackedScan>>;

/// S(k): the scans of one Δ-phase (paper §3.2), ready to become a revision.
struct ScanSet {
  std::uint32_t phase = 0;  ///< number of the Δ-phase, from 1
  MappingMethod method = MappingMethod::kEvidence;
  Timestamp began;
  Timestamp ended;
  KeptScans scans;                    ///< in order of time; all of one odometry epoch
  std::vector<CellVerdict> verdicts;  ///< evidence: the cells to write, judged at the localizer's poses; paper: empty
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of the localizer's pose when the set ended
  bool pose_in_doubt = false;        ///< the pose did not hold over the whole set: nothing of it may be written
  std::uint32_t least_changes = 1;   ///< cells; fewer are not worth a revision yet: another look will find them again
  std::optional<Timestamp> settled;  ///< what was written up to then is provisional no longer
};

/// The pose has proven wrong: what was written by it, and is still provisional, is taken back.
struct WithdrawOrder {
  Timestamp time;                                      ///< of the scan that proved it
  Timestamp from;                                      ///< what was written from then on
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of the localizer's pose at that scan
};

/// The pose has held for long and far enough: what was written before is provisional no longer. A set says the same of
/// what was written before it; this comes where no other set does.
struct Settlement {
  Timestamp before;
};

/// What Δ-awareness asks of the map, at most one a scan.
using MapRequest = std::variant<ScanSet, WithdrawOrder, Settlement>;

/// M_k: the map after a Δ.
struct MapRevision {
  std::uint32_t number = 0;  ///< k; M_0 is 0
  Timestamp time;            ///< end of the Δ-phase that it came from
  std::shared_ptr<const OccupancyGrid> map;
  std::vector<CellChange> changes;  ///< from M_{k-1}
  FieldPatch field_patch;           ///< prepared for the localizer, so that applying it is a copy
};

/// What the pilot asks for; the io thread checks it and lets it expire.
struct DriveCommand {
  Timestamp time;                    ///< of the scan that it was decided on
  double speed_m_per_s = 0.0;        ///< forward
  double turn_rate_rad_per_s = 0.0;  ///< counter-clockwise
};

}  // namespace deltamap
