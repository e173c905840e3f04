// SPDX-License-Identifier: Apache-2.0
// Detects that the share of inliers has suddenly fallen: fewer beams end where the map expects them than over the last
// seconds. Either something has changed in view or the robot is elsewhere; P(pose right) needs seconds to tell which.
#pragma once

#include <optional>

#include "core/messages.hpp"

namespace deltamap::mapping::gate {

struct InlierDropParams {
  double usual_s = 10.0;              ///< over which the usual share of fitting beams is averaged, s; > 0
  double lately_s = 1.0;              ///< over which that of the last moment is, s; > 0
  double present_s = 0.35;            ///< over which the present one is, s; > 0
  double most_drop = 0.2;             ///< of the share of beams; [0, 1]
  double most_drop_both_ways = 0.1;   ///< of beams too short and of beams too long, each: what a thing that comes or
                                      ///< goes does not do; [0, 1]
  double least_at_once = 0.03;        ///< of both within a moment: two things in turn are no other view; [0, 1]
  std::uint32_t least_expected = 30;  ///< a scan in which the map expects fewer beams to end says nothing
};

class InlierDropDetector {
 public:
  explicit InlierDropDetector(const InlierDropParams& params) : params_{params} {}

  /// Every scan in order. Shares are averaged over time: what the last checked scan has told holds until the next one.
  void observe(const TrackedScan& tracked);
  /// The map has fitted well, and now fewer beams do.
  [[nodiscard]] bool is_sudden() const;
  /// And more than usual are too short, and more too long, at once: as if the whole view were another one.
  [[nodiscard]] bool is_both_ways() const;

  /// What is usual now is what has to come back; nothing where that is not known yet: a moment is no usual view.
  void remember() {
    if (known_for_s_ >= params_.usual_s) remembered_ = usual_;
  }
  void forget() { remembered_.reset(); }
  /// Fewer beams fit than usual before it was remembered, and than without that share of them.
  [[nodiscard]] bool is_worse_than_remembered(double explained) const;

 private:
  struct Shares {
    double short_of = 0.0;
    double beyond = 0.0;
  };
  InlierDropParams params_;
  std::optional<Timestamp> last_;
  double known_for_s_ = 0.0;
  Shares usual_;
  Shares lately_;
  Shares present_;
  std::optional<Shares> remembered_;
};

}  // namespace deltamap::mapping::gate
