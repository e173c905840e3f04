// SPDX-License-Identifier: Apache-2.0
// The usual share of outliers at the believed pose: beams that the map does not explain. Where one beam in five is an
// outlier anyway, a few more say little against the pose; where all beams fit, three do.
#pragma once

namespace deltamap::localization::hypotheses {

class OutlierRate {
 public:
  /// Share of outliers of a decorrelated scan at the believed pose, [0, 1].
  void observe(double outliers);
  void forget() { *this = {}; }

  /// What a beam that misses here and ends as expected elsewhere tells, of what it does where hardly any beam misses:
  /// the log odds of a beam that fits against one that does not. [0, 1]
  [[nodiscard]] double evidence_weight() const;

 private:
  static constexpr double kRare = 0.05;  // a share up to which all beams count as fitting

  double share_ = kRare;
  double scans_ = 0.0;
};

}  // namespace deltamap::localization::hypotheses
