// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/fit_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "localization/belief/fit_monitor.hpp"
#include "localization/particles/start_pose.hpp"

namespace deltamap::daemon {
namespace {

constexpr int kFirstScans = localization::particles::PoseCheck::kScans;
constexpr localization::belief::FitParams kJudged{};  // the defaults of localization.fit

// A pose that is not sure for so long and so far is reported: a search, or a person in the way, takes less.
constexpr double kLong_s = 60.0;
constexpr double kFar_m = 10.0;
constexpr double kLongestGap_s = 10.0;  // between scans; in longer ones nothing was looked at, or a clock was set

const std::string kSayWhere = "say where the robot stands by `deltamap ctl relocalize X,Y,DEG`";

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

}  // namespace

bool is_in_doubt(std::optional<double> fit) { return fit.value_or(0.0) < kJudged.found_above; }

std::string fit_words(std::optional<double> fit) {
  if (!fit) return "no beam came back, so that nothing tells whether it fits";
  const std::string share = percent(*fit) + " of its beams fit";
  return is_in_doubt(fit) ? "only " + share + ": is it the right place, and the right map?" : share;
}

LogLine refused_start_line() {
  return {"the start pose lies more than 1 m from free floor, so that the whole map is searched; " + kSayWhere, true};
}

void FitWatch::pass(const TrackedScan& tracked) {
  const Timestamp time = tracked.scan.time;
  passed_s_ = last_ ? std::max(0.0, seconds(time - *last_)) : 0.0;
  driven_m_ = last_ ? distance_between(last_odom_from_robot_, tracked.odom_from_robot) : 0.0;
  last_ = time;
  last_odom_from_robot_ = tracked.odom_from_robot;
}

LogLine FitWatch::observe(const TrackedScan& tracked, const Seen& seen) {
  pass(tracked);
  if (seen.fit) {
    const double before = mean_fit_.value_or(*seen.fit);
    mean_fit_ = before + (1.0 - std::exp(-passed_s_ / kJudged.memory_s)) * (*seen.fit - before);
  }
  if (LogLine start = judged_start(seen.fit_of_all, tracked.estimate.belief.verdict); !start.text.empty()) return start;
  if (LogLine scale = judged_scale(seen.scale); !scale.text.empty()) return scale;
  const bool is_unfit =
      tracked.estimate.state != LocalizerState::kTracking || mean_fit_.value_or(1.0) < kJudged.lost_below;
  const bool was_seen = passed_s_ <= kLongestGap_s;
  unfit_s_ = is_unfit ? unfit_s_ + (was_seen ? passed_s_ : 0.0) : 0.0;
  unfit_m_ = is_unfit ? unfit_m_ + (was_seen ? driven_m_ : 0.0) : 0.0;
  return judged_long(tracked.estimate.state);
}

LogLine FitWatch::judged_start(std::optional<double> fit_of_all, PoseVerdict verdict) {
  if (!given_) return {};
  Given& given = *given_;
  if (fit_of_all) {
    ++given.scans;
    const double share = std::max(1.0 / given.scans, 1.0 - std::exp(-passed_s_ / kJudged.memory_s));
    given.fit += share * (*fit_of_all - given.fit);
  }
  given.is_supported = given.fit >= kJudged.found_above || verdict == PoseVerdict::kRight;
  if (given.scans < kFirstScans) return {};
  if (given.is_supported) {
    given_.reset();
    return {};
  }
  if (std::exchange(given.is_told, true)) return {};
  return {"the start pose does not fit: " + percent(given.fit) +
              " of the beams end where the map says; the map may be another, or the pose wrong: " + kSayWhere,
          true};
}

LogLine FitWatch::judged_scale(const std::optional<localization::sensor::OtherScale>& scale) {
  if (!scale || is_scale_told_) return {};
  is_scale_told_ = true;
  char text[240];
  (void)std::snprintf(
      text, sizeof text,
      "ranges and map differ in scale: with ranges %.2f times as long the map explains %s of the beams, "
      "as they are %s; look at the laser's unit, and at 'resolution' in the map's YAML",
      scale->factor, percent(scale->explained).c_str(), percent(scale->explained_as_is).c_str());
  return {text, true};
}

LogLine FitWatch::judged_long(LocalizerState state) {
  if (unfit_s_ == 0.0) return {std::exchange(said_, false) ? "the map fits again" : ""};
  // Global localization is reported by time alone: a robot that stands would never drive the distance.
  const bool is_long = unfit_s_ >= kLong_s && (unfit_m_ >= kFar_m || state == LocalizerState::kGlobal);
  if (said_ || !is_long) return {};
  said_ = true;
  const std::string best = mean_fit_ ? percent(*mean_fit_) + " of the beams fit at the best one; " : "";
  return {"no place in the map has been sure for " + std::to_string(std::lround(unfit_s_)) + " s and " +
              std::to_string(std::lround(unfit_m_)) + " m: " + best +
              "is it the map of this place, and 'laser.mount' right? Else " + kSayWhere,
          true};
}

}  // namespace deltamap::daemon
