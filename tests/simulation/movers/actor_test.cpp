// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/actor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace deltamap::simulation {
namespace {

constexpr double kStep_s = 0.05;
const Circle kRobotFarOff{{100, 100}, 0.25};

/// 20 x 20 m with an opening of 4 m in the left wall.
World gated_hall() {
  return {{{1, ObjectKind::kWall, Polyline{{{0, 8}, {0, 0}, {20, 0}, {20, 20}, {0, 20}, {0, 12}}}}}};
}

ActorParams to_and_fro() { return {.path = {{3, 10}, {17, 10}}}; }

ActorParams truck() {
  ActorParams params = to_and_fro();
  params.is_forklift = true;
  return params;
}

struct Stops {
  std::vector<double> lengths_s;
  std::vector<double> places_x;
};

Stops stops_of(const ActorParams& params, double seconds, std::uint64_t seed) {
  Actor actor{params, Random{seed}};
  const RayCaster world{gated_hall()};
  Stops stops;
  bool stood = false;
  for (double t = 0.0; t < seconds; t += kStep_s) {
    actor.move(kStep_s, {world, kRobotFarOff, {}, {}});
    if (actor.is_standing() && !stood) {
      stops.lengths_s.push_back(0.0);
      stops.places_x.push_back(actor.box().centre.x());
    }
    stood = actor.is_standing();
    if (stood) stops.lengths_s.back() += kStep_s;
  }
  if (stood) stops.lengths_s.pop_back();  // not over yet
  return stops;
}

TEST(Actor, StopsAnywhereForFiveSecondsToAnHourAsOftenShortAsLong) {
  Stops all;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Stops stops = stops_of(to_and_fro(), 40'000.0, seed);
    all.lengths_s.insert(all.lengths_s.end(), stops.lengths_s.begin(), stops.lengths_s.end());
    all.places_x.insert(all.places_x.end(), stops.places_x.begin(), stops.places_x.end());
  }
  const auto [shortest, longest] = std::minmax_element(all.lengths_s.begin(), all.lengths_s.end());
  EXPECT_GE(*shortest, 5.0 - 2 * kStep_s);
  EXPECT_LT(*shortest, 7.0);
  EXPECT_LE(*longest, 3600.0 + 2 * kStep_s);
  EXPECT_GT(*longest, 2500.0);
  const double middle_s = std::sqrt(5.0 * 3600.0);  // of the logarithms
  const auto shorter =
      std::count_if(all.lengths_s.begin(), all.lengths_s.end(), [&](double length_s) { return length_s < middle_s; });
  EXPECT_NEAR(static_cast<double>(shorter) / static_cast<double>(all.lengths_s.size()), 0.5, 0.06);
  const auto [leftmost, rightmost] = std::minmax_element(all.places_x.begin(), all.places_x.end());
  EXPECT_LT(*leftmost, 5.0);
  EXPECT_GT(*rightmost, 15.0);
}

TEST(Actor, DoesTheSameForTheSameSeed) {
  EXPECT_EQ(stops_of(to_and_fro(), 4000.0, 3).places_x, stops_of(to_and_fro(), 4000.0, 3).places_x);
  EXPECT_NE(stops_of(to_and_fro(), 4000.0, 3).places_x, stops_of(to_and_fro(), 4000.0, 4).places_x);
}

TEST(Actor, LeavesByTheGateAndComesBack) {
  ActorParams params = to_and_fro();
  params.gate = Point2{-3, 10};
  params.leave_share = 1.0;
  params.stop_most_s = 20.0;
  params.away_most_s = 60.0;
  Actor actor{params, Random{1}};
  const RayCaster world{gated_hall()};
  int left = 0;
  int came = 0;
  bool inside = true;
  for (double t = 0.0; t < 1500.0; t += kStep_s) {
    const double x = actor.box().centre.x();
    actor.move(kStep_s, {world, kRobotFarOff, {}, {}});
    if (inside && !actor.is_in_hall()) {
      ++left;
      EXPECT_LT(x, -2.5) << "it vanishes outside only";
    }
    if (!inside && actor.is_in_hall()) ++came;
    inside = actor.is_in_hall();
    EXPECT_FALSE(actor.is_standing() && actor.box().centre.x() < 2.9) << "not between the gate and its path";
  }
  EXPECT_GE(left, 5);
  EXPECT_GE(came, left - 1);
}

TEST(Actor, StaysOutsideWhileTheRobotStandsAtTheGate) {
  ActorParams params = to_and_fro();
  params.gate = Point2{-3, 10};
  params.leave_share = 1.0;
  params.stop_most_s = 6.0;
  params.away_most_s = 40.0;
  Actor actor{params, Random{1}};
  const RayCaster world{gated_hall()};
  for (double t = 0.0; t < 300.0 && actor.is_in_hall(); t += kStep_s)
    actor.move(kStep_s, {world, kRobotFarOff, {}, {}});
  ASSERT_FALSE(actor.is_in_hall());
  for (double t = 0.0; t < 200.0; t += kStep_s) {
    actor.move(kStep_s, {world, Circle{{-2, 10}, 0.25}, {}, {}});
    ASSERT_FALSE(actor.is_in_hall());
  }
}

TEST(Actor, NeitherRunsIntoTheRobotNorStopsBesideIt) {
  for (const ActorParams& params : {to_and_fro(), truck()}) {
    Actor actor{params, Random{2}};
    const RayCaster world{gated_hall()};
    const Circle robot{{10, 10.3}, 0.25};
    for (double t = 0.0; t < 3000.0; t += kStep_s) {
      actor.move(kStep_s, {world, robot, {}, {}});
      const double gap_m = distance_between(robot.centre, actor.box()) - robot.radius_m;
      ASSERT_GT(gap_m, 0.4);
      ASSERT_TRUE(!actor.is_standing() || gap_m > 1.9);
    }
  }
}

TEST(Actor, TurnsBackBeforeOthersAndShutDoors) {
  const RayCaster world{gated_hall()};
  const std::vector<Circle> others{{{10, 10}, 0.2}};
  const std::vector<Segment> leaves{{{14, 9}, {14, 11}}};
  Actor before_another{truck(), Random{3}};
  Actor before_a_door{to_and_fro(), Random{3}};
  double farthest_x = 0.0;
  for (double t = 0.0; t < 3000.0; t += kStep_s) {
    before_another.move(kStep_s, {world, kRobotFarOff, others, {}});
    before_a_door.move(kStep_s, {world, kRobotFarOff, {}, leaves});
    ASSERT_LT(before_another.box().centre.x() + 1.2, 9.8);
    farthest_x = std::max(farthest_x, before_a_door.box().centre.x());
  }
  EXPECT_LT(farthest_x, 14.0 - 0.2);
  EXPECT_GT(farthest_x, 13.0);
}

TEST(ForkLiftActor, BacksOutWhereItIsBlocked) {
  const RayCaster world{gated_hall()};
  const std::vector<Circle> others{{{10, 10}, 0.2}};
  Actor actor{truck(), Random{3}};
  double farthest_x = 0.0;
  double backed_m = 0.0;
  for (double t = 0.0; t < 600.0; t += kStep_s) {
    const double before_x = actor.box().centre.x();
    actor.move(kStep_s, {world, kRobotFarOff, others, {}});
    farthest_x = std::max(farthest_x, before_x);
    backed_m += std::max(0.0, before_x - actor.box().centre.x());
    ASSERT_NEAR(actor.box().theta_rad, 0.0, 1e-9) << "it never turns";
  }
  EXPECT_GT(farthest_x, 7.0);
  EXPECT_GT(backed_m, 4.0);
}

TEST(ForkLiftActor, LooksWhereItGoesAndIsSeenAsABox) {
  Actor actor{truck(), Random{1}};
  const Box box = actor.box();
  EXPECT_EQ(box.width_m, 2.4);
  EXPECT_EQ(box.height_m, 1.2);
  EXPECT_NEAR(box.theta_rad, 0.0, 1e-12);
  Bodies bodies;
  bodies.add_truck(box);
  const RayCaster world{gated_hall()};
  const auto hit = world.cast({3, 5}, radians(90), 80.0, bodies.surfaces());
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->object, kMoverId);
  EXPECT_NEAR(hit->range_m, 5.0 - 0.6, 1e-9);
  for (const Point2& corner : corners(box)) {
    EXPECT_TRUE(std::any_of(bodies.walkers().begin(), bodies.walkers().end(), [&](const Circle& part) {
      return (corner - part.centre).norm() <= part.radius_m + 1e-9;
    })) << "the circles cover it";
  }
}

}  // namespace
}  // namespace deltamap::simulation
