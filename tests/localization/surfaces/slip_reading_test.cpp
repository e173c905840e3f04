// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/slip_reading.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "localization/sensor/scan_segments.hpp"

namespace deltamap::localization::surfaces {
namespace {

const PoseCovariance kKnown = Eigen::Vector3d{2.5e-5, 2.5e-5, 1e-6}.asDiagonal();
const PoseCovariance kSlip = Eigen::Vector3d{0.04, 0.04, 0.0076}.asDiagonal();

Surface facing(const Point2& normal, const Point2& centre) {
  return {.centre = centre, .normal = normal, .half_length_m = 1.0};
}

/// A robot that stands at the origin by its wheels, and the surfaces around it.
class Surroundings {
 public:
  Surroundings() { state_.start({Pose2{}, kKnown}); }

  /// Followed, and last seen `stands_m` along its normal from where the map has it.
  std::size_t follow(const Surface& surface, double stands_m, double unseen_m) {
    const bool holds = std::abs(stands_m) < 0.05;
    switches_.push_back({.surface = surface, .holds = holds ? 1.0 : 0.0, .unseen_m = unseen_m});
    state_.append(stands_m, 0.01, 0.003);
    return switches_.size() - 1;
  }
  /// The scan shows it, from where the robot truly is; a followed one stands where it was last seen.
  void show(const Surface& surface, double stands_m, const Pose2& truth, int followed_as) {
    const auto number = static_cast<std::int32_t>(records_.size());
    records_.push_back({.surface = surface, .followed_as = followed_as});
    Sighting sighting{.id = {0, number}, .surface = surface, .beams = 21.0};
    const Pose2 robot_from_map = inverse(truth);
    const auto end = [&](int i) {
      return Point2{robot_from_map * Point2{surface.centre + stands_m * surface.normal + 0.05 * i * surface.tangent()}};
    };
    for (int i = -10; i <= 10; ++i) sighting.mean += end(i) / sighting.beams;
    for (int i = -10; i <= 10; ++i) sighting.scatter += (end(i) - sighting.mean) * (end(i) - sighting.mean).transpose();
    sightings_.push_back(sighting);
    if (followed_as >= 0) in_view_.push_back(static_cast<std::size_t>(followed_as));
  }

  /// The surface shown last stood there at an earlier visit.
  void remember(double stood_m) { records_.back().offset_m = stood_m; }

  [[nodiscard]] SlipReading::Answer best_near(const Pose2& pose, SlipTime when, const PoseCovariance& slip) const {
    std::vector<bool> in_view(switches_.size());
    for (const std::size_t number : in_view_) in_view[number] = true;
    return SlipReading{state_, switches_, when, slip, in_view}.best_near(
        pose, [&](const Pose2&) { return std::span<const Sighting>{sightings_}; },
        [&](SurfaceMap::Id id) -> const SurfaceRecord& { return records_[static_cast<std::size_t>(id.number)]; });
  }
  /// How much better a slip near a pose explains what is seen than none, nats.
  [[nodiscard]] double gain(const Pose2& near, SlipTime when) const {
    return best_near(near, when, kSlip).evidence - best_near({}, when, PoseCovariance::Zero()).evidence;
  }

 private:
  OffsetState state_;
  std::vector<SurfaceSwitch> switches_;
  std::vector<SurfaceRecord> records_;
  std::vector<Sighting> sightings_;
  std::vector<std::size_t> in_view_;
};

constexpr double kInView = 0.2;
const Surface kLeft = facing({0.0, -1.0}, {1.0, 2.0});
const Surface kRight = facing({0.0, 1.0}, {1.0, -2.0});
const Surface kAhead = facing({-1.0, 0.0}, {5.0, 0.0});

TEST(SlipReading, LeavesAContainerThatWasMovedWhereItWasLastSeen) {
  Surroundings around;
  const Pose2 truth{0.0, 0.0, 0.08};
  for (const Surface& wall : {kLeft, kRight}) {
    around.show(wall, 0.0, truth, static_cast<int>(around.follow(wall, 0.0, kInView)));
  }
  around.show(kAhead, 0.35, truth, static_cast<int>(around.follow(kAhead, 0.35, kInView)));
  const SlipReading::Answer answer = around.best_near({0.3, 0.0, 0.1}, SlipTime::kNow, kSlip);
  EXPECT_NEAR(answer.pose.x, truth.x, 0.02);
  EXPECT_NEAR(answer.pose.theta, truth.theta, 0.005);
  EXPECT_TRUE(answer.read_wrong.empty());
  EXPECT_GT(around.gain({0.3, 0.0, 0.1}, SlipTime::kNow), 10.0);
}

TEST(SlipReading, AsksNothingThatWasSeenBeforeASlipJustNow) {
  Surroundings around;
  (void)around.follow(kAhead, 0.35, 4.0);
  EXPECT_LE(around.gain({0.35, 0.0, 0.0}, SlipTime::kNow), 0.0);
}

TEST(SlipReading, UndoesAMoveByASlipThatLiesBehind) {
  Surroundings around;
  const std::size_t moved = around.follow(kAhead, 0.35, 4.0);
  const std::size_t seen_before = around.follow(facing({-1.0, 0.0}, {5.0, 4.0}), 0.0, 6.0);
  const Pose2 where_it_holds{0.35, 0.0, 0.0};
  EXPECT_GT(around.gain(where_it_holds, SlipTime::kBehind), 3.0);
  const std::vector<std::size_t> wrong = around.best_near(where_it_holds, SlipTime::kBehind, kSlip).read_wrong;
  EXPECT_EQ(wrong, std::vector{moved});
  EXPECT_EQ(std::find(wrong.begin(), wrong.end(), seen_before), wrong.end());
}

TEST(SlipReading, HoldsASlipThatLiesBehindAgainstAllThatWasSeenSince) {
  Surroundings around;
  (void)around.follow(kAhead, 0.35, 4.0);
  (void)around.follow(facing({-1.0, 0.0}, {5.0, 4.0}), 0.0, 3.0);
  (void)around.follow(facing({1.0, 0.0}, {-3.0, 2.0}), 0.0, 2.0);
  EXPECT_LE(around.gain({0.35, 0.0, 0.0}, SlipTime::kBehind), 0.0);
}

TEST(SlipReading, GivesASurfaceThatIsSeenForTheFirstTimeTheWeightOfTheMap) {
  const Pose2 turned{0.0, 0.0, 0.08};
  Surroundings known;
  Surroundings with_a_new_one;
  for (Surroundings* around : {&known, &with_a_new_one}) {
    for (const Surface& wall : {kLeft, kRight}) {
      around->show(wall, 0.0, turned, static_cast<int>(around->follow(wall, 0.0, kInView)));
    }
  }
  // Where the map has it, had the robot not turned.
  with_a_new_one.show(kAhead, 0.0, {}, SurfaceRecord::kNotFollowed);
  const double lost = known.gain(turned, SlipTime::kNow) - with_a_new_one.gain(turned, SlipTime::kNow);
  EXPECT_GT(lost, 0.0);
  EXPECT_LT(lost, 7.0);  // one that was in view just before would say 12
}

TEST(SlipReading, ExpectsASurfaceWhereItStoodAtTheLastVisit) {
  const Pose2 truth{0.1, 0.0, 0.0};
  Surroundings around;
  around.show(kAhead, 0.35, truth, SurfaceRecord::kNotFollowed);
  around.remember(0.35);
  EXPECT_NEAR(around.best_near({0.0, 0.0, 0.0}, SlipTime::kNow, kSlip).pose.x, truth.x, 0.01);
}

}  // namespace
}  // namespace deltamap::localization::surfaces
