// SPDX-License-Identifier: Apache-2.0
// The things that a run has told of, held against what the fork-lift did: how many events a change became, whether
// kind, place and size are right, and what was told that never happened.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapping/things/things.hpp"
#include "simulation/score/change_watch.hpp"

namespace deltamap::experiments {

/// One act of the fork-lift.
struct TrueChange {
  Timestamp time;
  simulation::ChangeKind kind = simulation::ChangeKind::kRemoved;
  std::optional<simulation::Box> from{};
  std::optional<simulation::Box> at{};
  /// Each of its places for long enough, and what they were before had been in view: who has not seen a container go
  /// cannot tell the next one on its floor from it.
  bool is_seen = false;
  /// Seen, and so was each face of each of its places that shows to the robot's floor at all.
  bool is_seen_all_around = false;
};

/// A removal, an addition, or both of a shift. `seen_least_s`: of the face that was seen longest; `face_least_s`: of
/// each.
[[nodiscard]] std::vector<TrueChange> true_changes(std::span<const simulation::score::Watched> watched,
                                                   double seen_least_s, double face_least_s);
/// As if those alone had been seen that were seen all around.
[[nodiscard]] std::vector<TrueChange> only_seen_all_around(std::span<const TrueChange> changes);

/// What was told of a thing until it was told to be of another kind, with how it was told at last.
struct Told {
  mapping::things::Thing thing;
  Timestamp time;  ///< when it was first told
};
/// Words that were taken back, or replaced by another kind within `one_look_s`, are left out.
[[nodiscard]] std::vector<Told> told_at_last(std::span<const mapping::things::ThingEvent> events, double one_look_s);

/// The newest act before that an event can be of; one that it tells rightly comes first. Null: there is none.
[[nodiscard]] const TrueChange* change_of(const Told& told, std::span<const TrueChange> changes);

struct ThingScore {
  std::size_t changes = 0;      ///< that were seen
  std::size_t unfound = 0;      ///< of those: no event
  std::size_t events = 0;       ///< of those
  std::size_t most_events = 0;  ///< of one of them
  std::size_t right = 0;        ///< of those: kind and place are right
  std::size_t right_size = 0;   ///< of those that are right: both sides within the tolerance
  std::size_t moved = 0;        ///< true shifts that were seen
  std::size_t moved_right = 0;  ///< told as moved
  std::size_t told = 0;         ///< events in all
  std::size_t wrong = 0;        ///< events that belong to no true change
  std::size_t told_moved = 0;   ///< events "moved"
  std::size_t wrong_pairs = 0;  ///< of those: no true shift
};

[[nodiscard]] ThingScore score_of(std::span<const Told> told, std::span<const TrueChange> changes);

struct AssumedScore {
  std::size_t sides = 0;    ///< that are assumed, of what stands there
  std::size_t right = 0;    ///< of those: the middle lies on a side of a box, within the tolerance
  std::size_t of_seen = 0;  ///< of those: of a thing whose four sides were seen
};

/// `boxes`: what truly stands there.
[[nodiscard]] AssumedScore assumed_score_of(std::span<const mapping::things::Thing> things,
                                            std::span<const simulation::Box> boxes);

}  // namespace deltamap::experiments
