// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/provisional_window.hpp"

#include <algorithm>

namespace deltamap::mapping::gate {
namespace {

constexpr double kMilestone_m = 0.1;
constexpr double kMilestone_s = 0.25;

/// The oldest milestone is the newest that lies `wanted` or more back.
template <typename Milestones>
void add(Milestones& milestones, double passed, Timestamp now, double step, double wanted) {
  if (milestones.empty() || passed >= milestones.back().passed + step) {
    milestones.push_back({passed, now});
  } else {
    milestones.back().left = now;
  }
  while (milestones.size() > 1 && passed - milestones[1].passed >= wanted) milestones.pop_front();
}

}  // namespace

void ProvisionalWindow::observe(Timestamp now, double passed_s, double driven_m) {
  passed_s_ += passed_s;
  driven_m_ += driven_m;
  add(way_, driven_m_, now, kMilestone_m, params_.way_m);
  add(time_, passed_s_, now, kMilestone_s, params_.time_s);
}

std::optional<Timestamp> ProvisionalWindow::settled() const {
  if (way_.empty() || driven_m_ - way_.front().passed < params_.way_m ||
      passed_s_ - time_.front().passed < params_.time_s) {
    return std::nullopt;
  }
  return std::min(way_.front().left, time_.front().left);
}

}  // namespace deltamap::mapping::gate
