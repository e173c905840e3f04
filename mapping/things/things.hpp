// SPDX-License-Identifier: Apache-2.0
// Turns the revisions of a map into things: cells that have come or gone are grouped into bodies, which are followed
// from revision to revision, so that one change of the world is one thing, told once and updated. The state is a
// function of the revisions in their order; scans between them only take back what is assumed of a thing. Costs what a
// revision changes; memory is bounded.
#pragma once

#include <cstdint>
#include <list>
#include <vector>

#include "mapping/things/body.hpp"

namespace deltamap::mapping::things {

/// A thing as it is after a revision that told something of it.
struct ThingEvent {
  Thing thing;
  std::uint32_t revision = 0;
  Timestamp time;
  bool is_new = false;  ///< first told, told to be of another kind than before, or moved on; else an update
};

class Things {
 public:
  explicit Things(const ThingsParams& params = {}) : params_{params} {}

  /// In the order of the bodies' beginnings. The revisions must come in order and be of one geometry.
  std::vector<ThingEvent> take(const ChangedMap& step);

  /// A scan whose pose holds, between revisions: what it takes back of what was assumed. The same scans must come at
  /// the same place among the revisions.
  std::vector<ThingEvent> look(const TrackedScan& tracked);

  /// Every thing that was told, in the order of their ids.
  [[nodiscard]] std::vector<Thing> all() const;
  /// What sets the cells of a thing, as far as they are followed, back to what they were before it: those of `map` that
  /// differ. Empty where there is no such thing, or nothing is left of it.
  [[nodiscard]] std::vector<CellChange> undoing(std::uint32_t id, const OccupancyGrid& map) const;
  /// Cells that became occupied or ceased to be, and belong to no thing: corrections of surfaces, cells that flicker.
  [[nodiscard]] std::uint64_t corrections() const { return corrections_; }
  /// Things that are no longer listed.
  [[nodiscard]] std::uint64_t forgotten() const { return forgotten_; }
  /// What the cells of the bodies that are followed take up.
  [[nodiscard]] std::size_t cell_bytes() const;

 private:
  struct Step;
  using Cells = std::vector<CellChange>;

  /// The changes that no standing body loses.
  [[nodiscard]] Cells restored(const Step& step);
  void add_surfaces(const Step& step, const Cells& changes, Side side);
  /// Surfaces that come into view where bodies have gone are their neighbours'.
  void note_shown(const Step& step);
  void add_insides(const GridGeometry& geometry, const Cells& changes, Side side);
  [[nodiscard]] std::size_t cells_it_grows_by(const Body& body, const Step& step, const Cells& cluster,
                                              Side side) const;
  /// The body that a cluster belongs to; bodies that it joins become one. Null: to none that is followed.
  [[nodiscard]] Body* body_of(const Step& step, const Cells& cluster, Side side);
  /// Another body's surface has come within the outline.
  [[nodiscard]] bool is_taken_by_another(const Body& body, const Outline& at, const OccupancyGrid& map) const;
  [[nodiscard]] std::vector<ThingEvent> told(const Step& step);
  /// Faces of one body that were seen one after the other.
  void join_faces(const ChangedMap& now);
  /// What has gone here and come there.
  void join_moves();
  /// What has come on one side of a body and gone on the other.
  void join_pushes(const OccupancyGrid& map);
  /// The thing that is told of by both: from here to there, or gone from where it stood. Null: there is none.
  [[nodiscard]] Body* other_part_of(const Body& body);
  /// Of two bodies that are one the one that was told first, else that began first, takes the other in.
  Body& unite(Body& one, Body& other);
  /// A single face where others came and went before: glass, or a pose that is a little off.
  [[nodiscard]] bool only_flickers(const Body& body) const;
  void drop_tentative(const Step& step);
  void stay_within_bounds();

  ThingsParams params_;
  std::list<Body> bodies_;     // in the order in which they began
  std::vector<Thing> joined_;  // by the revision that is being taken, after they had been told
  std::uint32_t newest_id_ = 0;
  std::uint32_t newest_revision_ = 0;
  std::uint64_t corrections_ = 0;
  std::uint64_t forgotten_ = 0;
};

}  // namespace deltamap::mapping::things
