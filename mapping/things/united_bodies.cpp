// SPDX-License-Identifier: Apache-2.0
// Bodies that prove to be one: faces of one body that were seen one after the other, and the two ends of a move.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "mapping/things/pushed.hpp"
#include "mapping/things/shifted.hpp"
#include "mapping/things/things.hpp"

namespace deltamap::mapping::things {
namespace {

constexpr double kSamePlace_m = 1.0;  // between the middles of a body before and after it was pushed aside
constexpr double kSameSize_m = 0.3;
constexpr double kSameBodyOverlap = 0.5;  // of the outlines of one body, when it stood there and now that it is gone
constexpr double kFlickerNear_m = 0.2;

/// Their sizes, as far as they are known.
bool may_be_one(const Outline& a, const Outline& b) {
  const bool is_thin = a.width_m < kOneFace_m || b.width_m < kOneFace_m;
  return std::abs(a.length_m - b.length_m) <= kSameSize_m &&
         (is_thin || std::abs(a.width_m - b.width_m) <= kSameSize_m);
}

/// It was told of when it stood there and is no longer followed cell by cell: now it has gone from there.
bool is_the_going_of(const Body& body, const Body& stood) {
  return !body.told && body.thing.from && !body.thing.at && stood.thing.at && stood.come.empty() &&
         overlap_share(*stood.thing.at, *body.thing.from) > kSameBodyOverlap;
}

/// It has come, or it has gone and did not come before.
bool is_one_end(const Thing& thing) {
  return thing.at.has_value() != thing.from.has_value() && thing.kind != ThingKind::kTakenBack;
}

/// The sides on which both lie; nothing where one has gone and the other has come.
std::optional<Side> common_side(const Thing& a, const Thing& b) {
  if (a.at && b.at && !a.from && !b.from) return Side::kCome;
  if (a.from && b.from && !a.at && !b.at) return Side::kGone;
  return std::nullopt;
}

void take_places(Body& into, const Body& part) {
  Thing& thing = into.thing;
  if (is_the_going_of(part, into)) {
    thing.from = part.thing.from;
    thing.at.reset();
    thing.kind = ThingKind::kGone;
    return;
  }
  const bool is_move = part.thing.at ? !thing.at && thing.from : thing.at && !thing.from && part.thing.from;
  if (!thing.at) thing.at = part.thing.at;
  if (!thing.from) thing.from = part.thing.from;
  if (is_move && into.told) thing.kind = ThingKind::kMoved;
}

void take_cells(Body& into, const Body& part) {
  for (const Side side : {Side::kCome, Side::kGone}) {
    part.cells(side).visit([&](Cell cell, CellState before) { into.cells(side).own(cell, before); });
  }
  into.most_faces_come += part.most_faces_come;
  into.most_faces_gone += part.most_faces_gone;
  part.shown.visit([&](Cell cell, CellState before) { into.shown.own(cell, before); });
  into.most_gone += part.most_gone;
  into.written += part.written;
  into.began = std::min(into.began, part.began);
  into.grown = std::max(into.grown, part.grown);
  into.has_grown = into.has_grown || part.has_grown;
  if (!into.freed) into.freed = part.freed;
  into.is_contradicted = into.is_contradicted || part.is_contradicted;
  into.is_touched = true;
}

void take_history(Thing& into, const Thing& part) {
  into.first_seen = std::min(into.first_seen, part.first_seen);
  into.last_seen = std::max(into.last_seen, part.last_seen);
  std::vector<std::uint32_t> all;
  std::set_union(into.revisions.begin(), into.revisions.end(), part.revisions.begin(), part.revisions.end(),
                 std::back_inserter(all));
  if (all.size() > Thing::kMostRevisions) all.erase(all.begin(), all.end() - Thing::kMostRevisions);
  into.revisions = std::move(all);
}

/// What has gone under what has come, as one body that was shifted.
std::optional<Pushed> shifted_to(const Body& came, const Body& gone, const OccupancyGrid& map) {
  const double reach_m = 0.5 * std::hypot(came.thing.at->length_m, came.thing.at->width_m) +
                         0.5 * std::hypot(gone.thing.from->length_m, gone.thing.from->width_m);
  if (is_taken(gone) || (came.thing.at->centre - gone.thing.from->centre).norm() > reach_m) return std::nullopt;
  std::vector<Point2> freed;
  gone.gone.visit([&](Cell cell, CellState) {
    if (map.at(cell) == CellState::kFree) freed.push_back(map.geometry().centre_of(cell));
  });
  return shifted_body({*came.thing.at, is_whole(came, Side::kCome, map)},
                      {*gone.thing.from, is_whole(gone, Side::kGone, map)}, freed, map);
}

}  // namespace

void Things::join_faces(const ChangedMap& now) {
  for (auto next = bodies_.begin(); next != bodies_.end();) {
    Body& grown = *next++;
    if (!grown.has_grown) continue;
    const auto is_other_face = [&](const Body& other) {
      if (&other == &grown) return false;
      const double apart_s = std::abs(seconds(other.thing.first_seen - grown.thing.first_seen));
      if (grown.told && other.told && apart_s > params_.one_look_s) return false;
      const auto side = common_side(grown.thing, other.thing);
      return side && are_of_one(grown, other, *side, now.map, params_.one_look_s);
    };
    const auto other = std::find_if(bodies_.begin(), bodies_.end(), is_other_face);
    if (other == bodies_.end()) continue;
    judge(unite(*other, grown), now, params_);
    next = bodies_.begin();
  }
}

void Things::join_pushes(const OccupancyGrid& map) {
  for (auto next = bodies_.begin(); next != bodies_.end();) {
    Body& body = *next++;
    if (!body.is_touched || !is_tellable(body, params_)) continue;
    std::optional<Pushed> pushed;
    const auto other = std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& one) {
      if (!one.told || !is_one_end(one.thing) || !is_one_end(body.thing) ||
          one.thing.at.has_value() == body.thing.at.has_value())
        return false;
      const Body& came = body.thing.at ? body : one;
      const Body& gone = body.thing.at ? one : body;
      pushed = pushed_body(*came.thing.at, *gone.thing.from, map);
      if (!pushed) pushed = shifted_to(came, gone, map);
      return pushed.has_value();
    });
    if (other == bodies_.end()) continue;
    Body& whole = unite(*other, body);
    whole.thing.from = pushed->from;
    whole.thing.at = pushed->at;
    whole.thing.kind = ThingKind::kMoved;
    whole.freed.reset();
    whole.is_pushed = true;
    next = bodies_.begin();
  }
}

void Things::join_moves() {
  for (auto next = bodies_.begin(); next != bodies_.end();) {
    Body& body = *next++;
    if (!body.is_touched || !is_tellable(body, params_)) continue;
    Body* other = other_part_of(body);
    if (other == nullptr) continue;
    (void)unite(*other, body);
    next = bodies_.begin();
  }
}

Body* Things::other_part_of(const Body& body) {
  if (body.thing.from && body.thing.at) return nullptr;
  Body* nearest = nullptr;
  double nearest_m = kSamePlace_m;
  for (Body& other : bodies_) {
    if (&other == &body || !other.told || other.thing.kind == ThingKind::kTakenBack) continue;
    if (is_the_going_of(body, other)) return &other;
    const bool is_other_end = body.thing.at ? !other.thing.at : !other.thing.from;
    const double apart_s =
        std::min(std::abs(seconds(body.began - other.began)), std::abs(seconds(body.began - other.grown)));
    if (!is_other_end || apart_s > params_.one_look_s) continue;
    const double away_m = (body.thing.outline().centre - other.thing.outline().centre).norm();
    const bool is_near = away_m >= kLeastShift_m && away_m <= nearest_m;
    if (!is_near || !may_be_one(body.thing.outline(), other.thing.outline())) continue;
    nearest = &other;
    nearest_m = away_m;
  }
  return nearest;
}

Body& Things::unite(Body& one, Body& other) {
  const auto order_of = [](const Body& body) {
    return std::pair{body.told ? body.thing.id : std::numeric_limits<std::uint32_t>::max(), body.thing.first_seen};
  };
  Body& into = order_of(other) < order_of(one) ? other : one;
  Body& part = &into == &one ? other : one;
  if (part.told) {
    Thing& joined = joined_.emplace_back(part.thing);
    joined.kind = ThingKind::kJoined;
    joined.joined_into = into.thing.id;
    ++joined.updates;
  }
  take_places(into, part);
  take_cells(into, part);
  take_history(into.thing, part.thing);
  bodies_.remove_if([&](const Body& body) { return &body == &part; });
  return into;
}

bool Things::only_flickers(const Body& body) const {
  const Outline& outline = body.thing.outline();
  if (outline.width_m >= kOneFace_m) return false;
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& earlier) {
    return earlier.told && earlier.thing.outline().width_m < kOneFace_m &&
           is_inside(earlier.thing.outline(), outline.centre, kFlickerNear_m);
  });
}

}  // namespace deltamap::mapping::things
