// SPDX-License-Identifier: Apache-2.0
// At which speeds a laser is looked for (protocols.md B6, B8): one after the other at the start; later, once it has
// fallen silent, in short visits.
#pragma once

#include <string>
#include <vector>

namespace deltamap::drivers::lms200 {

/// All that the laser knows, in the order of trying.
[[nodiscard]] std::vector<unsigned> baud_search(unsigned first);

/// Where a silent laser is visited: every other time at the baud where it should be (home), most of the others at 9600,
/// where it is after a power cut. Garbage means that somebody speaks at another baud, most likely a laser that has
/// started up: a detour to 9600 follows, which is no visit of the plan.
class VisitPlan {
 public:
  explicit VisitPlan(unsigned home, bool was_garbage = false);

  [[nodiscard]] unsigned baud() const;
  /// A visit during which nobody has spoken is over. Home is left only after a long silence or for garbage.
  void advance(bool was_garbage, bool is_long_silent);

  /// Of all that are visited, home first.
  [[nodiscard]] std::string names() const;

 private:
  [[nodiscard]] unsigned home() const { return bauds_.front(); }

  std::vector<unsigned> bauds_;
  unsigned visits_ = 0;
  bool is_detour_ = false;
};

}  // namespace deltamap::drivers::lms200
