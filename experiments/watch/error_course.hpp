// SPDX-License-Identifier: Apache-2.0
// How far the pose was off at every scan of a drive, and at any moment of it.
#pragma once

#include <algorithm>
#include <vector>

#include "core/time.hpp"

namespace deltamap::experiments {

class ErrorCourse {
 public:
  /// In order of time.
  void add(Timestamp time, double error_m) {
    times_.push_back(time);
    errors_m_.push_back(error_m);
  }
  /// Of the newest scan that is not newer; 0 before the first.
  [[nodiscard]] double at_m(Timestamp time) const {
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    return after == times_.begin() ? 0.0 : errors_m_[static_cast<std::size_t>(after - times_.begin()) - 1];
  }
  /// A scan each.
  [[nodiscard]] const std::vector<double>& all_m() const { return errors_m_; }

 private:
  std::vector<Timestamp> times_;
  std::vector<double> errors_m_;
};

}  // namespace deltamap::experiments
