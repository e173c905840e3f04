// SPDX-License-Identifier: Apache-2.0
#include "mapping/store_scan.hpp"

namespace deltamap::mapping {

struct StoreScan::State {
  State(const StoreScanParams& params, std::uint64_t seed)
      : method{params.method},
        ratio{params.divergence},
        paper{params.delta_phase, seed},
        evidence{params.evidence},
        gate{params.gate} {}

  MappingMethod method;
  awareness::DivergenceRatio ratio;
  awareness::DeltaPhase paper;
  awareness::EvidencePhase evidence;
  GatedSets gate;
  Awareness awareness;
};

StoreScan::StoreScan(const StoreScanParams& params, std::uint64_t seed)
    : state_{std::make_unique<State>(params, seed)} {}
StoreScan::~StoreScan() = default;
StoreScan::StoreScan(StoreScan&&) noexcept = default;
StoreScan& StoreScan::operator=(StoreScan&&) noexcept = default;

const Awareness& StoreScan::awareness() const { return state_->awareness; }

const std::shared_ptr<const TemporaryThings>& StoreScan::temporary() const {
  return state_->evidence.temporary().newest();
}

std::optional<ScanSet> StoreScan::observe(const TrackedScan& tracked) {
  State& s = *state_;
  // Averages hold the weights of a tracked pose alone: what a lost filter thinks of a scan says nothing about the map.
  if (tracked.estimate.state == LocalizerState::kTracking) (void)s.ratio.observe(tracked.estimate.w_avg);
  std::optional<ScanSet> set;
  if (s.method == MappingMethod::kPaper) {
    set = s.paper.observe(tracked, s.ratio.value());
    s.awareness.in_phase = s.paper.is_open();
    s.awareness.phase = s.paper.number();
    s.awareness.stored_scans = s.paper.kept();
  } else {
    s.gate.observe(tracked);
    if (s.gate.lets_vote()) {
      s.gate.take(s.evidence.observe(tracked), tracked);
    } else {
      s.evidence.temporary().hide(tracked.scan.time);
    }
    if (s.gate.gate().has_proven_wrong()) s.evidence.temporary().clear();
    set = s.gate.next();
    s.awareness.in_phase = s.evidence.waiting() > 0;
    s.awareness.phase = s.evidence.number();
    s.awareness.short_beams = s.evidence.short_beams();
    s.awareness.through_beams = s.evidence.through_beams();
  }
  if (set && s.method == MappingMethod::kPaper) set->covariance = tracked.estimate.covariance;
  s.awareness.w_fast = s.ratio.w_fast();
  s.awareness.w_slow = s.ratio.w_slow();
  s.awareness.r_d = s.ratio.value();
  s.awareness.gate = s.gate.gate().reason();
  s.awareness.gate_shut_for_s = s.gate.gate().shut_for_s();
  s.awareness.gate_times = s.gate.gate().times();
  return set;
}

}  // namespace deltamap::mapping
