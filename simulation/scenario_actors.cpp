// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario_actors.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace deltamap::simulation {
namespace {

constexpr double kLargest_m = 1000.0;  // of any length in a scenario
constexpr double kSmallest_m = 0.01;

}  // namespace

ForkliftParams forklift_of(YamlSection lift) {
  ForkliftParams params;
  params.change_every_s = lift.number("change_every_s", params.change_every_s, 0.1, 1e6);
  if (lift.has("changes")) params.kinds.clear();
  for (const YAML::Node& item : lift.items("changes")) {
    const auto kind = change_kind_named(item.IsScalar() ? item.Scalar() : "");
    if (!kind) refuse_at(item, lift.file(), "changes", "must list removed, added or shifted");
    params.kinds.push_back(*kind);
  }
  params.smallest_shift_m = lift.number("smallest_shift_m", params.smallest_shift_m, kSmallest_m, kLargest_m);
  params.largest_shift_m = lift.number("largest_shift_m", params.largest_shift_m, params.smallest_shift_m, kLargest_m);
  params.robot_margin_m = lift.number("robot_margin_m", params.robot_margin_m, 0.0, kLargest_m);
  params.people_margin_m = lift.number("people_margin_m", params.people_margin_m, 0.0, kLargest_m);
  params.passage_m = lift.number("passage_m", params.passage_m, 0.1, kLargest_m);
  params.least_filled = lift.number("least_filled", params.least_filled, 0.0, 1.0);
  lift.expect_no_more();
  return params;
}

PersonParams person_of(YamlSection person) {
  PersonParams params;
  for (const YAML::Node& corner : person.items("path")) {
    const auto n = numbers_of(corner, 2, person.file(), "path");
    params.path.push_back({n[0], n[1]});
  }
  if (params.path.size() < 2) person.refuse("path", "must have at least two points");
  params.closed = person.flag("closed", params.closed);
  params.speed_m_per_s = person.number("speed_m_per_s", params.speed_m_per_s, 0.05, 5.0);
  params.radius_m = person.number("radius_m", params.radius_m, 0.03, 1.0);
  params.walk_least_s = person.number("walk_least_s", params.walk_least_s, 0.1, 1e6);
  params.walk_most_s =
      person.number("walk_most_s", std::max(params.walk_most_s, params.walk_least_s), params.walk_least_s, 1e6);
  params.stand_least_s = person.number("stand_least_s", params.stand_least_s, 0.0, 1e6);
  params.stand_most_s =
      person.number("stand_most_s", std::max(params.stand_most_s, params.stand_least_s), params.stand_least_s, 1e6);
  person.expect_no_more();
  return params;
}

}  // namespace deltamap::simulation
