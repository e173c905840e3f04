// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/loop_closing.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::surveying::slam {
namespace {

/// Keyframes whose links are measured with an error that bends the way.
class BentWay : public testing::Test {
 protected:
  void drive(const std::vector<Pose2>& way, double bend_rad_per_m) {
    double driven_m = 0.0;
    for (std::size_t i = 0; i < way.size(); i += 2) {
      Pose2 motion;
      if (i > 0) motion = motion_between(way[i - 2], way[i]);
      const double step_m = motion.position().norm();
      driven_m += step_m;
      survey.add(keyframe(test::seen_scan(hall, way[i], 0.01, random, 8.0), 0, driven_m));
      truth.push_back(way[i]);
      if (i == 0) continue;
      const auto node = static_cast<std::uint32_t>(survey.keyframes.size() - 1);
      motion.theta += bend_rad_per_m * step_m;
      survey.poses[node] = survey.poses[node - 1] * motion;
      survey.add({node - 1, node, motion, Eigen::Vector3d{1e-4, 1e-4, 4e-5}.asDiagonal(), false});
      loops.search_from(node);
    }
  }
  [[nodiscard]] double farthest_off_m() const {
    double most_m = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      most_m = std::max(most_m, distance_between(truth.front() * survey.poses[i], truth[i]));
    }
    return most_m;
  }
  [[nodiscard]] std::size_t loops_in_graph() const {
    return static_cast<std::size_t>(
        std::count_if(survey.links.begin(), survey.links.end(), [](const auto& link) { return link.may_drop; }));
  }

  OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{11};
  Survey survey = [] {
    Survey one;
    one.component = {0};
    return one;
  }();
  LoopClosing loops{survey};
  std::vector<Pose2> truth;
};

TEST_F(BentWay, IsStraightenedWhereTheRobotComesBack) {
  drive(test::rounds_of_the_hall(2), 0.0015);
  EXPECT_GT(loops_in_graph(), 10U);
  ASSERT_TRUE(loops.finish());
  EXPECT_LT(farthest_off_m(), 0.25) << "0.8 m without loops";
}

TEST_F(BentWay, HasNoLoopsBeforeTheRobotComesBack) {
  drive(test::way_along({{1.5, 1.2}, {18.7, 1.2}, {18.7, 7.0}}), 0.0);
  ASSERT_TRUE(loops.finish());
  EXPECT_EQ(loops_in_graph(), 0U);
}

TEST_F(BentWay, LosesALinkThatAllOthersContradict) {
  drive(test::rounds_of_the_hall(2), 0.0);
  const std::size_t before = loops_in_graph();
  const auto last = static_cast<std::uint32_t>(survey.keyframes.size() - 1);
  survey.add({last / 4, last, {3.0, 1.0, 0.5}, Eigen::Vector3d{1e-4, 1e-4, 1e-5}.asDiagonal(), true});
  ASSERT_TRUE(loops.finish());
  EXPECT_GE(loops.contradicted(), 1U);
  EXPECT_GE(loops_in_graph(), before) << "and no other";
  EXPECT_LT(farthest_off_m(), 0.1);
}

}  // namespace
}  // namespace deltamap::surveying::slam
