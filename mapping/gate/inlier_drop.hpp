// SPDX-License-Identifier: Apache-2.0
// Tells whether fewer beams end where the map expects them than before a moment that it was told to remember: whether
// the map fits worse since then.
#pragma once

#include <optional>

#include "core/messages.hpp"

namespace deltamap::mapping::gate {

struct InlierDropParams {
  double usual_s = 10.0;          ///< over which the usual share of fitting beams is averaged, s; > 0
  double present_s = 0.35;        ///< over which the present one is, s; > 0
  double most_of_a_scan_s = 0.5;  ///< that a scan after a silence counts, s: more would swallow what was before; > 0
  double most_drop = 0.2;         ///< of the share of beams; [0, 1]
  std::uint32_t least_expected = 30;  ///< a scan in which the map expects fewer beams to end says nothing
};

class InlierDropDetector {
 public:
  explicit InlierDropDetector(const InlierDropParams& params) : params_{params} {}

  /// Every scan in order. Shares are averaged over time: what the last checked scan has told holds until the next one.
  void observe(const TrackedScan& tracked);

  /// What is usual now is what has to come back; nothing where that is not known yet: a moment is no usual view.
  void remember() {
    if (known_for_s_ >= params_.usual_s) remembered_ = usual_;
  }
  void forget() { remembered_.reset(); }
  /// Do fewer beams fit than was usual when it was remembered, by more than most_drop?
  [[nodiscard]] bool is_worse_than_remembered() const;

 private:
  InlierDropParams params_;
  std::optional<Timestamp> last_;
  double known_for_s_ = 0.0;
  double usual_ = 0.0;    // share of the beams that do not fit,
  double present_ = 0.0;  // and now
  std::optional<double> remembered_;
};

}  // namespace deltamap::mapping::gate
