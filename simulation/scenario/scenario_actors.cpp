// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario/scenario_actors.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace deltamap::simulation {
namespace {

constexpr double kLargest_m = 1000.0;  // of any length in a scenario

std::vector<ChangeKind> kinds_of(YamlSection& section, const std::vector<ChangeKind>& otherwise) {
  if (!section.has("changes")) return otherwise;
  std::vector<ChangeKind> kinds;
  for (const YAML::Node& item : section.items("changes")) {
    const auto kind = change_kind_named(item.IsScalar() ? item.Scalar() : "");
    if (!kind || *kind == ChangeKind::kCrept) {
      refuse_at(item, section.file(), "changes", "must list removed, added or shifted");
    }
    kinds.push_back(*kind);
  }
  return kinds;
}

std::vector<Point2> path_of(YamlSection& section) {
  std::vector<Point2> path;
  for (const YAML::Node& corner : section.items("path")) {
    const auto n = numbers_of(corner, 2, section.file(), "path");
    path.push_back({n[0], n[1]});
  }
  if (path.size() < 2) section.refuse("path", "must have at least two points");
  return path;
}

/// The longest of a time that is drawn by chance: not shorter than the shortest.
double most_s(YamlSection& section, const std::string& key, double otherwise, double least_s) {
  return section.number(key, std::max(otherwise, least_s), least_s, 1e6);
}

}  // namespace

ForkliftParams forklift_of(YamlSection lift) {
  ForkliftParams params;
  params.change_every_s = lift.number("change_every_s", params.change_every_s, 0.1, 1e6);
  params.kinds = kinds_of(lift, params.kinds);
  params.smallest_shift_m = lift.number("smallest_shift_m", params.smallest_shift_m, kSmallest_m, kLargest_m);
  params.largest_shift_m = lift.number("largest_shift_m", params.largest_shift_m, params.smallest_shift_m, kLargest_m);
  params.robot_margin_m = lift.number("robot_margin_m", params.robot_margin_m, 0.0, kLargest_m);
  params.people_margin_m = lift.number("people_margin_m", params.people_margin_m, 0.0, kLargest_m);
  params.passage_m = lift.number("passage_m", params.passage_m, 0.1, kLargest_m);
  params.least_filled = lift.number("least_filled", params.least_filled, 0.0, 1.0);
  lift.expect_no_more();
  return params;
}

CreepParams creep_of(YamlSection creep) {
  CreepParams params;
  params.containers = creep.whole_number("containers", params.containers, 1, 1000);
  params.step_m = creep.number("step_m", params.step_m, 0.001, 1.0);
  params.times = creep.whole_number("times", params.times, 1, 10'000);
  params.every_s = creep.number("every_s", params.every_s, 0.1, 1e6);
  if (creep.has("direction_deg")) params.direction_rad = radians(creep.number("direction_deg", 0.0, -360.0, 360.0));
  params.robot_margin_m = creep.number("robot_margin_m", params.robot_margin_m, 0.0, kLargest_m);
  params.people_margin_m = creep.number("people_margin_m", params.people_margin_m, 0.0, kLargest_m);
  params.passage_m = creep.number("passage_m", params.passage_m, 0.1, kLargest_m);
  creep.expect_no_more();
  return params;
}

ChangedStartParams changed_start_of(YamlSection start) {
  ChangedStartParams params;
  params.share = start.number("share", params.share, 0.0, 1.0);
  params.kinds = kinds_of(start, params.kinds);
  params.smallest_shift_m = start.number("smallest_shift_m", params.smallest_shift_m, kSmallest_m, kLargest_m);
  params.largest_shift_m = start.number("largest_shift_m", params.largest_shift_m, params.smallest_shift_m, kLargest_m);
  params.least_filled = start.number("least_filled", params.least_filled, 0.0, 1.0);
  start.expect_no_more();
  return params;
}

PersonParams person_of(YamlSection person) {
  PersonParams params;
  params.path = path_of(person);
  params.closed = person.flag("closed", params.closed);
  params.speed_m_per_s = person.number("speed_m_per_s", params.speed_m_per_s, 0.05, 5.0);
  params.radius_m = person.number("radius_m", params.radius_m, 0.03, 1.0);
  params.walk_least_s = person.number("walk_least_s", params.walk_least_s, 0.1, 1e6);
  params.walk_most_s = most_s(person, "walk_most_s", params.walk_most_s, params.walk_least_s);
  params.stand_least_s = person.number("stand_least_s", params.stand_least_s, 0.0, 1e6);
  params.stand_most_s = most_s(person, "stand_most_s", params.stand_most_s, params.stand_least_s);
  person.expect_no_more();
  return params;
}

ActorParams actor_of(YamlSection actor) {
  ActorParams params;
  params.path = path_of(actor);
  params.closed = actor.flag("closed", params.closed);
  const std::string body = actor.text("body", "person");
  if (body != "person" && body != "forklift") actor.refuse("body", "must be person or forklift");
  params.is_forklift = body == "forklift";
  params.speed_m_per_s = actor.number("speed_m_per_s", params.speed_m_per_s, 0.05, 5.0);
  params.radius_m = actor.number("radius_m", params.radius_m, 0.03, 1.0);
  params.length_m = actor.number("length_m", params.length_m, 0.2, 10.0);
  params.width_m = actor.number("width_m", params.width_m, 0.2, 10.0);
  params.walk_least_s = actor.number("walk_least_s", params.walk_least_s, 0.1, 1e6);
  params.walk_most_s = most_s(actor, "walk_most_s", params.walk_most_s, params.walk_least_s);
  params.stop_least_s = actor.number("stop_least_s", params.stop_least_s, 0.1, 1e6);
  params.stop_most_s = most_s(actor, "stop_most_s", params.stop_most_s, params.stop_least_s);
  if (actor.has("gate")) {
    const auto gate = actor.numbers("gate", 2);
    params.gate = Point2{gate[0], gate[1]};
  }
  params.leave_share = actor.number("leave_share", params.leave_share, 0.0, 1.0);
  params.away_least_s = actor.number("away_least_s", params.away_least_s, 0.1, 1e6);
  params.away_most_s = most_s(actor, "away_most_s", params.away_most_s, params.away_least_s);
  actor.expect_no_more();
  return params;
}

DoorParams door_of(YamlSection door) {
  DoorParams params;
  const auto leaf = door.numbers("leaf", 4);
  params.closed = {{leaf[0], leaf[1]}, {leaf[2], leaf[3]}};
  if ((params.closed.to - params.closed.from).norm() < kSmallest_m) door.refuse("leaf", "must have a length");
  params.swing_rad = radians(door.number("swing_deg", 0.0, -180.0, 180.0));
  params.period_s = door.number("period_s", params.period_s, 1.0, 1e6);
  params.open_share = door.number("open_share", params.open_share, 0.0, 1.0);
  params.moving_s = door.number("moving_s", params.moving_s, 0.1, 60.0);
  const std::string drawn = door.text("drawn", "closed");
  if (drawn != "closed" && drawn != "open") door.refuse("drawn", "must be closed or open");
  params.is_drawn_open = drawn == "open";
  door.expect_no_more();
  return params;
}

}  // namespace deltamap::simulation
