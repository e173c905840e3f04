// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/grid/grid_ray.hpp"
#include "mapping/things/assumed.hpp"
#include "mapping/things/outline_fit.hpp"
#include "mapping/things/pushed.hpp"
#include "mapping/things/surface_along.hpp"

namespace deltamap::mapping::things {
namespace {

constexpr double kLeftShare = 0.4;    // fewer of its cells are left: it is no longer there
constexpr double kWholeShare = 0.75;  // fewer, and none new: its outline stays until it is clear what becomes of it
constexpr double kOtherShape_m = 0.3;
constexpr int kWholeSides = 3;  // seen: the rectangle is certain

constexpr double kFarthestPart_m = 3.5;  // between the middles of two faces of one body
constexpr double kInside_m = 0.3;
constexpr double kOnSidesShare = 0.85;  // of the surfaces of both, on the sides of one rectangle
constexpr double kLineGap_m = 0.5;      // between two pieces of one face
constexpr double kShownShare = 0.5;     // of the sum of two sides of a rectangle, by two of its faces

constexpr int kShownCells = 2;        // that stood when another had gone: more than a stray one
constexpr double kFaceTimes = 2.0;    // as long as a body a face must be: a shorter one is a leg, or an end of wrap
constexpr int kFreeInside = 4;        // cells that were found free: more than stray ones
constexpr int kLooksThrough = 2;      // scans: more than one at a pose that was a little off
constexpr double kClosedShare = 0.6;  // of the rectangle: its own cells, with those that it closes off

int sides_seen(const Outline& outline) {
  return static_cast<int>(std::count(outline.seen.begin(), outline.seen.end(), true));
}

/// The surface of another side goes on beyond one end of a side that was not seen: more of the body is still to go.
/// Beyond both ends there is a neighbour.
bool goes_on_beyond(const Body& gone, const Outline& outline, const OccupancyGrid& map) {
  const auto corner = corners(outline);
  const auto is_face = [&](const Point2& place) {
    const Cell cell = map.geometry().cell_at(place);
    return map.at(cell) == CellState::kOccupied && !gone.shown.before(cell);
  };
  for (std::size_t side = 0; side < corner.size(); ++side) {
    if (outline.seen[side]) continue;
    const Point2 along = map.resolution_m() * (corner[(side + 1) % 4] - corner[side]).normalized();
    const Point2 outward{along.y(), -along.x()};
    const auto goes_on = [&](const Point2& end, const Point2& inward) {
      return is_face(end + outward) || is_face(end + outward + inward);
    };
    if (goes_on(corner[side], along) != goes_on(corner[(side + 1) % 4], -along)) return true;
  }
  return false;
}

/// Of that outline: three sides are seen, or its inside is closed off.
bool is_whole(const Body& body, const Outline& outline, Side side, const OccupancyGrid& map) {
  if (outline.width_m < kOneFace_m) return false;
  const double cells = outline.length_m * outline.width_m / (map.resolution_m() * map.resolution_m());
  const bool is_closed = side == Side::kCome && static_cast<double>(body.come.count()) > kClosedShare * cells;
  if (is_closed) return true;
  if (sides_seen(outline) < kWholeSides) return false;
  return side == Side::kCome || !goes_on_beyond(body, outline, map);
}

BodyCells cells_of(const Body& body, Side side, const OccupancyGrid& map) {
  BodyCells cells;
  cells.resolution_m = map.resolution_m();
  body.cells(side).visit([&](Cell cell, CellState before) {
    const CellState now = map.at(cell);
    const Point2 centre = map.geometry().centre_of(cell);
    if (side == Side::kCome) {
      if (now == CellState::kOccupied) cells.faces.push_back(centre);
      if (now == CellState::kUnknown) cells.inside.push_back(centre);
    } else if (now == CellState::kFree) {
      (before == CellState::kOccupied ? cells.faces : cells.inside).push_back(centre);
    }
  });
  return cells;
}

/// Of the sides that were seen.
SurfaceAlong surface_on_seen_sides(const Outline& at, const OccupancyGrid& map) {
  const std::array<Point2, 4> ends = corners(at);
  SurfaceAlong sides;
  for (std::size_t side = 0; side < ends.size(); ++side) {
    if (!at.seen[side]) continue;
    const SurfaceAlong along = surface_along(map, ends[side], ends[(side + 1) % ends.size()]);
    sides.places += along.places;
    sides.all += along.all;
  }
  return sides;
}

bool is_same_size(const Outline& a, const Outline& b, double tolerance_m) {
  return std::abs(a.length_m - b.length_m) <= tolerance_m && std::abs(a.width_m - b.width_m) <= tolerance_m;
}

/// What a new outline of where it stands means beside the last one.
void stand_at(Body& body, const Outline& now, bool has_lost_much, const ThingsParams& params) {
  Thing& thing = body.thing;
  if (thing.at && body.told && has_lost_much && is_same_size(*thing.at, now, params.same_size_m) &&
      (thing.at->centre - now.centre).norm() > kLeastShift_m) {
    if (!thing.from) thing.from = thing.at;
    thing.kind = ThingKind::kMoved;
    body.is_contradicted = false;
  } else if (thing.at && body.told && has_lost_much && thing.kind == ThingKind::kAppeared &&
             sides_seen(*thing.at) >= kWholeSides && !is_same_size(*thing.at, now, kOtherShape_m)) {
    thing.kind = ThingKind::kChanged;
  }
  thing.at = now;
}

bool assumes(const Body& body) {
  return body.thing.at &&
         std::find(body.thing.at->assumed.begin(), body.thing.at->assumed.end(), true) != body.thing.at->assumed.end();
}

/// Cells within it that this revision has found free.
bool shows_free_inside(const Outline& outline, const ChangedMap& step) {
  const auto inside = std::count_if(step.changes.begin(), step.changes.end(), [&](const CellChange& change) {
    return change.after == CellState::kFree && is_deep_inside(outline, step.map.geometry().centre_of(change.cell));
  });
  return inside >= kFreeInside;
}

bool changes_within(const Outline& outline, const ChangedMap& step) {
  return std::any_of(step.changes.begin(), step.changes.end(), [&](const CellChange& change) {
    return is_inside(outline, step.map.geometry().centre_of(change.cell), 0.0);
  });
}

void forget_gone(Body& body) {
  body.gone.clear();
  body.shown.clear();
  body.most_faces_gone = body.most_gone = 0;
}

void leave(Body& body, const ChangedMap& step) {
  Thing& thing = body.thing;
  const bool never_was = body.is_pushed_back && body.come.empty();  // nothing is left of what it had come with
  const bool is_undone_move = step.takes_back && thing.kind == ThingKind::kMoved && thing.from && !never_was;
  thing.kind = step.takes_back && !is_undone_move ? ThingKind::kTakenBack : ThingKind::kGone;
  if (!is_undone_move) {
    thing.from = thing.at;
    body.freed.reset();
    forget_gone(body);
  }
  thing.at.reset();
  body.is_pushed = body.is_pushed_back = false;
  body.began = body.grown = step.time;
}

void judge_standing(Body& body, const ChangedMap& step, const ThingsParams& params) {
  const BodyCells cells = cells_of(body, Side::kCome, step.map);
  const std::size_t faces = body.is_pushed_back && body.thing.at
                                ? static_cast<std::size_t>(surface_on_seen_sides(*body.thing.at, step.map).places)
                                : cells.faces.size();
  const std::size_t most = std::max(body.most_faces_come, faces);
  body.most_faces_come = most;
  if (static_cast<double>(faces) < kLeftShare * static_cast<double>(most)) {
    if (!body.thing.at) return;
    if (body.told) return leave(body, step);
    body.thing.at.reset();
    return;
  }
  if (body.is_pushed) return;
  const bool is_whole = static_cast<double>(faces) >= kWholeShare * static_cast<double>(most);
  if (faces == 0 || (!is_whole && !body.has_grown && body.thing.at)) return;
  if (body.told && !body.thing.at) {
    if (!step.takes_back) return;  // what is left of it
    body.thing.kind = ThingKind::kAppeared;
    body.thing.from.reset();
  }
  const bool has_lost_much = static_cast<double>(body.come.count()) < 0.85 * static_cast<double>(body.written);
  stand_at(body, outline_of_come(cells), has_lost_much, params);
  if (params.assumes_sides && !body.is_contradicted)
    body.thing.at->assumed = assumed_sides(cells, *body.thing.at, step.map);
}

void judge_gone(Body& body, const ChangedMap& step) {
  if (body.is_pushed) return;
  const BodyCells cells = cells_of(body, Side::kGone, step.map);
  const std::size_t faces = cells.faces.size();
  const std::size_t most = std::max(body.most_faces_gone, faces);
  body.most_faces_gone = most;
  body.most_gone = std::max(body.most_gone, body.gone.count());
  const bool is_left = static_cast<double>(body.gone.count()) >= kLeftShare * static_cast<double>(body.most_gone);
  if (is_left && static_cast<double>(faces) >= kLeftShare * static_cast<double>(most) && faces > 0) {
    const bool is_whole = static_cast<double>(body.gone.count()) >= kWholeShare * static_cast<double>(body.most_gone);
    if (!is_whole && !body.has_grown && body.thing.from) return;  // another has taken some of its floor
    body.freed = outline_of_gone(cells, step.map);
    body.thing.from = up_to_neighbours(*body.freed, step.map);
    if (!body.thing.at) body.thing.kind = ThingKind::kGone;
    return;
  }
  if (step.takes_back && body.told) body.thing.kind = body.thing.at ? ThingKind::kAppeared : ThingKind::kTakenBack;
  if (!body.told || (step.takes_back && body.thing.at)) body.thing.from.reset();
  forget_gone(body);  // something else stands there by now
}

bool differ(const std::optional<Outline>& a, const std::optional<Outline>& b, double step_m) {
  if (!a || !b) return a.has_value() != b.has_value();
  return (a->centre - b->centre).norm() > step_m || std::abs(a->length_m - b->length_m) > step_m ||
         std::abs(a->width_m - b->width_m) > step_m || a->assumed != b->assumed;
}

}  // namespace

bool is_whole(const Body& body, Side side, const OccupancyGrid& map) {
  const auto& outline = body.outline(side);
  return outline && is_whole(body, *outline, side, map);
}

bool is_beyond_shown(const Body& gone, std::span<const Point2> places, const GridGeometry& geometry) {
  const auto& outline = gone.outline(Side::kGone);
  if (!outline || gone.shown.empty()) return false;
  int shown = 0;
  std::size_t beyond = 0;
  for (const Point2& place : places) {
    bool is_behind = false;
    walk_ray(geometry, outline->centre, place, [&](Cell cell, double) {
      is_behind = gone.shown.before(cell).has_value();
      return !is_behind;
    });
    shown += gone.shown.before(geometry.cell_at(place)) ? 1 : 0;
    beyond += is_behind ? 1 : 0;
  }
  return shown >= kShownCells || 2 * beyond > places.size();
}

bool are_of_one(const Body& a, const Body& b, Side side, const OccupancyGrid& map, double one_look_s) {
  const auto& one = a.outline(side);
  const auto& other = b.outline(side);
  if (!one || !other || (one->centre - other->centre).norm() > kFarthestPart_m) return false;
  const bool is_inside_other = is_inside(*one, other->centre, kInside_m) || is_inside(*other, one->centre, kInside_m);
  if ((is_whole(a, side, map) || is_whole(b, side, map)) && !is_inside_other) return false;
  BodyCells both = cells_of(a, side, map);
  const BodyCells more = cells_of(b, side, map);
  if (both.faces.empty() && more.faces.empty()) return false;  // they are no longer followed
  if ((both.faces.empty() || more.faces.empty()) && !is_inside_other) return false;
  if (side == Side::kGone &&
      (is_beyond_shown(a, more.faces, map.geometry()) || is_beyond_shown(b, both.faces, map.geometry())))
    return false;
  both.faces.insert(both.faces.end(), more.faces.begin(), more.faces.end());
  both.inside.insert(both.inside.end(), more.inside.begin(), more.inside.end());
  const Outline all = side == Side::kCome ? outline_of_come(both) : outline_of_gone(both, map);
  if (share_on_sides(both, all) < kOnSidesShare) return false;
  if (all.width_m < kOneFace_m) {
    const bool in_one_look = std::abs(seconds(a.grown - b.grown)) <= one_look_s;
    return in_one_look && all.length_m <= one->length_m + other->length_m + kLineGap_m;
  }
  return is_inside_other || one->length_m + other->length_m >= kShownShare * (all.length_m + all.width_m);
}

void own(Body& body, std::span<const CellChange> cells, Side side) {
  const std::size_t before = body.cells(side).count();
  for (const CellChange& change : cells) body.cells(side).own(change.cell, change.before);
  body.written += body.cells(side).count() - before;
  body.is_touched = true;
}

void judge(Body& body, const ChangedMap& step, const ThingsParams& params) {
  if (step.takes_back && !body.is_pushed_back && !body.has_returned) body.is_pushed = false;
  if (!body.come.empty() || body.thing.at) judge_standing(body, step, params);
  if (body.most_faces_gone > 0 || !body.gone.empty()) judge_gone(body, step);
  body.thing.last_seen = step.time;
  body.thing.confidence = body.written == 0 ? 0.0
                                            : static_cast<double>(body.come.count() + body.gone.count()) /
                                                  static_cast<double>(body.written);
  if (body.thing.revisions.empty() || body.thing.revisions.back() != step.number)
    body.thing.revisions.push_back(step.number);
  if (body.thing.revisions.size() > Thing::kMostRevisions) body.thing.revisions.erase(body.thing.revisions.begin());
}

std::optional<Outline> pushed_back_to(const ChangedMap& step, const Body& body, double one_look_s) {
  const Thing& thing = body.thing;
  const bool has_just_left = body.told && thing.kind == ThingKind::kGone && body.most_faces_come > 0 && thing.from &&
                             !thing.at && seconds(step.time - body.grown) <= one_look_s;
  if (!has_just_left || step.takes_back || !changes_within(*thing.from, step)) return std::nullopt;
  return pushed_back(*thing.from, step.map);
}

void push_back(Body& body, const Outline& at, const OccupancyGrid& map) {
  body.thing.at = at;
  body.thing.kind = ThingKind::kMoved;
  body.most_faces_come = static_cast<std::size_t>(surface_on_seen_sides(at, map).places);
  body.is_pushed = body.is_pushed_back = true;
  body.is_touched = true;
}

bool has_left(const Body& body, const OccupancyGrid& map) {
  const Thing& thing = body.thing;
  if (!thing.from || body.most_faces_come == 0) return false;
  if (thing.kind == ThingKind::kGone || body.is_pushed_back) return true;
  if (thing.kind != ThingKind::kMoved) return false;
  const SurfaceAlong sides = surface_on_seen_sides(*thing.at, map);
  return sides.places < kLeftShare * sides.all;
}

void stand_again(Body& body, const OccupancyGrid& map) {
  body.has_returned = true;
  if (!body.thing.at) return;  // judge() tells where
  body.most_faces_come = static_cast<std::size_t>(surface_on_seen_sides(*body.thing.from, map).all);
  body.thing.at = std::exchange(body.thing.from, std::nullopt);
  body.thing.kind = ThingKind::kAppeared;
  body.is_pushed_back = false;
}

std::size_t faces_within(const Body& body, const Outline& outline, const OccupancyGrid& map) {
  std::size_t faces = 0;
  body.come.visit([&](Cell cell, CellState) {
    const bool is_in = map.at(cell) == CellState::kOccupied && is_inside(outline, map.geometry().centre_of(cell), 0.0);
    faces += is_in ? 1 : 0;
  });
  return faces;
}

void contradict(Body& body) {
  body.thing.at->assumed = {};
  body.is_contradicted = true;
  body.is_touched = true;
}

void contradict_by(const ChangedMap& step, Body& body) {
  if (assumes(body) && !step.takes_back && shows_free_inside(*body.thing.at, step)) contradict(body);
}

bool look_at(Body& body, const TrackedScan& tracked) {
  if (!assumes(body) || !goes_through(tracked, *body.thing.at)) return false;
  if (++body.looks_through < kLooksThrough) return false;
  contradict(body);
  return true;
}

bool is_taken(const Body& gone) {
  return gone.gone.empty() ||
         static_cast<double>(gone.gone.count()) < kWholeShare * static_cast<double>(gone.most_gone);
}

bool is_tellable(const Body& body, const ThingsParams& params) {
  const auto is_enough = [&](const std::optional<Outline>& outline, std::size_t faces) {
    if (!outline || faces < static_cast<std::size_t>(params.least_cells)) return false;
    const double least_m = outline->width_m < kOneFace_m ? kFaceTimes * params.least_size_m : params.least_size_m;
    return outline->length_m >= least_m;
  };
  return is_enough(body.thing.at, body.most_faces_come) || is_enough(body.thing.from, body.most_faces_gone);
}

bool has_news(const Body& body) {
  if (!body.told || body.told->kind != body.thing.kind) return true;
  const Thing& told = *body.told;
  return body.thing.kind == ThingKind::kMoved && differ(told.from, body.thing.from, kLeastShift_m) &&
         !differ(told.at, body.thing.from, kLeastShift_m);
}

bool differs_from_told(const Body& body, double told_step_m) {
  return has_news(body) || differ(body.told->at, body.thing.at, told_step_m) ||
         differ(body.told->from, body.thing.from, told_step_m);
}

}  // namespace deltamap::mapping::things
