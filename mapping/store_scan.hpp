// SPDX-License-Identifier: Apache-2.0
// Front door 1 of mapping: TrackedScan in, S(k) out when a Δ-phase ends (paper §3.1–3.2). Two methods behind one door:
// `paper` closes a phase when r_d falls below zero, `evidence` when a region has proven persistently different. With
// evidence the write gate stands before the phase: scans of a doubtful pose do not vote.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/messages.hpp"
#include "core/transient_obstacles.hpp"
#include "core/zones.hpp"
#include "mapping/evidence/evidence_phase.hpp"
#include "mapping/gate/gated_sets.hpp"
#include "mapping/paper/delta_phase.hpp"

namespace deltamap::mapping {

struct StoreScanParams {
  MappingMethod method = MappingMethod::kEvidence;
  paper::DeltaPhaseParams delta_phase{};     ///< paper
  evidence::EvidencePhaseParams evidence{};  ///< evidence
  gate::WriteGateParams gate{};              ///< evidence: when the pose is sure enough to write by
};

/// What Δ-awareness thought of the last scan, for telemetry.
struct Awareness {
  bool in_phase = false;
  std::uint32_t phase = 0;          ///< number of the present or last Δ-phase
  std::uint32_t stored_scans = 0;   ///< in the present phase
  std::uint32_t short_beams = 0;    ///< evidence: beams of this scan that ended before the map says
  std::uint32_t through_beams = 0;  ///< evidence: beams of this scan that went through what the map says
  gate::GateReason gate = gate::GateReason::kOpen;
  gate::GateReason gate_confirms_after = gate::GateReason::kOpen;  ///< kOpen: nothing has to be confirmed
  double gate_shut_for_s = 0.0;                                    ///< since it was open last
  gate::GateTimes gate_times{};
};

/// Scans that are kept for a map update: to be looked at.
struct StoredScans {
  KeptScans collected;  ///< of the present Δ-phase
  KeptScans waiting;    ///< of finished sets that are held back
  bool operator==(const StoredScans&) const = default;
};

class StoreScan {
 public:
  /// `inherits`: the run before has left revisions that are still provisional.
  StoreScan(const StoreScanParams& params, std::uint64_t seed, bool inherits = false);
  ~StoreScan();
  StoreScan(StoreScan&&) noexcept;
  StoreScan& operator=(StoreScan&&) noexcept;

  /// Every tracked scan in order. An answer is a finished S(k), to be handed to map_update(); or, where the scan has
  /// proven the pose wrong, an order to take back what was written by it; or word that nothing is provisional any more.
  [[nodiscard]] std::optional<MapRequest> observe(const TrackedScan& tracked);

  [[nodiscard]] const Awareness& awareness() const;
  /// From the next scan on: what differs within frozen and temporary zones is transient (evidence).
  void set_zones(const Zones& zones);
  /// The newest scan's pose is sure enough to judge by what it saw.
  [[nodiscard]] bool pose_holds() const;
  [[nodiscard]] StoredScans stored() const;
  /// What is different now and not map (evidence alone): the newest snapshot, another one only where something has
  /// changed. Null until there was something; empty while the pose is in doubt.
  [[nodiscard]] const std::shared_ptr<const TransientObstacles>& transients() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::mapping
