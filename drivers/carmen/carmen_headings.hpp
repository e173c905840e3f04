// SPDX-License-Identifier: Apache-2.0
// Whether the headings of a log are degrees, where CARMEN has radians: a robot drives where it looks, so that its way
// tells which of both they are.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/geometry/pose2.hpp"
#include "drivers/carmen/carmen_line.hpp"

namespace deltamap::drivers::carmen {

class HeadingCensus {
 public:
  /// The robot's next pose, with its heading as it stands in the log.
  void add(std::size_t line, const Point2& place, double heading);

  /// The poses have driven far enough for their way to tell.
  [[nodiscard]] bool has_way() const;
  [[nodiscard]] HeadingUnit unit() const;
  /// One line where the headings are degrees, or may be; else "".
  [[nodiscard]] std::string line() const;

 private:
  struct Told {
    Point2 place{0.0, 0.0};
    double heading = 0.0;
  };
  void add_way(const Told& now);
  void add_turn(const Told& now);
  [[nodiscard]] bool lies_along_degrees() const;
  [[nodiscard]] double mean(double sum) const { return sum / static_cast<double>(ways_); }

  std::optional<Told> way_began_;
  std::optional<Told> last_;
  std::size_t ways_ = 0;             // pieces of way long enough to have a direction,
  double along_as_radians_ = 0.0;    // and how well it lies along the heading: sum of cos 2(direction - heading),
  double across_as_radians_ = 0.0;   // of the sine,
  double along_as_degrees_ = 0.0;    // and of the cosine, were they degrees
  std::size_t more_than_turns_ = 0;  // from one pose to the next, were they radians
  double largest_ = 0.0;
  std::size_t first_line_ = 0;
  std::optional<std::size_t> first_beyond_line_;  // a turn
};

}  // namespace deltamap::drivers::carmen
