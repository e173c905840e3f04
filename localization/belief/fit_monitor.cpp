// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/fit_monitor.hpp"

#include <cmath>

#include "localization/belief/pose_verdict.hpp"
#include "localization/hypotheses/hypothesis_report.hpp"

namespace deltamap::localization::belief {
namespace {

/// However badly the scan fits. What may make a robot lost and what finds it again must not hold at once.
bool is_supported(const FitMonitor::Observation& scan) {
  return scan.verdict == PoseVerdict::kRight || scan.is_held || scan.trust >= kSurelyRight;
}

}  // namespace

void FitMonitor::start(LocalizerState state) {
  enter(state);
  misfit_s_ = 0.0;
  wrong_s_ = 0.0;
  distrusted_s_ = 0.0;
  any_fit_ = false;
}

void FitMonitor::enter(LocalizerState state) {
  state_ = state;
  in_state_s_ = 0.0;
  driven_in_state_m_ = 0.0;
  turned_in_state_rad_ = 0.0;
}

bool FitMonitor::converged(const particles::ParticleCluster& best) const {
  const bool seen_enough =
      driven_in_state_m_ >= params_.converged_after_m || turned_in_state_rad_ >= params_.converged_after_rad;
  return seen_enough && best.weight >= hypotheses::kWinningShare &&
         best.covariance(0, 0) + best.covariance(1, 1) <= params_.converged_m * params_.converged_m &&
         best.covariance(2, 2) <= params_.converged_rad * params_.converged_rad;
}

void FitMonitor::count(const Observation& scan) {
  const double share = any_fit_ ? 1.0 - std::exp(-scan.passed_s / params_.memory_s) : 1.0;
  mean_fit_ += share * (scan.fit - mean_fit_);
  any_fit_ = true;
  const auto grown_while = [&](bool so, double so_far_s) { return so ? so_far_s + scan.passed_s : 0.0; };
  const bool misfit = mean_fit_ < params_.lost_below && !is_supported(scan);
  misfit_s_ = grown_while(misfit, misfit_s_);
  wrong_s_ = grown_while(scan.verdict == PoseVerdict::kWrong, wrong_s_);
  distrusted_s_ = grown_while(scan.trust <= kSurelyWrong, distrusted_s_);
}

LocalizerState FitMonitor::observe(const Observation& scan, const particles::ParticleCluster& best) {
  in_state_s_ += scan.passed_s;
  driven_in_state_m_ += scan.driven_m;
  turned_in_state_rad_ += std::abs(scan.turned_rad);
  count(scan);
  const bool fits = mean_fit_ > params_.found_above && distrusted_s_ == 0.0 && wrong_s_ == 0.0;
  switch (state_) {
    case LocalizerState::kGlobal:
      if (converged(best) && (fits || driven_in_state_m_ >= params_.converged_unfit_after_m)) {
        start(LocalizerState::kTracking);
      }
      break;
    case LocalizerState::kTracking:
      if (wrong_s_ > params_.lost_by_verdict_s || misfit_s_ >= params_.lost_after_s) enter(LocalizerState::kLost);
      beaten_ = scan.beaten;
      break;
    case LocalizerState::kLost:
      if (fits || is_supported(scan)) {
        enter(LocalizerState::kTracking);
      } else if (beaten_ || (in_state_s_ >= params_.search_after_s && driven_in_state_m_ >= params_.search_after_m)) {
        start(LocalizerState::kGlobal);
      }
      break;
  }
  return state_;
}

bool FitMonitor::suspicious() const {
  return state_ == LocalizerState::kTracking && (mean_fit_ < params_.suspicious_below || distrusted_s_ > 0.0);
}

}  // namespace deltamap::localization::belief
