// SPDX-License-Identifier: Apache-2.0
// The rhythm of what a device sends again and again, and where it falls out of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace deltamap::tool {

struct Silence {
  double after_s = 0.0;  ///< the first record: when it began
  double length_s = 0.0;
};

class Rhythm {
 public:
  /// When the next one came, in seconds after the first record.
  void add(double after_s) { times_s_.push_back(after_s); }

  [[nodiscard]] std::uint64_t count() const { return times_s_.size(); }
  /// The usual interval: the median. 0 where there are fewer than two.
  [[nodiscard]] double period_s() const {
    std::vector<double> intervals_s;
    for (std::size_t i = 1; i < times_s_.size(); ++i) intervals_s.push_back(times_s_[i] - times_s_[i - 1]);
    if (intervals_s.empty()) return 0.0;
    const auto middle = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 2);
    std::nth_element(intervals_s.begin(), middle, intervals_s.end());
    return std::max(0.0, *middle);
  }
  /// How many would have filled the intervals that are longer than one and a half periods; silences are not filled.
  [[nodiscard]] std::uint64_t missing() const {
    const double usual_s = period_s();
    double missing = 0.0;
    for (std::size_t i = 1; i < times_s_.size() && usual_s > 0.0; ++i) {
      const double interval_s = times_s_[i] - times_s_[i - 1];
      const bool is_hole = interval_s > 1.5 * usual_s && interval_s <= longest_s(usual_s);
      if (is_hole) missing += std::round(interval_s / usual_s) - 1.0;
    }
    return static_cast<std::uint64_t>(missing);
  }
  /// Intervals of more than a second and five periods.
  [[nodiscard]] std::vector<Silence> silences() const {
    const double bound_s = longest_s(period_s());
    std::vector<Silence> found;
    for (std::size_t i = 1; i < times_s_.size(); ++i) {
      const double interval_s = times_s_[i] - times_s_[i - 1];
      if (interval_s > bound_s) found.push_back({times_s_[i - 1], interval_s});
    }
    return found;
  }

 private:
  [[nodiscard]] static double longest_s(double period_s) { return std::max(1.0, 5.0 * period_s); }

  std::vector<double> times_s_;
};

}  // namespace deltamap::tool
