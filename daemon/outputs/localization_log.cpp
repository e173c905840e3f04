// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/localization_log.hpp"

#include <cinttypes>
#include <cstdio>

#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {
namespace {

/// A line under way.
class Line {
 public:
  void number(double value) {
    char text[32];
    (void)std::snprintf(text, sizeof text, "%.9g", value);
    word(text);
  }
  void count(std::uint32_t value) { word(std::to_string(value)); }
  void counts(const BeamCounts& beams) {
    count(beams.expected);
    count(beams.fit);
    count(beams.short_of);
    count(beams.beyond);
  }
  void pose(const Pose2& pose) {
    number(pose.x);
    number(pose.y);
    number(pose.theta);
  }
  void word(std::string_view value) {
    if (!text_.empty()) text_ += ',';
    text_ += value;
  }
  [[nodiscard]] std::string ended() && { return std::move(text_) + "\n"; }

 private:
  std::string text_;
};

std::string unix_seconds_of(Timestamp time) {
  const std::int64_t ns = unix_ns(time);
  char text[40];
  (void)std::snprintf(text, sizeof text, "%" PRId64 ".%09" PRId64, ns / 1'000'000'000, ns % 1'000'000'000);
  return text;
}

std::string share_of(const BeamCounts& beams) {
  return std::to_string(beams.fit) + "/" + std::to_string(beams.expected);
}

}  // namespace

LocalizationRow row_of(const TrackedScan& tracked) {
  const Estimate& estimate = tracked.estimate;
  LocalizationRow row;
  row.time = tracked.scan.time;
  row.number = tracked.scan.number;
  row.map_from_robot = estimate.map_from_robot;
  row.covariance = estimate.covariance;
  row.state = estimate.state;
  row.belief = estimate.belief;
  row.w_avg = estimate.w_avg;
  row.w_fast = tracked.weights.w_fast;
  row.w_slow = tracked.weights.w_slow;
  row.r_d = tracked.weights.divergence_ratio();
  row.n_eff = estimate.n_eff;
  row.particles = estimate.particles;
  row.revision = estimate.revision;
  row.speed_m_per_s = tracked.speed_m_per_s;
  row.turn_rate_rad_per_s = tracked.turn_rate_rad_per_s;
  return row;
}

std::string csv_header() {
  return "time,number,state,x_m,y_m,heading_rad,w_avg,w_fast,w_slow,r_d,n_eff,particles,revision,"
         "pose_right,map_wrong,verdict,"
         "stable_expected,stable_fit,stable_short,stable_beyond,"
         "elsewhere_expected,elsewhere_fit,elsewhere_short,elsewhere_beyond,"
         "rival_share,rival_x_m,rival_y_m,rival_heading_rad,"
         "cov_xx,cov_xy,cov_xh,cov_yy,cov_yh,cov_hh,speed_m_per_s,turn_rate_rad_per_s\n";
}

std::string csv_line(const LocalizationRow& row) {
  Line line;
  line.word(unix_seconds_of(row.time));
  line.count(row.number);
  line.word(name_of(row.state));
  line.pose(row.map_from_robot);
  for (const double value : {row.w_avg, row.w_fast, row.w_slow, row.r_d, row.n_eff}) line.number(value);
  line.count(row.particles);
  line.count(row.revision);
  line.number(row.belief.pose_right);
  line.number(row.belief.map_wrong);
  line.word(name_of(row.belief.verdict));
  line.counts(row.belief.is_checked ? row.belief.stable : BeamCounts{});
  line.counts(row.belief.is_checked ? row.belief.elsewhere : BeamCounts{});
  line.number(row.belief.other_share);
  line.pose(row.belief.map_from_other);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) line.number(row.covariance(i, j));
  }
  line.number(row.speed_m_per_s);
  line.number(row.turn_rate_rad_per_s);
  return std::move(line).ended();
}

std::string state_line(const LocalizationRow& row) {
  const std::string_view state = name_of(row.state);
  char text[160];
  (void)std::snprintf(text, sizeof text, "localizer: %.*s x=%.2f y=%.2f heading=%.0f w_avg=%.3f scan=%" PRIu32,
                      static_cast<int>(state.size()), state.data(), row.map_from_robot.x, row.map_from_robot.y,
                      degrees(row.map_from_robot.theta), row.w_avg, row.number);
  return text;
}

std::string verdict_line(const LocalizationRow& row) {
  const Belief& belief = row.belief;
  char text[96];
  (void)std::snprintf(text, sizeof text, " pose_right=%.2f map_wrong=%.2f rival=%.2f scan=%" PRIu32, belief.pose_right,
                      belief.map_wrong, belief.other_share, row.number);
  return "pose verdict: " + std::string(name_of(belief.verdict)) + text + " stable=" + share_of(belief.stable) +
         " elsewhere=" + share_of(belief.elsewhere);
}

}  // namespace deltamap::daemon
