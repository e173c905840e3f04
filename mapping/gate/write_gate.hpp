// SPDX-License-Identifier: Apache-2.0
// Decides whether M_k may be written: only while the localizer's belief has one mode and P(pose right) is high. Looks
// at every tracked scan; tells whether it is open and why not, detects when the pose proves to have been wrong, and
// counts the time shut by reason, for a gate that stays shut is a failure too.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/messages.hpp"
#include "mapping/gate/provisional_window.hpp"

namespace deltamap::mapping::gate {

enum class GateReason : std::uint8_t {
  kOpen,
  kSearching,        ///< the localizer does not know where the robot is
  kLost,             ///< it has lost its way
  kWrong,            ///< it calls its own pose wrong
  kRelocalized,      ///< a person has said where the robot is
  kDisbelieved,      ///< P(pose right) is so low that it is rather wrong
  kConfirming,       ///< the pose was wrong a moment ago, or scans broke off, and it has to hold for a while
  kDoubtful,         ///< P(pose right) is low
  kOtherHypothesis,  ///< another pose hypothesis holds too much of the belief: two modes
  kSpread,           ///< the pose is spread too wide, or nothing in view holds it
  kWheels,           ///< wheels and scans contradict each other all the time
  kMount,            ///< the laser is mounted otherwise than set
  kScale             ///< ranges and map differ in scale
};
inline constexpr std::size_t kGateReasons = 13;
/// For status, report and log: "open", "searching", "lost", …
[[nodiscard]] std::string_view name_of(GateReason reason);
/// Does it say that the pose was wrong, and not only that it may be?
[[nodiscard]] bool proves_wrong(GateReason reason);

struct WriteGateParams {
  bool enabled = true;             ///< false: everything is written, as the paper does (mapping.gate.enabled)
  double least_pose_right = 0.83;  ///< P(pose right) below which it is shut; [0, 1]
  double disbelieved_below = 0.3;  ///< P(pose right) that counts as a proof that it was wrong; [0, 1]
  double most_other_share = 0.05;  ///< of the belief, that another pose hypothesis may hold; [0, 1]
  double most_deviation_m = 0.3;   ///< σ of the position along its worst axis; > 0
  std::uint32_t least_expected =
      3;                    ///< beams that the map expects something of: fewer, and only the wheels hold the pose
  double confirm_s = 20.0;  ///< so long a pose that a search has found must hold, for it may be an alias; >= 0
  double confirm_m = 10.0;  ///< and so far the robot must have driven meanwhile; >= 0
  double confirm_followed_s = 8.0;  ///< the same where the pose was followed all along and something spoke against it,
  double confirm_followed_m = 4.0;  ///< which an alias cannot explain: seconds and metres; >= 0
  double hold_s = 1.5;              ///< a set waits so long for a sign that its last scans were wrong; >= 0
  double hold_other_share = 0.005;  ///< of the belief: while another pose hypothesis holds more, it waits on; [0, 1]
  double break_settles_s = 1.0;     ///< after scans broke off it waits so long to see whether the map still fits; >= 0
  ProvisionalParams provisional;
};

/// Seconds by reason; those under kOpen are the time open.
using GateTimes = std::array<double, kGateReasons>;
[[nodiscard]] double observed_s(const GateTimes& times);
[[nodiscard]] double shut_s(const GateTimes& times);
/// By name, without those that never were.
[[nodiscard]] std::map<std::string, double> shut_by_reason(const GateTimes& times);

/// How far the wheels say that the robot has gone from scan to scan; never across a jump of the controller's pose.
class DrivenWay {
 public:
  /// Every scan in order: metres since the last one, 0 where there is none of the same odometry epoch.
  [[nodiscard]] double since_last_m(const TrackedScan& tracked);

 private:
  std::optional<Pose2> last_;  // odom_from_robot
  std::uint32_t epoch_ = 0;
};

class WriteGate {
 public:
  /// `inherits`: a pose was believed in the run before, and what was written by it is still provisional.
  explicit WriteGate(const WriteGateParams& params, bool inherits = false)
      : params_{params}, provisional_{params.provisional}, inherits_{inherits} {}

  /// Every tracked scan in order.
  void observe(const TrackedScan& tracked);

  [[nodiscard]] bool is_open() const { return reason_ == GateReason::kOpen; }
  [[nodiscard]] GateReason reason() const { return reason_; }
  /// What the pose is being confirmed after: the proof that it was wrong, kConfirming after scans that broke off; kOpen
  /// where it is not.
  [[nodiscard]] GateReason confirms_after() const { return is_confirming_ ? confirms_after_ : GateReason::kOpen; }
  /// Did this scan prove the pose wrong that was believed before it?
  [[nodiscard]] bool has_proven_wrong() const { return has_proven_wrong_; }
  /// Told that the pose was wrong, and not open since.
  [[nodiscard]] bool is_distrusted() const { return is_distrusted_; }
  /// Since when the pose has not been wrong, as far as is known; nothing where it never was.
  [[nodiscard]] const std::optional<Timestamp>& trusted_since() const { return trusted_since_; }
  /// What was written before is no longer provisional.
  [[nodiscard]] std::optional<Timestamp> settled() const { return provisional_.settled(); }
  [[nodiscard]] const GateTimes& times() const { return times_; }
  /// Since it was open last.
  [[nodiscard]] double shut_for_s() const { return shut_for_s_; }

 private:
  [[nodiscard]] GateReason judged(const TrackedScan& tracked);
  [[nodiscard]] bool was_relocalized(const Estimate& estimate);
  void note_break(const TrackedScan& tracked);
  [[nodiscard]] bool breaks_now(Timestamp time) const;
  [[nodiscard]] bool holds(GateReason judgement, bool fits_worse, double passed_s, double driven_m);

  WriteGateParams params_;
  std::optional<Timestamp> broke_off_at_;  // the last break that the belief has told of
  ProvisionalWindow provisional_;
  GateReason reason_ = GateReason::kSearching;
  bool inherits_ = false;
  bool was_tracking_ = false;
  bool has_proven_wrong_ = false;
  bool is_confirming_ = false;
  GateReason confirms_after_ = GateReason::kOpen;
  bool is_distrusted_ = false;
  double held_s_ = 0.0;  // of the time that it has been confirmed in, so long nothing spoke against it,
  double held_m_ = 0.0;  // and so far was driven meanwhile
  DrivenWay driven_way_;
  std::optional<std::uint32_t> relocalizations_;  // that the last scan knew of
  std::optional<Timestamp> trusted_since_;
  std::optional<Timestamp> last_;
  GateTimes times_{};
  double shut_for_s_ = 0.0;
};

}  // namespace deltamap::mapping::gate
