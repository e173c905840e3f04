// SPDX-License-Identifier: Apache-2.0
// Have the ranges the map's scale? Scans that are all some percent too short fit nowhere, or here and there: a laser
// with another unit, or a map with another resolution than its picture has. Now and then a scan is made longer or
// shorter and looked for about the believed pose; a factor by which scan after scan explains clearly more is named.
// Once one is, or the ranges have proven right, nothing is looked for any more.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"

namespace deltamap::localization::sensor {

/// What explains clearly more: ranges times `factor`.
struct OtherScale {
  double factor = 1.0;
  double explained = 0.0;        ///< share of the ends, mean over scans, with that factor
  double explained_as_is = 0.0;  ///< and of the same scans without
};

class RangeScale {
 public:
  /// After each scan; `driven_m`: since the one before. `robot_from_laser`: where ranges are measured from.
  void observe(const LikelihoodField& field, const motion::BeamEnds& ends, const Point2& robot_from_laser,
               const Pose2& map_from_robot, double driven_m);
  [[nodiscard]] std::optional<OtherScale> shown() const;
  /// Further scans are not looked at.
  [[nodiscard]] bool is_settled() const { return is_settled_; }

  static constexpr std::array<double, 6> kFactors{0.8, 0.9, 0.95, 1.05, 1.1, 1.25};

 private:
  /// Each factor has been tried on many scans, which the ranges as they are explain.
  [[nodiscard]] bool has_proven_right() const;
  /// Of the scans that one factor was tried on.
  struct Tried {
    int scans = 0;
    double explained = 0.0;  // sums
    double explained_as_is = 0.0;
  };
  std::array<Tried, kFactors.size()> tried_{};
  std::size_t next_ = 0;
  double since_tried_m_ = 0.0;
  bool is_settled_ = false;
};

}  // namespace deltamap::localization::sensor
