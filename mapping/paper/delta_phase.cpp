// SPDX-License-Identifier: Apache-2.0
// Why scans are kept by chance: the more the scans contradict the map, the more of them a new map needs, and r_d as
// the probability thins out the rest. A low N_eff means a poor pose, and such a scan would bend the local map.
#include "mapping/paper/delta_phase.hpp"

#include <utility>

#include "mapping/scan_set/kept_scan.hpp"

namespace deltamap::mapping::paper {
namespace {

ScanSet empty_set(std::uint32_t phase) {
  ScanSet set;
  set.phase = phase;
  set.method = MappingMethod::kPaper;
  return set;
}

}  // namespace

bool DeltaPhase::is_worth_keeping(const TrackedScan& tracked, double r_d) {
  const double v = random_.uniform();  // drawn for every scan of the phase, so that the gates do not shift the sequence
  const Estimate& estimate = tracked.estimate;
  return v < r_d && set_.scans.size() < params_.most_scans &&
         estimate.n_eff >= params_.least_n_eff_share * static_cast<double>(estimate.particles);
}

std::optional<ScanSet> DeltaPhase::close(Timestamp time) {
  open_ = false;
  ScanSet finished = std::exchange(set_, empty_set(set_.phase));
  if (finished.scans.empty()) return std::nullopt;
  finished.ended = time;
  return finished;
}

void DeltaPhase::abandon() {
  open_ = false;
  set_ = empty_set(set_.phase);
}

std::optional<ScanSet> DeltaPhase::observe(const TrackedScan& tracked) {
  const double r_d = tracked.weights.divergence_ratio();
  const Timestamp time = tracked.scan.time;
  if (open_ && !set_.scans.empty() && set_.scans.back()->odometry_epoch != tracked.odometry_epoch) return close(time);
  if (tracked.estimate.state != LocalizerState::kTracking) {
    if (open_) abandon();
    return std::nullopt;
  }
  if (open_ && r_d < 0.0) return close(time);
  if (!open_ && r_d > 0.0) {
    open_ = true;
    set_ = empty_set(set_.phase + 1);
    set_.began = time;
  }
  if (open_ && is_worth_keeping(tracked, r_d)) {
    set_.scans.push_back(scan_set::kept_scan(tracked));
  }
  return std::nullopt;
}

}  // namespace deltamap::mapping::paper
