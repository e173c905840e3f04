// SPDX-License-Identifier: Apache-2.0
// How soon a map follows the changes of the world that the robot can see: each change's fate, from its first beam on.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "simulation/score/change_watch.hpp"

namespace deltamap::experiments {

class ChangeFollowing {
 public:
  /// Looks at all changes that have not been followed yet. `surfaces`: all that stands now. What the map has right when
  /// it first comes into view is nothing to follow; with `without`, what that one (judged just before) had right then:
  /// its map knows nothing of what this one has got by the first look.
  void judge(simulation::score::ChangeWatch& changes, const OccupancyGrid& map, const OccupancyGrid& surfaces,
             double now_s, const ChangeFollowing* without = nullptr);

  /// Of the changes that were in view for 10 s; not found counts as infinite.
  struct Numbers {
    std::size_t seen = 0;
    std::size_t found = 0;
    double recall = 0.0;  ///< NaN where none was seen
    double median_s = 0.0;
    double p90_s = 0.0;
    double clock_median_s = 0.0;  ///< since it was first in view
    double within_10s = 0.0;      ///< share that was followed within 10 s in view; NaN where none was seen
  };
  enum class Which : std::uint8_t { kAll, kAppeared, kDisappeared };
  [[nodiscard]] Numbers numbers(simulation::score::ChangeWatch& changes, Which which = Which::kAll) const;

 private:
  struct Fate {
    double followed_after_s = -1.0;       ///< seconds in view until the map had followed; negative: not yet
    double followed_after_clock_s = 0.0;  ///< since it was first in view
    double first_seen_s = -1.0;
    bool is_settled = false;  ///< overtaken, or not to be counted
    bool was_right = false;   ///< the map had it right when it first came into view: nothing to follow
  };
  std::vector<Fate> fates_;  // by number of the change
};

}  // namespace deltamap::experiments
