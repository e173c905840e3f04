// SPDX-License-Identifier: Apache-2.0
#include "experiments/verdict/verdict_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kRight_m = 0.3;
constexpr double kRight_rad = radians(6.0);
constexpr double kWrong_m = 0.5;
constexpr double kWrong_rad = radians(10.0);
constexpr double kStays_s = 5.0;  // right and tracked, until it counts as recovered
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// One scan since the event.
struct Judged {
  double since_s;
  double driven_s;
  PoseTruth truth;
  bool called_right;
  bool called_lost;
  bool tracking;
};

std::vector<Judged> judged(const ScanTable& scans) {
  const std::vector<double> since_s = scans.column("since_event_s");
  const std::vector<double> driven_s = scans.column("driven_s");
  const std::vector<double> error_m = scans.column("error_m");
  const std::vector<double> heading_rad = scans.column("heading_error_rad");
  const std::vector<double> state = scans.column("state");
  const std::vector<double> verdict = scans.column("verdict");
  std::vector<Judged> all;
  for (std::size_t i = 0; i < since_s.size(); ++i) {
    if (since_s[i] < 0.0) continue;
    const auto is_state = [&](LocalizerState one) { return state[i] == static_cast<double>(one); };
    const auto is_verdict = [&](PoseVerdict one) { return verdict[i] == static_cast<double>(one); };
    all.push_back({since_s[i], driven_s[i], pose_truth(error_m[i], heading_rad[i]), is_verdict(PoseVerdict::kRight),
                   is_state(LocalizerState::kLost) || is_verdict(PoseVerdict::kWrong),
                   is_state(LocalizerState::kTracking)});
  }
  return all;
}

/// Seconds of the longest unbroken stretch of scans of which the claim holds.
template <typename Claim>
double longest_s(const std::vector<Judged>& scans, Claim&& claim) {
  double longest = 0.0;
  std::optional<double> began;
  for (const Judged& scan : scans) {
    if (!claim(scan)) {
      began.reset();
      continue;
    }
    if (!began) began = scan.since_s;
    longest = std::max(longest, scan.since_s - *began);
  }
  return longest;
}

/// Seconds spent in scans of which the claim holds.
template <typename Claim>
double spent_s(const std::vector<Judged>& scans, Claim&& claim) {
  double spent = 0.0;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    if (claim(scans[i])) spent += scans[i].since_s - scans[i - 1].since_s;
  }
  return spent;
}

bool is_wrong(const Judged& scan) { return scan.truth == PoseTruth::kWrong; }

/// The scan with which a pose begins to stay right; none where it does not.
std::vector<Judged>::const_iterator recovery_of(const std::vector<Judged>& scans) {
  const auto last_wrong = std::find_if(scans.rbegin(), scans.rend(), is_wrong);
  auto began = scans.end();
  for (auto scan = last_wrong.base(); scan != scans.end(); ++scan) {
    if (scan->truth != PoseTruth::kRight || !scan->tracking) {
      began = scans.end();
      continue;
    }
    if (began == scans.end()) began = scan;
    if (scan->since_s - began->since_s >= kStays_s) return began;
  }
  return scans.end();
}

}  // namespace

PoseTruth pose_truth(double error_m, double heading_error_rad) {
  const double turn_rad = std::abs(heading_error_rad);
  if (error_m <= kRight_m && turn_rad <= kRight_rad) return PoseTruth::kRight;
  return error_m > kWrong_m || turn_rad > kWrong_rad ? PoseTruth::kWrong : PoseTruth::kBetween;
}

std::vector<std::pair<std::string, double>> verdict_numbers(const ScanTable& table) {
  const std::vector<Judged> scans = judged(table);
  const auto first_wrong = std::find_if(scans.begin(), scans.end(), is_wrong);
  const bool was_wrong = first_wrong != scans.end();
  const auto recovered = was_wrong ? recovery_of(scans) : scans.end();
  const auto called = std::find_if(first_wrong, scans.end(), [](const Judged& scan) {
    return scan.truth == PoseTruth::kRight && scan.called_right && scan.tracking;
  });
  const auto noticed =
      std::find_if(first_wrong, scans.end(), [](const Judged& scan) { return is_wrong(scan) && !scan.called_right; });
  const double lost_s = was_wrong ? 0.0 : spent_s(scans, [](const Judged& scan) {
    return scan.truth == PoseTruth::kRight && scan.called_lost;
  });
  const Reliability pose = pose_reliability(table);
  const Reliability map = map_reliability(table);
  return {{"was_wrong", was_wrong ? 1.0 : 0.0},
          {"wrong_s", spent_s(scans, is_wrong)},
          {"wrong_called_right_s", longest_s(scans, [](const Judged& s) { return is_wrong(s) && s.called_right; })},
          {"right_called_lost_s", lost_s},
          {"noticed_s", noticed == scans.end() ? kNothing : noticed->since_s},
          {"recovered_s", recovered == scans.end() ? kNothing : recovered->since_s - first_wrong->since_s},
          {"recovered_driving_s", recovered == scans.end() ? kNothing : recovered->driven_s - first_wrong->driven_s},
          {"recovered_called_right_s", called == scans.end() ? kNothing : called->driven_s - first_wrong->driven_s},
          {"driven_s", scans.empty() ? 0.0 : scans.back().driven_s},
          {"ends_wrong", !scans.empty() && is_wrong(scans.back()) ? 1.0 : 0.0},
          {"ends_called_right", !scans.empty() && scans.back().called_right ? 1.0 : 0.0},
          {"called_right_share", spent_s(scans, [](const Judged& s) { return s.called_right; }) /
                                     spent_s(scans, [](const Judged&) { return true; })},
          {"pose_brier", pose.brier()},
          {"map_brier", map.brier()}};
}

void Reliability::take(double given, bool came) {
  const double outcome = came ? 1.0 : 0.0;
  const auto index = static_cast<std::size_t>(std::clamp(given, 0.0, 1.0) * static_cast<double>(bins.size()));
  Bin& bin = bins[std::min(index, bins.size() - 1)];
  bin.scans += 1.0;
  bin.given += given;
  bin.came += outcome;
  squared += (given - outcome) * (given - outcome);
  scans += 1.0;
}

Reliability pose_reliability(const ScanTable& scans, Reliability reliability) {
  const std::vector<double> since_s = scans.column("since_event_s");
  const std::vector<double> error_m = scans.column("error_m");
  const std::vector<double> heading_rad = scans.column("heading_error_rad");
  const std::vector<double> given = scans.column("pose_right");
  for (std::size_t i = 0; i < given.size(); ++i) {
    const PoseTruth truth = pose_truth(error_m[i], heading_rad[i]);
    if (since_s[i] >= 0.0 && truth != PoseTruth::kBetween) reliability.take(given[i], truth == PoseTruth::kRight);
  }
  return reliability;
}

Reliability map_reliability(const ScanTable& scans, Reliability reliability) {
  const std::vector<double> since_s = scans.column("since_event_s");
  const std::vector<double> given = scans.column("map_wrong");
  const std::vector<double> came = scans.column("map_is_wrong");
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (since_s[i] >= 0.0) reliability.take(given[i], came[i] > 0.5);
  }
  return reliability;
}

}  // namespace deltamap::experiments
