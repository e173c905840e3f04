// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/pose_course.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "experiments/scan_table.hpp"

namespace deltamap::experiments {
namespace {

using mapping::gate::GateReason;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kOff_m = 0.5;
constexpr double kNear_m = 0.3;        // a pose that counts as found, and from which it may jump away
constexpr double kRight_m = 0.1;       // the map ought to be written
constexpr double kFoundFor_s = 5.0;    // tracked and near, until a global start counts as found
constexpr double kStretch_s = 5.0;     // off for longer is a failure
constexpr double kGap_s = 2.0;         // between two scans; the slowest rate is one a second
constexpr double kBefore_s = 20.0;     // in which what happened may be a cause
constexpr double kAfterSlip_s = 60.0;  // in which the covariance is judged apart
constexpr double kInside95 = 7.815;    // 95 % quantile of χ², 3 degrees of freedom

std::string why_shut(GateReason reason, GateReason confirms_after) {
  std::string why{name_of(reason)};
  const bool tells_more = reason == GateReason::kConfirming && confirms_after != GateReason::kOpen;
  if (tells_more && confirms_after != reason) why += " after " + std::string{name_of(confirms_after)};
  return why;
}

double sum_of(const std::map<std::string, double>& parts) {
  return std::accumulate(parts.begin(), parts.end(), 0.0,
                         [](double sum, const auto& part) { return sum + part.second; });
}

double share_of(double part, double all) { return all > 0.0 ? part / all : kNothing; }

}  // namespace

std::vector<std::string> all_whys_shut() {
  std::vector<std::string> whys;
  for (std::size_t i = 1; i < mapping::gate::kGateReasons; ++i) {
    const auto reason = static_cast<GateReason>(i);
    whys.push_back(why_shut(reason, GateReason::kOpen));
    if (mapping::gate::proves_wrong(reason)) whys.push_back(why_shut(GateReason::kConfirming, reason));
  }
  return whys;
}

std::string shut_number(const std::string& why) {
  std::string number = "shut_right_" + why + "_s";
  std::replace(number.begin(), number.end(), ' ', '_');
  return number;
}

void PoseCourse::Coverage::add(bool is_inside) {
  ++all;
  inside += is_inside ? 1 : 0;
}

double PoseCourse::Coverage::share() const { return share_of(static_cast<double>(inside), static_cast<double>(all)); }

PoseCourse::PoseCourse(bool knows_start, const Pose2& robot_from_laser)
    : knows_start_{knows_start}, robot_from_laser_{robot_from_laser} {
  if (knows_start) found_s_ = 0.0;
}

void PoseCourse::observe(const Mapped& scan, const Befallen& befallen) {
  note_happenings(scan, befallen);
  const double error_m = distance_between(scan.map_from_robot, scan.estimate.map_from_robot);
  if (found_s_) {
    followed_s_ += counted_s_;
    note_error(error_m);
    note_laser(scan);
    note_gate(scan, error_m);
  } else {
    search(scan, error_m);
  }
}

void PoseCourse::note_happenings(const Mapped& scan, const Befallen& befallen) {
  const double since_last_s = is_first_ ? 0.0 : scan.passed_s - now_s_;
  is_first_ = false;
  now_s_ = scan.passed_s;
  counted_s_ = std::min(since_last_s, kGap_s);
  is_after_gap_ = since_last_s > kGap_s;
  if (is_after_gap_) {
    gap_s_ = now_s_;
    ++gaps_;
  }
  if (befallen.change_in_view) {
    change_s_ = now_s_;
    changed_view_s_ += counted_s_;
  }
  if (befallen.person_near) person_s_ = now_s_;
  if (befallen.little_in_view) {
    empty_s_ = now_s_;
    empty_view_s_ += counted_s_;
  }
  if (scan.slips > 0) slip_s_ = now_s_;
  slips_ += scan.slips;
  ++scans_;
  costs_.localization_s += scan.costs.localization_s;
  costs_.awareness_s += scan.costs.awareness_s;
  costs_.map_update_s += scan.costs.map_update_s;
}

void PoseCourse::search(const Mapped& scan, double error_m) {
  const bool is_tracking = scan.estimate.state == LocalizerState::kTracking;
  if (is_tracking && error_m > kOff_m) wrong_before_found_s_ += counted_s_;
  if (!is_tracking || error_m > kNear_m) {
    near_since_s_.reset();
    return;
  }
  if (!near_since_s_) near_since_s_ = now_s_;
  if (now_s_ - *near_since_s_ >= kFoundFor_s) found_s_ = *near_since_s_;
}

void PoseCourse::note_error(double error_m) {
  const bool was_near = !errors_m_.empty() && errors_m_.back() <= kNear_m;
  if (was_near && error_m > kOff_m && !is_after_gap_) ++jumps_;
  errors_m_.push_back(error_m);
  if (error_m <= kOff_m) {
    off_for_s_ = 0.0;
    return;
  }
  if (!first_off_s_) {
    first_off_s_ = now_s_;
    first_off_during_ = happening();
  }
  off_s_ += counted_s_;
  const bool was_counted = off_for_s_ > kStretch_s;
  off_for_s_ += counted_s_;
  if (!was_counted && off_for_s_ > kStretch_s) ++stretches_;
  longest_off_s_ = std::max(longest_off_s_, off_for_s_);
}

/// Scans tell where the laser is. Nobody can know by them where on the robot it is: the covariance is judged by where
/// the robot would be if the mount were the one that it was told.
void PoseCourse::note_laser(const Mapped& scan) {
  const Pose2& told_mount = scan.tracked.scan.robot_from_laser;
  const Pose2 map_from_laser = scan.map_from_robot * robot_from_laser_;
  laser_errors_m_.push_back(distance_between(map_from_laser, scan.estimate.map_from_robot * told_mount));
  const Pose2 truth = map_from_laser * inverse(told_mount);
  const Pose2& estimate = scan.estimate.map_from_robot;
  const Eigen::Vector3d error{estimate.x - truth.x, estimate.y - truth.y, turn_between(truth.theta, estimate.theta)};
  const bool is_inside = error.dot(scan.estimate.covariance.ldlt().solve(error)) <= kInside95;
  coverage_.add(is_inside);
  if (slip_s_ && now_s_ - *slip_s_ < kAfterSlip_s) coverage_after_slips_.add(is_inside);
}

void PoseCourse::note_gate(const Mapped& scan, double error_m) {
  const bool is_tracking = scan.estimate.state == LocalizerState::kTracking;
  if (error_m <= kOff_m && !is_tracking) searching_while_near_s_ += counted_s_;
  if (error_m > kRight_m) return;
  right_s_ += counted_s_;
  if (scan.awareness.gate == GateReason::kOpen) return;
  shut_while_right_s_[why_shut(scan.awareness.gate, scan.awareness.gate_confirms_after)] += counted_s_;
}

std::string PoseCourse::happening() const {
  std::string happening;
  const auto add = [&](const std::optional<double>& last_s, const char* name) {
    if (last_s && now_s_ - *last_s < kBefore_s) happening += (happening.empty() ? "" : ", ") + std::string{name};
  };
  add(change_s_, "change in view");
  add(slip_s_, "slip");
  add(gap_s_, "gap");
  add(person_s_, "person near");
  add(empty_s_, "little in view");
  return happening.empty() ? "none known" : happening;
}

std::string PoseCourse::cause() const {
  if (!found_s_) return "start not found";
  return first_off_during_;
}

PoseCourse::Numbers PoseCourse::numbers() const {
  const auto ms_a_scan = [&](double seconds) { return 1e3 * share_of(seconds, static_cast<double>(scans_)); };
  Numbers numbers{{"minutes", now_s_ / 60.0},
                  {"scans", static_cast<double>(scans_)},
                  {"found_after_s", knows_start_ || !found_s_ ? kNothing : *found_s_},
                  {"start_found", knows_start_ ? kNothing
                                  : found_s_   ? 1.0
                                               : 0.0},
                  {"wrong_before_found_s", knows_start_ ? kNothing : wrong_before_found_s_},
                  {"error_rms_m", root_mean_square(errors_m_)},
                  {"laser_error_rms_m", root_mean_square(laser_errors_m_)},
                  {"error_median_m", quantile(errors_m_, 0.5)},
                  {"error_p99_m", quantile(errors_m_, 0.99)},
                  {"error_most_m", quantile(errors_m_, 1.0)},
                  {"off_share", share_of(off_s_, followed_s_)},
                  {"off_s", off_s_},
                  {"longest_off_s", longest_off_s_},
                  {"stretches_off", static_cast<double>(stretches_)},
                  {"jumps", static_cast<double>(jumps_)},
                  {"first_off_s", first_off_s_.value_or(kNothing)},
                  {"searching_while_near_s", searching_while_near_s_},
                  {"gate_shut_while_right", share_of(sum_of(shut_while_right_s_), right_s_)},
                  {"inside_95", coverage_.share()},
                  {"inside_95_after_slip", coverage_after_slips_.share()},
                  {"changed_view_s", changed_view_s_},
                  {"empty_view_s", empty_view_s_},
                  {"slips", static_cast<double>(slips_)},
                  {"gaps", static_cast<double>(gaps_)},
                  {"localizer_cpu_ms", ms_a_scan(costs_.localization_s)},
                  {"mapping_cpu_ms", ms_a_scan(costs_.awareness_s + costs_.map_update_s)}};
  for (const std::string& why : all_whys_shut()) {
    const auto found = shut_while_right_s_.find(why);
    numbers.emplace_back(shut_number(why), found == shut_while_right_s_.end() ? 0.0 : found->second);
  }
  return numbers;
}

}  // namespace deltamap::experiments
