// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/thing_score.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace deltamap::experiments {
namespace {

using mapping::things::Outline;
using mapping::things::Thing;
using mapping::things::ThingEvent;
using mapping::things::ThingKind;
using simulation::Box;

constexpr double kSameSize_m = 0.15;
constexpr double kNear_m = 0.3;       // around a box
constexpr double kEarliest_s = -5.0;  // before the act: clocks of scan and world differ by less

Outline outline_of(const Box& box) {
  Outline outline{box.centre, box.width_m, box.height_m, box.theta_rad, {}};
  if (outline.length_m < outline.width_m) {
    std::swap(outline.length_m, outline.width_m);
    outline.heading_rad += std::acos(-1.0) / 2;
  }
  return outline;
}

/// They cover each other, or the one lies in the other.
bool is_about(const std::optional<Outline>& told, const std::optional<Box>& box) {
  if (!told || !box) return false;
  const Outline real = outline_of(*box);
  return is_inside(real, told->centre, kNear_m) || overlap_share(real, *told) > 0.5;
}

/// The middle of what is told lies on the container's own floor.
bool is_right_place(const std::optional<Outline>& told, const std::optional<Box>& box) {
  return !told || !box || is_inside(outline_of(*box), told->centre, 0.0);
}

ThingKind kind_of(const TrueChange& change) {
  if (!change.from) return ThingKind::kAppeared;
  return change.at ? ThingKind::kMoved : ThingKind::kGone;
}

bool is_right(const Thing& thing, const TrueChange& change) {
  return thing.kind == kind_of(change) && is_right_place(thing.from, change.from) &&
         is_right_place(thing.at, change.at);
}

bool is_right_size(const Thing& thing, const TrueChange& change) {
  const Outline real = outline_of(change.at ? *change.at : *change.from);
  return std::abs(thing.outline().length_m - real.length_m) <= kSameSize_m &&
         std::abs(thing.outline().width_m - real.width_m) <= kSameSize_m;
}

bool is_no_event(ThingKind kind) { return kind == ThingKind::kTakenBack || kind == ThingKind::kJoined; }

}  // namespace

const TrueChange* change_of(const Told& told, std::span<const TrueChange> changes) {
  const TrueChange* newest = nullptr;
  for (const TrueChange& change : changes) {
    if (seconds(told.time - change.time) < kEarliest_s) continue;
    const bool is_of = is_about(told.thing.from, change.from) || is_about(told.thing.at, change.at) ||
                       is_about(told.thing.from, change.at) || is_about(told.thing.at, change.from);
    if (!is_of) continue;
    const bool is_better = newest == nullptr || is_right(told.thing, change) || !is_right(told.thing, *newest);
    if (is_better) newest = &change;
  }
  return newest;
}

std::vector<TrueChange> true_changes(std::span<const simulation::score::Watched> watched, double seen_least_s,
                                     double face_least_s) {
  std::vector<TrueChange> changes;
  for (const simulation::score::Watched& one : watched) {
    const simulation::score::ScoredChange& half = one.change;
    const bool is_seen = one.is_told_apart && one.witness.longest_seen_s() >= seen_least_s;
    const bool is_second = half.appears && half.kind != simulation::ChangeKind::kAdded && !changes.empty() &&
                           changes.back().time == half.time;
    if (!is_second) changes.push_back({half.time, half.kind, {}, {}, true, true});
    TrueChange& change = changes.back();
    (half.appears ? change.at : change.from) = half.box;
    change.is_seen = change.is_seen && is_seen;
    change.is_seen_all_around = change.is_seen_all_around && is_seen && one.is_seen_all_around(face_least_s);
  }
  return changes;
}

std::vector<TrueChange> only_seen_all_around(std::span<const TrueChange> changes) {
  std::vector<TrueChange> only{changes.begin(), changes.end()};
  for (TrueChange& change : only) change.is_seen = change.is_seen && change.is_seen_all_around;
  return only;
}

std::vector<Told> told_at_last(std::span<const ThingEvent> events, double one_look_s) {
  std::map<std::uint32_t, std::vector<Told>> of_thing;
  for (const ThingEvent& event : events) {
    std::vector<Told>& told = of_thing[event.thing.id];
    const bool goes_on = !told.empty() && told.back().thing.kind == event.thing.kind && !event.is_new;
    if (goes_on) {
      told.back().thing = event.thing;
      continue;
    }
    const bool replaces =
        !told.empty() && (is_no_event(event.thing.kind) || seconds(event.time - told.back().time) < one_look_s);
    if (replaces) told.pop_back();
    if (!is_no_event(event.thing.kind)) told.push_back({event.thing, event.time});
  }
  std::vector<Told> all;
  for (const auto& [id, told] : of_thing) all.insert(all.end(), told.begin(), told.end());
  return all;
}

ThingScore score_of(std::span<const Told> told, std::span<const TrueChange> changes) {
  std::map<const TrueChange*, std::vector<const Told*>> events;
  ThingScore score;
  score.told = told.size();
  for (const Told& one : told) {
    const TrueChange* change = change_of(one, changes);
    if (change != nullptr) events[change].push_back(&one);
    score.wrong += change == nullptr ? 1 : 0;
    if (one.thing.kind != ThingKind::kMoved) continue;
    ++score.told_moved;
    score.wrong_pairs += change == nullptr || kind_of(*change) != ThingKind::kMoved ? 1 : 0;
  }
  for (const TrueChange& change : changes) {
    if (!change.is_seen) continue;
    const std::vector<const Told*>& of_it = events[&change];
    ++score.changes;
    score.unfound += of_it.empty() ? 1 : 0;
    score.events += of_it.size();
    score.most_events = std::max(score.most_events, of_it.size());
    const auto right =
        std::find_if(of_it.begin(), of_it.end(), [&](const Told* one) { return is_right(one->thing, change); });
    const bool found = right != of_it.end();
    score.right += found ? 1 : 0;
    score.right_size += found && is_right_size((*right)->thing, change) ? 1 : 0;
    score.moved += kind_of(change) == ThingKind::kMoved ? 1 : 0;
    score.moved_right += found && kind_of(change) == ThingKind::kMoved ? 1 : 0;
  }
  return score;
}

AssumedScore assumed_score_of(std::span<const Thing> things, std::span<const Box> boxes) {
  AssumedScore score;
  for (const Thing& thing : things) {
    if (!thing.at) continue;
    const auto corners_of_it = corners(*thing.at);
    for (std::size_t side = 0; side < corners_of_it.size(); ++side) {
      if (!thing.at->assumed[side]) continue;
      const Point2 middle = 0.5 * (corners_of_it[side] + corners_of_it[(side + 1) % 4]);
      ++score.sides;
      score.right += std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
        return is_inside(outline_of(box), middle, kSameSize_m) && !is_inside(outline_of(box), middle, -kSameSize_m);
      });
      score.of_seen += std::count(thing.at->seen.begin(), thing.at->seen.end(), true) == 4 ? 1 : 0;
    }
  }
  return score;
}

}  // namespace deltamap::experiments
