// SPDX-License-Identifier: Apache-2.0
#include "experiments/verdict/verdict_part.hpp"

#include <cmath>
#include <utility>

namespace deltamap::experiments {
namespace {

constexpr double kCalledTooLong_s = 5.0;

bool was_wrong(const Outcome& outcome) { return outcome.number("was_wrong") > 0.5; }

template <typename Claim>
double count(const std::vector<const Outcome*>& outcomes, Claim&& claim) {
  return static_cast<double>(
      std::count_if(outcomes.begin(), outcomes.end(), [&](const Outcome* outcome) { return claim(*outcome); }));
}

}  // namespace

double VerdictPart::once_wrong() const { return count(chosen_, was_wrong); }

double VerdictPart::ambiguous() const { return count(chosen_, is_ambiguous); }

double VerdictPart::wrong_called_right() const {
  return count(chosen_, [](const Outcome& run) { return run.number("wrong_called_right_s") > kCalledTooLong_s; });
}

double VerdictPart::right_called_lost() const {
  return count(chosen_, [](const Outcome& run) { return run.number("right_called_lost_s") > 0.0; });
}

double VerdictPart::recovered_in(double driving_s) const {
  return count(chosen_,
               [&](const Outcome& run) { return was_wrong(run) && run.number("recovered_driving_s") <= driving_s; });
}

double VerdictPart::called_right_again_in(double driving_s) const {
  return count(chosen_, [&](const Outcome& run) {
    return was_wrong(run) && run.number("recovered_called_right_s") <= driving_s;
  });
}

double VerdictPart::recovered_in_after_unique(double driving_s) const {
  return count(chosen_, [&](const Outcome& run) {
    return was_wrong(run) && run.number("recovered_driving_s") - run.number("unique_after_s") <= driving_s;
  });
}

double VerdictPart::recovery_quantile_s(double share) const {
  std::vector<double> times_s;
  for (const Outcome* run : chosen_) {
    const double time_s = run->number("recovered_driving_s");
    if (was_wrong(*run)) times_s.push_back(std::isnan(time_s) ? HUGE_VAL : time_s);
  }
  const double answer_s = quantile(times_s, share);
  return std::isfinite(answer_s) ? answer_s : std::nan("");
}

double VerdictPart::mean_noticed_s() const {
  std::vector<double> times_s;
  for (const Outcome* run : chosen_) {
    if (!std::isnan(run->number("noticed_s"))) times_s.push_back(run->number("noticed_s"));
  }
  return mean_of(times_s);
}

double VerdictPart::called_right_when_right() const {
  std::vector<double> shares;
  for (const Outcome* run : chosen_) {
    if (!was_wrong(*run)) shares.push_back(run->number("called_right_share"));
  }
  return mean_of(shares);
}

Reliability VerdictPart::pose() const {
  Reliability all;
  for (const Outcome* run : chosen_) all = pose_reliability(run->scans, std::move(all));
  return all;
}

Reliability VerdictPart::map() const {
  Reliability all;
  for (const Outcome* run : chosen_) all = map_reliability(run->scans, std::move(all));
  return all;
}

}  // namespace deltamap::experiments
