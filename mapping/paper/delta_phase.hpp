// SPDX-License-Identifier: Apache-2.0
// Store-scan as the paper has it (§3.2): a Δ-phase begins when r_d turns positive and ends when it falls below zero. In
// between a scan is kept with the probability r_d, unless N_eff says that the pose is poor (§3.2.1). The paper supposes
// a robot that knows where it is: a phase in which the localizer loses its way is abandoned.
#pragma once

#include <cstdint>
#include <optional>

#include "core/messages.hpp"
#include "core/random.hpp"

namespace deltamap::mapping::paper {

struct DeltaPhaseParams {
  double least_n_eff_share = 0.3;  ///< N_eff / particles (Eq. 5) below which a scan is not kept; [0, 1]
  std::uint32_t most_scans = 400;  ///< kept in one phase; what comes later is not kept (memory); > 0
};

class DeltaPhase {
 public:
  DeltaPhase(const DeltaPhaseParams& params, std::uint64_t seed) : params_{params}, random_{seed} {}

  /// An answer is the S(k) of a phase that has just ended with at least one scan kept.
  [[nodiscard]] std::optional<ScanSet> observe(const TrackedScan& tracked);

  [[nodiscard]] bool is_open() const { return open_; }
  [[nodiscard]] std::uint32_t number() const { return set_.phase; }
  [[nodiscard]] const KeptScans& kept_scans() const { return set_.scans; }  ///< of the present phase
  [[nodiscard]] std::uint32_t kept() const { return static_cast<std::uint32_t>(set_.scans.size()); }

 private:
  [[nodiscard]] bool is_worth_keeping(const TrackedScan& tracked, double r_d);
  [[nodiscard]] std::optional<ScanSet> close(Timestamp time);
  void abandon();

  DeltaPhaseParams params_;
  Random random_;
  bool open_ = false;
  ScanSet set_;
};

}  // namespace deltamap::mapping::paper
