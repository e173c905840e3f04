// SPDX-License-Identifier: Apache-2.0
// How many beams the map does not explain at the believed pose anyway. Where that is one in five, some more say little
// against the pose; where all fit, three do.
#pragma once

namespace deltamap::localization::hypotheses {

class UsualMisfit {
 public:
  /// Share of a decorrelated scan's beams that the map does not explain at the believed pose.
  void observe(double misfit);
  void forget() { *this = {}; }

  /// What a beam that misses here and ends as expected elsewhere tells, of what it does where hardly any beam misses:
  /// the log odds of a beam that fits against one that does not. [0, 1]
  [[nodiscard]] double telling() const;

 private:
  static constexpr double kRare = 0.05;  // a share up to which all beams count as fitting

  double share_ = kRare;
  double scans_ = 0.0;
};

}  // namespace deltamap::localization::hypotheses
