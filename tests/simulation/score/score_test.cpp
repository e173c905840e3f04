// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/scenario/start_map.hpp"
#include "simulation/score/change_score.hpp"
#include "simulation/score/trajectory_score.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::simulation::score {
namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
const Box kLeft{{4, 5}, 2, 2, 0};
const Box kRight{{8, 5}, 2, 2, 0};

Timestamp after(double seconds) { return timestamp_from_ns(kStart_ns) + duration_from_seconds(seconds); }

/// A room of 12 x 10 m with one container at the left; the robot stands below it and looks up.
Scenario room_with_one_container() {
  return parse_scenario(
      "walls:\n  - [[0, 0], [12, 0], [12, 10], [0, 10], [0, 0]]\n"
      "containers:\n  - [4, 5, 2, 2, 0]\nrobot:\n  start: [6, 1, 90]\n",
      "room.yaml");
}

Truth standing_for(double seconds, std::vector<TruthChange> changes) {
  Truth truth;
  for (double t = 0.0; t <= seconds; t += 0.1) truth.poses.push_back({after(t), {6, 1, radians(90)}, 0.0, false});
  truth.changes = std::move(changes);
  return truth;
}

OccupancyGrid survey(const World& world) { return start_map(world, {6, 1}, 0.05); }

struct Fixture {
  Scenario scenario = room_with_one_container();
  int id = scenario.world.objects.back().id;
  OccupancyGrid before = survey(scenario.world);
  Change removal{ChangeKind::kRemoved, id, kLeft, std::nullopt};
  Change arrival{ChangeKind::kAdded, 50, kRight, std::nullopt};
};

TEST(ChangeScore, FindsARemovalInTheTrueMapAndNotInTheOldOne) {
  const Fixture given;
  const Truth truth = standing_for(30.0, {{after(5.0), given.removal}});
  const World now = changed(given.scenario.world, given.removal);
  const ChangeScore followed = change_score(given.scenario, truth, given.before, survey(now), {});
  ASSERT_EQ(followed.changes.size(), 1u);
  EXPECT_EQ(followed.eligible, 1u);
  EXPECT_EQ(followed.found, 1u);
  EXPECT_NEAR(followed.changes[0].seen_s, 25.0, 0.5);
  EXPECT_GT(followed.changes[0].visible_cells, 40u) << "its lower face alone has 40 cells";
  EXPECT_NEAR(followed.ghosts_m2, 0.0, 1e-9);

  const ChangeScore ignored = change_score(given.scenario, truth, given.before, given.before, {});
  EXPECT_EQ(ignored.eligible, 1u);
  EXPECT_EQ(ignored.found, 0u);
  EXPECT_EQ(ignored.changes[0].right_cells, 0u);
  EXPECT_NEAR(ignored.ghosts_m2, 160 * 0.0025, 5 * 0.0025) << "the whole contour stands for nothing";
  EXPECT_NEAR(ignored.stale_ghosts_m2, ignored.ghosts_m2, 1e-9);
}

TEST(ChangeScore, FindsAnArrivalOnlyWhereItsSeenFacesAreDrawn) {
  const Fixture given;
  const Truth truth = standing_for(30.0, {{after(5.0), given.arrival}});
  const World now = changed(given.scenario.world, given.arrival);
  EXPECT_EQ(change_score(given.scenario, truth, given.before, survey(now), {}).found, 1u);
  const ChangeScore ignored = change_score(given.scenario, truth, given.before, given.before, {});
  EXPECT_EQ(ignored.eligible, 1u);
  EXPECT_EQ(ignored.found, 0u);

  OccupancyGrid lower_face_only = given.before;
  for (double x = 7.0; x <= 9.0; x += 0.05) {
    lower_face_only.set(given.before.geometry().cell_at({x, 4.05}), CellState::kOccupied);
  }
  const ChangeScore partly = change_score(given.scenario, truth, given.before, lower_face_only, {});
  EXPECT_EQ(partly.found, 1u) << "one cell off, and the side that is seen at a slant is the smaller part";
}

TEST(ChangeScore, AsksOnlyForWhatWasSeenLongEnough) {
  const Fixture given;
  EXPECT_EQ(
      change_score(given.scenario, standing_for(14.0, {{after(5.0), given.removal}}), given.before, given.before, {})
          .eligible,
      0u)
      << "9 s";
  Truth turned_away = standing_for(30.0, {{after(5.0), given.removal}});
  for (TruthPose& pose : turned_away.poses) pose.map_from_robot.theta = radians(-90);
  EXPECT_EQ(change_score(given.scenario, turned_away, given.before, given.before, {}).eligible, 0u);
  const ChangeScoreParams short_sighted{.range_m = 2.0};
  EXPECT_EQ(change_score(given.scenario, standing_for(30.0, {{after(5.0), given.removal}}), given.before, given.before,
                         short_sighted)
                .eligible,
            0u);
}

TEST(ChangeScore, LeavesOutWhatALaterChangeOvertook) {
  const Fixture given;
  const Change back{ChangeKind::kAdded, 51, kLeft, std::nullopt};
  const Truth truth = standing_for(60.0, {{after(5.0), given.removal}, {after(30.0), back}});
  const ChangeScore score = change_score(given.scenario, truth, given.before, given.before, {});
  ASSERT_EQ(score.changes.size(), 2u);
  EXPECT_TRUE(score.changes[0].is_overtaken);
  EXPECT_EQ(score.eligible, 1u);
  EXPECT_EQ(score.found, 1u) << "the old map happens to be right again";
}

TEST(ChangeScore, TakesAShiftAsOneGoneAndOneCome) {
  const Fixture given;
  Box moved = kLeft;
  moved.centre.y() -= 0.8;
  const Change shift{ChangeKind::kShifted, given.id, moved, kLeft};
  const Truth truth = standing_for(30.0, {{after(5.0), shift}});
  const World now = changed(given.scenario.world, shift);
  const ChangeScore score = change_score(given.scenario, truth, given.before, survey(now), {});
  ASSERT_EQ(score.changes.size(), 2u);
  EXPECT_TRUE(score.changes[1].is_eligible);
  EXPECT_TRUE(score.changes[1].is_found);
  EXPECT_FALSE(score.changes[0].is_overtaken) << "a shift does not overtake itself";
  EXPECT_EQ(change_score(given.scenario, truth, given.before, given.before, {}).found, 0u);
}

TEST(ChangeScore, CountsGhostsFartherThanTwoCellsFromAnySurface) {
  const Fixture given;
  OccupancyGrid haunted = given.before;
  const Cell ghost = haunted.geometry().cell_at({9.0, 2.0});
  const Cell beside_wall = haunted.geometry().cell_at({9.0, 0.1});
  haunted.set(ghost, CellState::kOccupied);
  haunted.set(beside_wall, CellState::kOccupied);
  const ChangeScore score = change_score(given.scenario, standing_for(5.0, {}), given.before, haunted, {});
  EXPECT_NEAR(score.ghosts_m2, 0.0025, 1e-9);
  EXPECT_EQ(score.stale_ghosts_m2, 0.0);
}

TEST(ChangeScore, RefusesMapsOfDifferentGeometry) {
  const Fixture given;
  EXPECT_THROW((void)change_score(given.scenario, standing_for(5.0, {}), given.before,
                                  start_map(given.scenario.world, {6, 1}, 0.1), {}),
               std::runtime_error);
}

TEST(TrajectoryScore, MeasuresAgainstTheInterpolatedTruth) {
  Truth truth;
  for (int i = 0; i <= 10; ++i) truth.poses.push_back({after(i), {static_cast<double>(i), 0, 0}, 1.0, false});
  std::vector<StampedPose> trajectory;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back({after(t), {t, i < 90 ? 0.02 : 0.6, 0.1}});
  }
  trajectory.push_back({after(11.0), {100, 0, 0}});  // after the truth ended
  const TrajectoryScore score = trajectory_score(trajectory, truth);
  EXPECT_EQ(score.poses, 100u);
  EXPECT_NEAR(score.median_m, 0.02, 1e-6);
  EXPECT_NEAR(score.max_m, 0.6, 1e-6);
  EXPECT_NEAR(score.p95_m, 0.6, 1e-6);
  EXPECT_NEAR(score.share_beyond_half_metre, 0.1, 1e-9);
  EXPECT_NEAR(score.median_heading_rad, 0.1, 1e-9);
}

TEST(Truth, ReadsBackWhatWasWritten) {
  const test::TemporaryFolder folder;
  const Change shift{ChangeKind::kShifted, 7, {{1, 2}, 3, 4, 0.5}, Box{{1.5, 2}, 3, 4, 0.5}};
  const std::string text = truth_header("hall.yaml", 9) + "\n" +
                           truth_line(TruthPose{after(1.25), {1.5, -2.5, 0.125}, 0.4, true}) + "\n" +
                           truth_line(TruthChange{after(1.0), shift}) + "\n" +
                           truth_line(TruthPose{after(0.5), {1, 2, 3}, 0.0, false}) + "\n{\"t_ns\": 17";
  const Truth truth = read_truth(folder.write("truth.jsonl", text));
  EXPECT_EQ(truth.world, "hall.yaml");
  EXPECT_EQ(truth.seed, 9u);
  ASSERT_EQ(truth.poses.size(), 2u) << "the cut last line is left out";
  EXPECT_EQ(truth.poses[1].time, after(1.25));
  EXPECT_EQ(truth.poses[1].map_from_robot, (Pose2{1.5, -2.5, 0.125}));
  EXPECT_TRUE(truth.poses[1].at_scan);
  ASSERT_EQ(truth.changes.size(), 1u);
  EXPECT_EQ(truth.changes[0].change.id, 7);
  EXPECT_EQ(truth.changes[0].change.box.height_m, 4.0);
  EXPECT_EQ(truth.changes[0].change.from->centre.x(), 1.5);
}

TEST(ChangeScore, CountsNothingAsSeenBehindAnActorThatStands) {
  const Fixture given;
  Truth truth = standing_for(30.0, {{after(5.0), given.arrival}});
  const Box forklift{{6, 2.5}, 2.4, 11.0, radians(90)};  // right across the room
  const auto seen_s = [&] {
    return change_score(given.scenario, truth, given.before, given.before, {}).changes.at(0).seen_s;
  };
  EXPECT_GT(seen_s(), 20.0);
  truth.events = {{after(1.0), {MoverEvent::Kind::kStopped, 0, forklift}}};
  EXPECT_EQ(seen_s(), 0.0);
  truth.events.push_back({after(20.0), {MoverEvent::Kind::kWent, 0, {}}});
  EXPECT_NEAR(seen_s(), 10.0, 0.5);
}

TEST(ChangeScore, SeesThroughGlassAndNotThroughAShutDoor) {
  const std::string room = "walls:\n  - [[0, 0], [12, 0], [12, 10], [0, 10], [0, 0]]\nrobot:\n  start: [6, 1, 90]\n";
  const Truth truth = standing_for(30.0, {{after(5.0), {ChangeKind::kAdded, 50, kRight, std::nullopt}}});
  const auto seen_s = [&](const std::string& between) {
    const Scenario scenario = parse_scenario(room + between, "room.yaml");
    const OccupancyGrid before = survey(scenario.world);
    return change_score(scenario, truth, before, before, {}).changes.at(0).seen_s;
  };
  EXPECT_GT(seen_s("glass:\n  - line: [[0, 2], [12, 2]]\n"), 20.0);
  EXPECT_EQ(seen_s("doors:\n  - leaf: [0, 2, 12, 2]\n"), 0.0);
}

TEST(ChangeScore, CallsAStandingActorAndADoorNoGhosts) {
  Scenario scenario = room_with_one_container();
  scenario.doors.push_back({.closed = {{9, 0}, {9, 3}}});
  const OccupancyGrid before = survey(scenario.world);
  const Box forklift{{2, 2}, 2.4, 1.2, 0.0};
  World drawn = scenario.world.with({90, ObjectKind::kPost, forklift});
  drawn = drawn.with({91, ObjectKind::kDoor, Polyline{{{9, 0}, {9, 3}}}});
  Truth truth = standing_for(5.0, {});
  truth.events = {{after(1.0), {MoverEvent::Kind::kStopped, 0, forklift}},
                  {after(2.0), {MoverEvent::Kind::kOpened, 0, {}}}};
  EXPECT_EQ(change_score(scenario, truth, before, survey(drawn), {}).ghosts_m2, 0.0);
  truth.events.push_back({after(3.0), {MoverEvent::Kind::kWent, 0, {}}});
  EXPECT_GT(change_score(scenario, truth, before, survey(drawn), {}).ghosts_m2, 0.2) << "the actor's outline stayed";
}

TEST(Truth, ReadsBackWhatActorsAndDoorsDid) {
  const test::TemporaryFolder folder;
  const std::string pose = truth_line(TruthPose{after(0.0), {}, 0.0, false}) + "\n";
  const auto written = [&](const MoverEvent& event) { return truth_line(TruthEvent{after(1.0), event}) + "\n"; };
  const Truth truth = read_truth(folder.write(
      "truth.jsonl", pose + written({MoverEvent::Kind::kStopped, 3, {{1, 2}, 2.4, 1.2, 0.5}}) +
                         written({MoverEvent::Kind::kWent, 3, {}}) + written({MoverEvent::Kind::kShut, 1, {}})));
  ASSERT_EQ(truth.events.size(), 3u);
  EXPECT_EQ(truth.events[0].event.box.theta_rad, 0.5);
  EXPECT_EQ(truth.events[1].event.kind, MoverEvent::Kind::kWent);
  EXPECT_EQ(truth.events[2].event.index, 1);
  const auto bad =
      folder.write("bad.jsonl", pose + "{\"t_ns\": 1, \"mover\": {\"kind\": \"flew\", \"index\": 1}}\n{}\n");
  EXPECT_THROW((void)read_truth(bad), std::runtime_error);
}

TEST(Truth, ReadsBackAPushOfAContainerThatCreeps) {
  const test::TemporaryFolder folder;
  const Change push{ChangeKind::kCrept, 7, {{1.05, 2}, 3, 4, 0}, Box{{1, 2}, 3, 4, 0}};
  const auto file = folder.write("truth.jsonl", truth_line(TruthPose{after(0.0), {}, 0.0, false}) + "\n" +
                                                    truth_line(TruthChange{after(1.0), push}) + "\n");
  EXPECT_EQ(read_truth(file).changes.at(0).change.kind, ChangeKind::kCrept);
}

TEST(Truth, NamesFileAndLineOfWhatItCannotRead) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("truth.jsonl", "{\"world\": \"a\"}\n{\"t_ns\": 1, \"pose\": [1, 2]}\n{}\n");
  try {
    (void)read_truth(file);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(file.string() + ": line 2: ", 0), 0u) << error.what();
  }
  EXPECT_THROW((void)read_truth(folder.write("empty.jsonl", "")), std::runtime_error);
  EXPECT_THROW((void)read_truth(folder.path() / "missing.jsonl"), std::runtime_error);
  EXPECT_THROW((void)read_trajectory(folder.write("t.tum", "1.0 2.0\n")), std::runtime_error);
}

}  // namespace
}  // namespace deltamap::simulation::score
