// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/things.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/grid/near_occupied.hpp"
#include "mapping/things/cell_clusters.hpp"

namespace deltamap::mapping::things {
namespace {

constexpr int kSurfaceReach = 1;        // cells; what changes so near to a surface that stays corrects it
constexpr std::size_t kLeastSeeds = 2;  // cells of a cluster that are no correction, for a body to begin
constexpr int kInsideReach = 2;         // cells between a face and what it closes off
constexpr double kBeyond_m = 0.25;      // so far outside of an outline is beyond it

bool became_surface(const CellChange& change) { return change.after == CellState::kOccupied; }
bool lost_surface(const CellChange& change) {
  return change.before == CellState::kOccupied && change.after == CellState::kFree;
}

OccupancyGrid map_before(const ChangedMap& step) {
  OccupancyGrid before = step.map;
  for (const CellChange& change : step.changes) before.set(change.cell, change.before);
  return before;
}

/// Most of it lies outside of the outline.
bool is_beyond(const std::vector<CellChange>& cluster, const Outline& outline, const GridGeometry& geometry) {
  const auto outside = std::count_if(cluster.begin(), cluster.end(), [&](const CellChange& change) {
    return !is_inside(outline, geometry.centre_of(change.cell), kBeyond_m);
  });
  return 2 * static_cast<std::size_t>(outside) > cluster.size();
}

/// To where it was told to have left, or to the same place as an earlier cluster of the revision.
bool returns_to(const Body& body, const std::vector<CellChange>& cluster, const OccupancyGrid& map) {
  return (body.has_returned || has_left(body, map)) &&
         !is_beyond(cluster, body.thing.from ? *body.thing.from : *body.thing.at, map.geometry());
}

std::vector<Point2> places_of(const std::vector<CellChange>& cluster, const GridGeometry& geometry) {
  std::vector<Point2> places;
  places.reserve(cluster.size());
  for (const CellChange& change : cluster) places.push_back(geometry.centre_of(change.cell));
  return places;
}

/// How far the place lies outside of the body's outline, or, of a single face, beside what lies behind that; none yet:
/// 0.
double beside_m(const Body& body, Side side, const Point2& place) {
  const auto& outline = body.outline(side);
  if (!outline) return 0.0;
  const Point2 own = inverse({outline->centre.x(), outline->centre.y(), outline->heading_rad}) * place;
  const double along_m = std::max(0.0, std::abs(own.x()) - 0.5 * outline->length_m - kBeyond_m);
  const double across_m = std::max(0.0, std::abs(own.y()) - 0.5 * outline->width_m - kBeyond_m);
  return outline->width_m < kOneFace_m ? along_m : std::max(along_m, across_m);
}

std::size_t cells_touching(const ThingCells& cells, const std::vector<CellChange>& cluster, int reach_cells) {
  if (common(grown(cells.box(), reach_cells), bounding_box(cluster)).empty()) return 0;
  return static_cast<std::size_t>(std::count_if(cluster.begin(), cluster.end(), [&](const CellChange& change) {
    return cells.has_within(change.cell, reach_cells);
  }));
}

std::size_t bytes_of(const Body& body) { return body.come.bytes() + body.gone.bytes() + body.shown.bytes(); }

}  // namespace

struct Things::Step {
  const ChangedMap& now;
  OccupancyGrid before;
  int gap_cells;

  /// It corrects a surface that was there, or still is.
  [[nodiscard]] bool is_correction(const CellChange& change) const {
    return has_occupied_within(became_surface(change) ? before : now.map, change.cell, kSurfaceReach);
  }
};

std::vector<ThingEvent> Things::take(const ChangedMap& changed) {
  const int gap_cells = std::max(1, static_cast<int>(std::lround(params_.gap_m / changed.map.resolution_m())));
  const Step step{changed, map_before(changed), gap_cells};
  for (Body& body : bodies_) body.is_touched = body.has_grown = body.has_returned = false;
  joined_.clear();
  newest_revision_ = changed.number;
  const Cells left = restored(step);
  for (const Side side : {Side::kGone, Side::kCome}) {
    add_surfaces(step, left, side);
    add_insides(changed.map.geometry(), left, side);
  }
  note_shown(step);
  std::vector<ThingEvent> events = told(step);
  drop_tentative(step);
  stay_within_bounds();
  return events;
}

Things::Cells Things::restored(const Step& step) {
  std::vector<Body*> near;
  const CellBox changed = bounding_box(step.now.changes);
  for (Body& body : bodies_) {
    if (!common(body.come.box(), changed).empty() || !common(body.gone.box(), changed).empty()) near.push_back(&body);
  }
  Cells left;
  for (const CellChange& change : step.now.changes) {
    bool is_claimed = false;
    for (Body* body : near) {
      if (const auto before = body->come.before(change.cell)) {
        if (change.after == *before || change.after == CellState::kFree) {
          body->come.drop(change.cell);
          is_claimed = true;
        }
        body->is_touched = true;
      }
      const auto before = body->gone.before(change.cell);
      if (before && change.after != CellState::kFree) {
        body->gone.drop(change.cell);
        is_claimed = is_claimed || (step.now.takes_back && change.after == *before);
        body->is_touched = true;
      }
    }
    if (!is_claimed) left.push_back(change);
  }
  return left;
}

void Things::add_surfaces(const Step& step, const Cells& changes, Side side) {
  Cells surface;
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(surface), [&](const CellChange& change) {
    return side == Side::kCome ? became_surface(change) : lost_surface(change);
  });
  for (const Cells& cluster : cell_clusters(surface, step.gap_cells)) {
    Body* body = body_of(step, cluster, side);
    if (body == nullptr) {
      const auto seeds = std::count_if(cluster.begin(), cluster.end(), [&](const CellChange& change) {
        return change.before != CellState::kUnknown && !step.is_correction(change);
      });
      if (static_cast<std::size_t>(seeds) < kLeastSeeds || step.now.takes_back) {
        corrections_ += cluster.size();
        continue;
      }
      body = &bodies_.emplace_back();
      body->thing.first_seen = body->began = step.now.time;
    }
    own(*body, cluster, side);
    body->grown = step.now.time;
    body->has_grown = true;
  }
}

/// It touches the cluster, and may still grow by it.
std::size_t Things::cells_it_grows_by(const Body& body, const Step& step, const Cells& cluster, Side side) const {
  const bool has_left_them = body.told && (!body.thing.at || body.is_pushed_back);
  if (side == Side::kCome && has_left_them) return 0;  // what is left of one that has gone
  const std::size_t touching = cells_touching(body.cells(side), cluster, step.gap_cells);
  if (touching == 0) return 0;
  const GridGeometry& geometry = step.now.map.geometry();
  if (side == Side::kGone && is_beyond_shown(body, places_of(cluster, geometry), geometry)) return 0;
  const auto& outline = body.outline(side);
  const bool grows_no_more =
      outline && (is_whole(body, side, step.now.map) || seconds(step.now.time - body.grown) > params_.one_look_s);
  return grows_no_more && is_beyond(cluster, *outline, step.now.map.geometry()) ? 0 : touching;
}

Body* Things::body_of(const Step& step, const Cells& cluster, Side side) {
  Body* best = nullptr;
  std::size_t most = 0;
  for (auto next = bodies_.begin(); next != bodies_.end();) {
    Body& body = *next++;
    if (side == Side::kCome && step.now.takes_back && returns_to(body, cluster, step.now.map)) {
      if (!body.has_returned) stand_again(body, step.now.map);
      return &body;
    }
    const std::size_t grows_by = cells_it_grows_by(body, step, cluster, side);
    if (grows_by == 0) continue;
    if (best != nullptr && (!best->told || !body.told)) {
      best = &unite(*best, body);
      most += grows_by;
    } else if (grows_by > most) {
      best = &body;
      most = grows_by;
    }
  }
  return best;
}

void Things::note_shown(const Step& step) {
  const CellBox changed = bounding_box(step.now.changes);
  for (Body& body : bodies_) {
    if (body.gone.empty() || common(grown(body.gone.box(), step.gap_cells), changed).empty()) continue;
    for (const CellChange& change : step.now.changes) {
      if (step.now.takes_back) {
        body.shown.drop(change.cell);
      } else if (became_surface(change) && body.gone.has_within(change.cell, step.gap_cells)) {
        body.shown.own(change.cell, change.before);
      }
    }
  }
}

void Things::add_insides(const GridGeometry& geometry, const Cells& changes, Side side) {
  const CellState before = side == Side::kCome ? CellState::kFree : CellState::kUnknown;
  const CellState after = side == Side::kCome ? CellState::kUnknown : CellState::kFree;
  Cells insides;
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(insides),
               [&](const CellChange& change) { return change.before == before && change.after == after; });
  for (const Cells& cluster : cell_clusters(insides, 1)) {
    std::vector<Body*> touching;  // that whose surface grew last comes first
    for (Body& body : bodies_) {
      if (cells_touching(body.cells(side), cluster, kInsideReach) > 0) touching.push_back(&body);
    }
    if (touching.empty()) continue;
    std::stable_sort(touching.begin(), touching.end(),
                     [](const Body* a, const Body* b) { return a->grown > b->grown; });
    for (const CellChange& change : cluster) {
      const Point2 place = geometry.centre_of(change.cell);
      const auto owner = std::min_element(touching.begin(), touching.end(), [&](const Body* a, const Body* b) {
        return beside_m(*a, side, place) < beside_m(*b, side, place);
      });
      own(**owner, {&change, 1}, side);
    }
  }
}

bool Things::is_taken_by_another(const Body& body, const Outline& at, const OccupancyGrid& map) const {
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& other) {
    return &other != &body && faces_within(other, at, map) >= static_cast<std::size_t>(params_.least_cells);
  });
}

std::vector<ThingEvent> Things::told(const Step& step) {
  for (Body& body : bodies_) {
    contradict_by(step.now, body);
    if (body.is_touched) judge(body, step.now, params_);
    const auto at = pushed_back_to(step.now, body, params_.one_look_s);
    if (at && !is_taken_by_another(body, *at, step.now.map)) push_back(body, *at, step.now.map);
  }
  join_faces(step.now);
  if (!step.now.takes_back) {  // else nothing new is said of the world
    join_pushes(step.now.map);
    join_moves();
  }
  std::vector<ThingEvent> events;
  for (const Thing& thing : joined_) events.push_back({thing, step.now.number, step.now.time, true});
  for (Body& body : bodies_) {
    if (!body.is_touched || (!body.told && (!is_tellable(body, params_) || only_flickers(body)))) continue;
    if (!differs_from_told(body, params_.told_step_m)) continue;
    const bool is_new = has_news(body);
    if (body.thing.id == 0) body.thing.id = ++newest_id_;
    if (body.told) ++body.thing.updates;
    body.told = body.thing;
    events.push_back({body.thing, step.now.number, step.now.time, is_new});
  }
  return events;
}

std::vector<ThingEvent> Things::look(const TrackedScan& tracked) {
  std::vector<ThingEvent> events;
  for (Body& body : bodies_) {
    if (!body.told || !look_at(body, tracked)) continue;
    ++body.thing.updates;
    body.told = body.thing;
    events.push_back({body.thing, newest_revision_, tracked.scan.time, false});
  }
  return events;
}

void Things::drop_tentative(const Step& step) {
  std::erase_if(bodies_, [&](const Body& body) {
    if (body.told) return false;
    const bool is_empty = body.come.empty() && body.gone.empty();
    if (!is_empty && seconds(step.now.time - body.thing.first_seen) <= params_.tentative_s) return false;
    corrections_ += body.written;
    return true;
  });
}

void Things::stay_within_bounds() {
  for (std::size_t bytes = cell_bytes(); bytes > params_.most_cell_bytes; bytes = cell_bytes()) {
    const auto quietest = std::min_element(bodies_.begin(), bodies_.end(), [](const Body& a, const Body& b) {
      const bool a_has = bytes_of(a) > 0;
      const bool b_has = bytes_of(b) > 0;
      return a_has != b_has ? a_has : a.thing.last_seen < b.thing.last_seen;
    });
    quietest->come.clear();
    quietest->gone.clear();
    quietest->shown.clear();
    if (!quietest->told) bodies_.erase(quietest);
  }
  while (bodies_.size() > params_.most_things) {
    const auto oldest = std::find_if(bodies_.begin(), bodies_.end(), [](const Body& body) { return !body.thing.at; });
    bodies_.erase(oldest == bodies_.end() ? bodies_.begin() : oldest);
    ++forgotten_;
  }
}

std::size_t Things::cell_bytes() const {
  std::size_t bytes = 0;
  for (const Body& body : bodies_) bytes += bytes_of(body);
  return bytes;
}

std::vector<CellChange> Things::undoing(std::uint32_t id, const OccupancyGrid& map) const {
  std::vector<CellChange> changes;
  const auto body = std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& one) { return one.thing.id == id; });
  if (body == bodies_.end()) return changes;
  const auto add = [&](Cell cell, CellState before) {
    if (map.at(cell) != before) changes.push_back({cell, map.at(cell), before});
  };
  body->come.visit(add);
  body->gone.visit([&](Cell cell, CellState before) {
    if (!body->come.before(cell)) add(cell, before);  // what stands there now came later
  });
  return changes;
}

std::vector<Thing> Things::all() const {
  std::vector<Thing> things;
  for (const Body& body : bodies_) {
    if (body.told) things.push_back(body.thing);
  }
  std::sort(things.begin(), things.end(), [](const Thing& a, const Thing& b) { return a.id < b.id; });
  return things;
}

}  // namespace deltamap::mapping::things
