// SPDX-License-Identifier: Apache-2.0
// A body that is followed cell by cell: what came to stand here, what stood here and is gone, and what that makes of
// the thing that is told of it.
#pragma once

#include <cstdint>
#include <span>

#include "core/grid/grid_patch.hpp"
#include "core/messages.hpp"
#include "core/time.hpp"
#include "mapping/things/thing.hpp"
#include "mapping/things/thing_cells.hpp"

namespace deltamap::mapping::things {

struct ThingsParams {
  double least_size_m = 0.3;                ///< of a body's longer side; what is smaller is a correction, > 0
  int least_cells = 6;                      ///< of its surface, >= 1
  double gap_m = 0.15;                      ///< that is bridged between cells of one body, >= 0
  double told_step_m = 0.1;                 ///< change of place or size that is told as an update, > 0
  double same_size_m = 0.25;                ///< sides that differ by less are the same, > 0
  double one_look_s = 60.0;                 ///< what comes, goes and grows within it is seen in one look, > 0
  double tentative_s = 600.0;               ///< cells too few to be told are forgotten after that, > 0
  std::size_t most_cell_bytes = 1'000'000;  ///< of followed bodies; the longest quiet are followed no more
  bool assumes_sides = true;                ///< that nobody has seen, where those seen fix the rectangle
  std::size_t most_things = 2000;           ///< listed; the oldest of what has gone or was taken back are left out
};

/// One revision, as Things look at it.
struct ChangedMap {
  std::uint32_t number = 0;
  Timestamp time;
  const OccupancyGrid& map;             ///< M_k
  std::span<const CellChange> changes;  ///< from M_{k-1}
  bool takes_back = false;              ///< an undo, a rollback or a withdrawal: nothing new is said of the world
};

/// Between the middles of a body before and after it was moved, m; less is a correction of its place.
inline constexpr double kLeastShift_m = 0.15;

enum class Side : std::uint8_t { kCome, kGone };

struct Body {
  Thing thing;                      ///< id 0: not told yet
  ThingCells come;                  ///< what stands here and did not, and what that closes off
  ThingCells gone;                  ///< what stood here and does not, and the floor that this has shown
  ThingCells shown;                 ///< surfaces that came into view when it went: its neighbours', never its own
  std::size_t most_faces_come = 0;  ///< cells of its surface, at most so far
  std::size_t most_faces_gone = 0;
  std::size_t most_gone = 0;       ///< cells of `gone`, at most so far
  std::size_t written = 0;         ///< cells ever owned
  Timestamp began;                 ///< when it was first seen to have come, or to have gone
  Timestamp grown;                 ///< when its surface last grew, or it went
  std::optional<Thing> told;       ///< as it was told last; nothing: not yet
  bool is_touched = false;         ///< by the revision that is being taken
  bool has_grown = false;          ///< by the same
  bool has_returned = false;       ///< by the same, to where it was told to have left
  int looks_through = 0;           ///< scans with beams through what is assumed of it
  std::optional<Outline> freed{};  ///< the floor that what has gone has left; its outline may reach up to neighbours
  bool is_pushed = false;  ///< its outlines are those of a body that was pushed: what it has of cells are two strips
  bool is_pushed_back = false;   ///< and its front is none that it has come with
  bool is_contradicted = false;  ///< by them, or by a revision: nothing is assumed of it where it stands

  [[nodiscard]] ThingCells& cells(Side side) { return side == Side::kCome ? come : gone; }
  [[nodiscard]] const ThingCells& cells(Side side) const { return side == Side::kCome ? come : gone; }
  /// Where the cells of that side lie: where it stands, or stood.
  [[nodiscard]] const std::optional<Outline>& outline(Side side) const {
    if (side == Side::kGone && freed && thing.from) return freed;
    return side == Side::kCome ? thing.at : thing.from;
  }
};

/// Takes the cells into the body.
void own(Body& body, std::span<const CellChange> cells, Side side);

/// What the map now says of its outline, of what is assumed of that, and of its kind.
void judge(Body& body, const ChangedMap& step, const ThingsParams& params);

/// What has just left its place, and proves to stand deeper by less than its depth, was pushed back: its new front
/// shows how far, if that is no other body's. None: nothing shows.
[[nodiscard]] std::optional<Outline> pushed_back_to(const ChangedMap& step, const Body& body, double one_look_s);
void push_back(Body& body, const Outline& at, const OccupancyGrid& map);

/// It had come to where it was told to have left: gone, moved to where the map shows it no more, or pushed back.
[[nodiscard]] bool has_left(const Body& body, const OccupancyGrid& map);
/// Its leaving is taken back: it stands where it stood.
void stand_again(Body& body, const OccupancyGrid& map);

/// Cells within the outline at which the body's surface stands.
[[nodiscard]] std::size_t faces_within(const Body& body, const Outline& outline, const OccupancyGrid& map);

/// Where the revision finds cells free inside what is assumed of it, nothing is assumed of it any more while it stands.
void contradict_by(const ChangedMap& step, Body& body);
/// So do beams that go through it, of several scans. True: they have done so just now.
[[nodiscard]] bool look_at(Body& body, const TrackedScan& tracked);

/// Whether the surfaces of both are sides of one rectangle that is no larger than what they show of it: the front and a
/// side of one body, that were seen one after the other. Bodies beside each other are not.
[[nodiscard]] bool are_of_one(const Body& a, const Body& b, Side side, const OccupancyGrid& map, double one_look_s);

/// From the middle of what has gone the way to most of the places leads through what its going has shown, or they are
/// that: it ended before.
[[nodiscard]] bool is_beyond_shown(const Body& gone, std::span<const Point2> places, const GridGeometry& geometry);

/// All of its outline is certain: what lies beyond belongs to another body.
[[nodiscard]] bool is_whole(const Body& body, Side side, const OccupancyGrid& map);

/// Floor that it has left, and that was seen free, is covered by now: what stands there came later.
[[nodiscard]] bool is_taken(const Body& gone);

/// Whether it has enough of a surface to be told.
[[nodiscard]] bool is_tellable(const Body& body, const ThingsParams& params);

/// It was not told yet, is of another kind than was told, or was moved on from where it was told to stand.
[[nodiscard]] bool has_news(const Body& body);

/// What would be told differs from what was by more than the step.
[[nodiscard]] bool differs_from_told(const Body& body, double told_step_m);

}  // namespace deltamap::mapping::things
