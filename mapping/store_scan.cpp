// SPDX-License-Identifier: Apache-2.0
#include "mapping/store_scan.hpp"

#include "mapping/scan_set/waiting_scans.hpp"

namespace deltamap::mapping {
namespace {

constexpr std::uint32_t kMostWaiting = 240;  // a minute's; 2 MB
constexpr int kLateAtOnce = 3;               // keyframes a scan, so that no scan costs much more than others

}  // namespace

struct StoreScan::State {
  State(const StoreScanParams& params, std::uint64_t seed, bool inherits)
      : method{params.method},
        paper{params.delta_phase, seed},
        evidence{params.evidence},
        gate{params.gate, inherits},
        waiting{params.evidence.keyframes, kMostWaiting} {}

  /// Where the gate is shut a keyframe waits, unless the pose may be wrong by then; once it is open again, those that
  /// wait vote first.
  std::optional<MapRequest> gated_request(const TrackedScan& tracked) {
    gate.observe(tracked);
    if (gate.gate().has_proven_wrong()) {
      waiting.clear();
      evidence.transients().clear();
    }
    if (!gate.lets_vote()) {
      if (gate.waits_to_vote(tracked.estimate)) waiting.keep(tracked);
      evidence.transients().hide(tracked.scan.time);
    } else if (waiting.empty()) {
      gate.take(evidence.observe(tracked), tracked);
    } else {
      waiting.keep(tracked);
      for (int i = 0; i < kLateAtOnce; ++i) {
        const std::optional<TrackedScan> late = waiting.next(tracked.estimate);
        if (late) gate.take(evidence.observe(*late), *late);
      }
    }
    return gate.next();
  }

  MappingMethod method;
  paper::DeltaPhase paper;
  evidence::EvidencePhase evidence;
  gate::GatedSets gate;
  scan_set::WaitingScans waiting;
  Awareness awareness;
  bool pose_holds = false;
};

StoreScan::StoreScan(const StoreScanParams& params, std::uint64_t seed, bool inherits)
    : state_{std::make_unique<State>(params, seed, inherits)} {}
StoreScan::~StoreScan() = default;
StoreScan::StoreScan(StoreScan&&) noexcept = default;
StoreScan& StoreScan::operator=(StoreScan&&) noexcept = default;

void StoreScan::set_zones(const Zones& zones) {
  state_->evidence.leave_unwritten(ZonedGround{zones, {ZoneKind::kFrozen, ZoneKind::kTemporary}});
}

bool StoreScan::pose_holds() const { return state_->pose_holds; }

const Awareness& StoreScan::awareness() const { return state_->awareness; }

StoredScans StoreScan::stored() const {
  const State& s = *state_;
  if (s.method == MappingMethod::kPaper) return {.collected = s.paper.kept_scans(), .waiting = {}};
  StoredScans stored{.collected = s.evidence.scans_of_waiting(), .waiting = {}};
  for (const ScanSet& set : s.gate.waiting()) {
    stored.waiting.insert(stored.waiting.end(), set.scans.begin(), set.scans.end());
  }
  return stored;
}

const std::shared_ptr<const TransientObstacles>& StoreScan::transients() const {
  return state_->evidence.transients().newest();
}

std::optional<MapRequest> StoreScan::observe(const TrackedScan& tracked) {
  State& s = *state_;
  std::optional<MapRequest> request;
  if (s.method == MappingMethod::kPaper) {
    if (std::optional<ScanSet> set = s.paper.observe(tracked)) {
      set->covariance = tracked.estimate.covariance;
      request = *std::move(set);
    }
    s.pose_holds =
        tracked.estimate.state == LocalizerState::kTracking && tracked.estimate.belief.verdict != PoseVerdict::kWrong;
    s.awareness.in_phase = s.paper.is_open();
    s.awareness.phase = s.paper.number();
    s.awareness.stored_scans = s.paper.kept();
  } else {
    request = s.gated_request(tracked);
    s.pose_holds = s.gate.lets_vote();
    s.awareness.in_phase = s.evidence.waiting() > 0;
    s.awareness.phase = s.evidence.number();
    s.awareness.short_beams = s.evidence.short_beams();
    s.awareness.through_beams = s.evidence.through_beams();
  }
  s.awareness.gate = s.gate.gate().reason();
  s.awareness.gate_confirms_after = s.gate.gate().confirms_after();
  s.awareness.gate_shut_for_s = s.gate.gate().shut_for_s();
  s.awareness.gate_times = s.gate.gate().times();
  return request;
}

}  // namespace deltamap::mapping
