// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/hypothesis_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"
#include "tests/support/worlds/drawn_hall.hpp"
#include "tests/support/worlds/symmetric_hall.hpp"

namespace deltamap::localization::hypotheses {
namespace {

using test::symmetric_hall;
using test::turned_about_the_middle;

const Pose2 kMotion{0.1, 0.0, 0.1};  // of each scan: round a circle of 1 m

/// A robot that drives in circles; `believed` is where it is thought to be, carried along by exact wheels.
class Round {
 public:
  Round(const OccupancyGrid& map, const OccupancyGrid& world, const Pose2& truth, std::uint64_t seed,
        const HypothesisTrackerParams& params = {})
      : world_{world}, truth_{truth}, random_{seed}, field_{map, {}}, tracker_{params, {}, map, field_, seed} {}

  [[nodiscard]] HypothesisTracker& others() { return tracker_; }
  [[nodiscard]] const Pose2& truth() const { return truth_; }

  void carry_to(const Pose2& truth) { truth_ = truth; }
  void tell_that_it_was_carried() { is_told_ = true; }

  const HypothesisReport& step(std::optional<Pose2> believed, double held = 0.0, const Pose2& motion = kMotion) {
    truth_ = truth_ * motion;
    joined_ = joined_ * motion;
    return tracker_.observe(field_, {.ends = test::cast_ends(world_, truth_, {}, random_),
                                     .continuous_odom_from_robot = joined_,
                                     .map_from_believed = believed,
                                     .stable_support = held,
                                     .kidnapped = is_told_});
  }

 private:
  const OccupancyGrid& world_;
  Pose2 truth_;
  Pose2 joined_;
  bool is_told_ = false;
  Random random_;
  sensor::LikelihoodField field_;
  HypothesisTracker tracker_;
};

bool near(const Pose2& a, const Pose2& b) {
  return distance_between(a, b) < 0.2 && std::abs(turn_between(a.theta, b.theta)) < radians(5.0);
}

TEST(PoseHypotheses, LeaveNearlyAllBeliefToAPoseThatFits) {
  const OccupancyGrid map = test::drawn_flat();
  Round round{map, map, {1.6, 1.0, 0.0}, 1};
  round.others().start_believing();
  for (int i = 0; i < 100; ++i) {
    const HypothesisReport& report = round.step(round.truth() * kMotion);
    ASSERT_TRUE(report.own_known);
    ASSERT_GT(report.own_share, 0.98) << i;
  }
}

/// The least share of the belief that a right pose, which a search has found, holds while the whole map is searched
/// beside it.
double least_share_after_search() {
  const OccupancyGrid map = test::drawn_flat();
  Round round{map, map, {1.6, 1.0, 0.0}, 1};
  round.others().start_anywhere();
  for (int i = 0; i < 50; ++i) (void)round.step(std::nullopt);
  round.others().start_believing_in(round.truth());
  round.others().suspect(true);
  double least = 1.0;
  for (int i = 0; i < 150; ++i) {
    const double share = round.step(round.truth() * kMotion).own_share;
    if (i >= 20) least = std::min(least, share);
  }
  return least;
}

TEST(PoseHypotheses, LeaveMostBeliefToAPoseThatWasFoundAndFits) { EXPECT_GT(least_share_after_search(), 0.8); }

TEST(PoseHypotheses, FindHypothesesThatFitAsWellAndNeverPreferThem) {
  const OccupancyGrid map = symmetric_hall();
  Round round{map, map, {6.0, 4.0, 0.0}, 2};
  round.others().start_believing();
  int others_known = 0;
  for (int i = 0; i < 300; ++i) {
    const HypothesisReport& report = round.step(round.truth() * kMotion);
    ASSERT_GT(report.own_share, 0.99) << i;
    others_known = 0;
    for (std::size_t rank = 0; rank < report.listed; ++rank) {
      for (int quarters = 1; quarters < 4; ++quarters) {
        others_known +=
            near(report.others[rank].map_from_robot, turned_about_the_middle(round.truth(), quarters)) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(others_known, 3);
}

/// Metres until another hypothesis holds nearly all belief against a wrong pose.
double driven_until_won_m(const OccupancyGrid& map, double held) {
  constexpr double kMost_m = 40.0;
  Round round{map, map, {1.6, 1.0, 0.0}, 1};
  round.others().start_believing();
  Pose2 believed{7.5, 3.0, 1.5};
  double driven_m = 0.0;
  for (bool won = false; !won && driven_m < kMost_m; driven_m += 0.1) {
    believed = believed * kMotion;
    const HypothesisReport& report = round.step(believed, held);
    won = report.listed > 0 && report.others[0].share > 0.98;
  }
  return driven_m;
}

TEST(PoseHypotheses, HaveToOutdoWhatProvenTilesSayForThePose) {
  const OccupancyGrid map = test::drawn_flat();
  EXPECT_GT(driven_until_won_m(map, 1.0), driven_until_won_m(map, 0.0) + 0.2);
}

/// A robot that slips and is believed 0.6 m beside where it is, until aliases of its true hypothesis speak against
/// that.
void slipped_until_heard_of(Round& round) {
  round.others().start_believing();
  for (int i = 0; i < 100; ++i) (void)round.step(round.truth() * kMotion);
  Pose2 believed = round.truth() * Pose2{0.0, 0.6, 0.0};
  for (int i = 0; i < 50; ++i) {
    believed = believed * kMotion;
    if (round.step(believed).kidnapped_share > 0.5) return;
  }
  ADD_FAILURE() << "no image is heard of";
}

HypothesisTrackerParams without_probes_nearby() {
  HypothesisTrackerParams params;
  params.probes_nearby = 0;
  return params;
}

TEST(PoseHypotheses, BeginAnewToSpeakOfACarryingOnceASlipHasBeenMended) {
  const OccupancyGrid map = symmetric_hall();
  Round round{map, map, {6.0, 4.0, 0.0}, 2, without_probes_nearby()};
  slipped_until_heard_of(round);
  round.others().start_believing_in(round.truth());
  EXPECT_LT(round.others().report().kidnapped_share, 0.01);
  EXPECT_LT(round.step(round.truth() * kMotion).kidnapped_share, 0.01);
}

TEST(PoseHypotheses, BeginAnewToSpeakOfACarryingWhereTheBelievedPoseIsCorrected) {
  const OccupancyGrid map = symmetric_hall();
  Round round{map, map, {6.0, 4.0, 0.0}, 2, without_probes_nearby()};
  slipped_until_heard_of(round);
  EXPECT_LT(round.step(round.truth() * kMotion).kidnapped_share, 0.01);
}

/// The share of a hypothesis where the robot may have been carried, in a hall of four quarters that look alike but for
/// what `map` and `world` have beside, some scans after such hypotheses are found.
double share_of_newcomers(const OccupancyGrid& map, const OccupancyGrid& world) {
  HypothesisTrackerParams params;
  params.probes = 0;
  params.probes_nearby = 0;
  params.kidnapped_now_prior = 0.3;
  Round round{map, world, {6.0, 4.0, 0.0}, 2, params};
  round.others().start_believing();
  for (int i = 0; i < 30; ++i) (void)round.step(round.truth() * kMotion);
  round.others().suspect(true);
  HypothesisReport report;
  for (int i = 0; i < 12; ++i) report = round.step(round.truth() * kMotion);
  EXPECT_GT(report.listed, 0u) << "none is found";
  return report.kidnapped_share;
}

/// The screen between two corners, a quarter turn about the middle of the hall further on for each of `quarters`.
void put_screen(OccupancyGrid& grid, const Point2& low, const Point2& high, int quarters) {
  const Point2 one = turned_about_the_middle({low.x(), low.y(), 0.0}, quarters).position();
  const Point2 other = turned_about_the_middle({high.x(), high.y(), 0.0}, quarters).position();
  test::fill_box(grid, one.cwiseMin(other), one.cwiseMax(other), CellState::kOccupied);
}

TEST(PoseHypotheses, HoldAgainstANewcomerWhatItLosesWhereTheBelievedPoseFits) {
  OccupancyGrid map = symmetric_hall();
  OccupancyGrid world = map;
  // Has come, where the next quarter has always had one.
  put_screen(world, {10.6, 3.5}, {10.9, 8.5}, 0);
  put_screen(map, {10.6, 3.5}, {10.9, 8.5}, 1);
  EXPECT_GT(share_of_newcomers(map, world), 0.4);
  // Has always been here, and not in the next quarter.
  put_screen(world, {1.0, 4.5}, {1.3, 5.5}, 0);
  put_screen(map, {1.0, 4.5}, {1.3, 5.5}, 0);
  EXPECT_EQ(share_of_newcomers(map, world), 0.0);
}

/// A robot that knew where it was and has been carried to another room.
double share_when_heard_of(Round& round, HypothesisReport& report) {
  round.others().start_believing();
  for (int i = 0; i < 100; ++i) (void)round.step(round.truth() * kMotion);
  round.others().suspect(true);
  Pose2 believed = round.truth();
  round.carry_to({7.5, 3.0, 1.5});
  for (int i = 0; i < 100; ++i) {
    believed = believed * kMotion;
    report = round.step(believed);
    if (report.kidnapped_share > 0.5) return report.others[0].share;
  }
  return 1.0;
}

TEST(PoseHypotheses, TellThatTheRobotMayHaveBeenCarriedLongBeforeTheyWin) {
  const OccupancyGrid map = test::drawn_flat();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Round round{map, map, {1.6, 1.0, 0.0}, seed};
    HypothesisReport report;
    EXPECT_LT(share_when_heard_of(round, report), 0.5) << seed;
    EXPECT_TRUE(near(report.map_from_kidnapped, round.truth())) << seed;
  }
}

/// Scans until the true pose is heard of in the whole map, which is searched as the robot is carried.
int scans_until_found(bool is_suspected, bool is_told) {
  HypothesisTrackerParams params;
  params.probes = 0;
  params.probes_nearby = 0;
  const OccupancyGrid map = test::drawn_flat();
  Round round{map, map, {1.6, 1.0, 0.0}, 1, params};
  round.others().start_believing();
  for (int i = 0; i < 30; ++i) (void)round.step(round.truth() * kMotion);
  round.others().suspect(is_suspected);
  Pose2 believed = round.truth() * kMotion;
  (void)round.step(believed);
  round.carry_to({7.5, 3.0, 1.5});
  if (is_told) round.tell_that_it_was_carried();
  for (int i = 1; i < 100; ++i) {
    believed = believed * kMotion;
    const HypothesisReport& report = round.step(believed);
    for (std::size_t k = 0; k < report.listed; ++k) {
      if (near(report.others[k].map_from_robot, round.truth())) return i;
    }
  }
  return 100;
}

TEST(PoseHypotheses, AreLookedForAsFastAsFromNowhereOnceTheRobotWasCarried) {
  EXPECT_LT(scans_until_found(true, true), 8);
  EXPECT_LT(scans_until_found(false, true), 8) << "though nothing else speaks against the pose";
  EXPECT_GT(scans_until_found(true, false), 2 * scans_until_found(true, true));
  EXPECT_EQ(scans_until_found(false, false), 100);
}

TEST(PoseHypotheses, WinOverAWrongPoseWithinMetresAndLeadTheSearchToTheTruth) {
  const OccupancyGrid map = test::drawn_flat();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Round round{map, map, {1.6, 1.0, 0.0}, seed};
    round.others().start_believing();
    Pose2 believed{7.5, 3.0, 1.5};
    double driven_m = 0.0;
    bool won = false;
    while (!won && driven_m < 15.0) {
      believed = believed * kMotion;
      const HypothesisReport& report = round.step(believed);
      driven_m += 0.1;
      won = report.listed > 0 && report.others[0].share > 0.98;
    }
    ASSERT_TRUE(won) << seed;
    round.others().stop_believing();
    for (int i = 0; i < 60; ++i) (void)round.step(std::nullopt);
    const std::optional<PoseHypothesis> best = round.others().best_hypothesis();
    ASSERT_TRUE(best) << seed;
    EXPECT_TRUE(near(best->map_from_robot, round.truth())) << seed << ": another room looks alike at first";
    EXPECT_GT(best->share, 0.98) << seed;
  }
}

TEST(PoseHypotheses, FindTheRobotAfterASlip) {
  const OccupancyGrid map = test::drawn_flat();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Round round{map, map, {1.6, 1.0, 0.0}, seed};
    round.others().start_believing();
    bool won = false;
    for (int i = 0; i < 60 && !won; ++i) {
      const Pose2 next = round.truth() * kMotion;
      const HypothesisReport& report = round.step(Pose2{next.x + 0.5, next.y + 0.5, next.theta});
      won = report.listed > 0 && report.others[0].share > 0.98;
      if (won) {
        EXPECT_TRUE(near(report.others[0].map_from_robot, round.truth())) << seed;
      }
    }
    EXPECT_TRUE(won) << seed;
  }
}

TEST(PoseHypotheses, ShareTheBeliefAmongSymmetricHypothesesWithoutCollapsing) {
  const OccupancyGrid map = symmetric_hall();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Round round{map, map, {6.0, 4.0, 0.0}, seed};
    round.others().start_anywhere();
    for (int i = 0; i < 400; ++i) {
      const HypothesisReport& report = round.step(std::nullopt);
      EXPECT_FALSE(report.own_known);
      if (i < 100) continue;
      ASSERT_EQ(report.listed, 4u) << i;
      ASSERT_LT(report.others[0].share, 0.9) << i;
      ASSERT_GT(report.others[3].share, 0.01) << i;
    }
  }
}

TEST(PoseHypotheses, SettleOnTheOneHypothesisThatFitsWhereNothingIsBelieved) {
  const OccupancyGrid map = test::drawn_flat();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Round round{map, map, {1.6, 1.0, 0.0}, seed};
    round.others().start_anywhere();
    EXPECT_FALSE(round.others().best_hypothesis());
    for (int i = 0; i < 50; ++i) (void)round.step(std::nullopt);
    const auto best = round.others().best_hypothesis();
    ASSERT_TRUE(best);
    EXPECT_GT(best->share, 0.98) << seed;
    EXPECT_TRUE(near(best->map_from_robot, round.truth())) << seed;
  }
}

TEST(PoseHypotheses, RestWhileTheRobotStandsAndAreRefinedAgainOnceItDrivesOn) {
  const OccupancyGrid map = test::drawn_flat();
  Round round{map, map, {1.6, 1.0, 0.0}, 1};
  round.others().start_anywhere();
  const auto best_after = [&round](const Pose2& motion) {
    (void)round.step(std::nullopt, 0.0, motion);
    return round.others().best_hypothesis()->map_from_robot;
  };
  for (int i = 0; i < 200; ++i) (void)round.step(std::nullopt, 0.0, {});
  const Pose2 stands = round.others().best_hypothesis()->map_from_robot;
  EXPECT_EQ(best_after({}), stands) << "noise tells nothing new";
  const Pose2 driven{0.02, 0.0, 0.0};
  EXPECT_NE(best_after(driven), stands * driven);
}

TEST(PoseHypotheses, LearnNothingWhileTheRobotStands) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  HypothesisTracker others{{}, {}, map, field, 1};
  others.start_believing();
  Random random{1};
  const Pose2 truth{1.6, 1.0, 0.0};
  for (int i = 0; i < 200; ++i) {
    const HypothesisReport& report = others.observe(field, {.ends = test::cast_ends(map, truth, {}, random),
                                                            .continuous_odom_from_robot = {},
                                                            .map_from_believed = Pose2{7.5, 3.0, 1.5}});
    ASSERT_GT(report.own_share, 0.9) << "one view is no evidence, however often it is repeated";
  }
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
