// SPDX-License-Identifier: Apache-2.0
// When the gate shuts and why, and what it proves.
#include "mapping/gate/write_gate.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "tests/mapping/straight_drive.hpp"

namespace deltamap::mapping::gate {
namespace {

/// Scans broke off at this time, and the map fits worse since then or not.
TrackedScan broken_off(TrackedScan tracked, std::optional<Timestamp> at, bool fits_worse = false) {
  tracked.estimate.belief.broke_off_at = at;
  tracked.estimate.belief.fits_worse = fits_worse;
  return tracked;
}

void drive(StraightDrive& robot, WriteGate& gate, double duration_s, std::optional<Timestamp> broke_off_at = {}) {
  for (double t = 0.0; t < duration_s - 1e-9; t += kPeriod_s) gate.observe(broken_off(robot.next(), broke_off_at));
}

/// After 10 s at a sure pose.
class DrivenGate : public testing::Test {
 protected:
  void SetUp() override { drive(robot, gate, 10.0); }

  StraightDrive robot;
  WriteGate gate{{}};
};

template <typename Change>
GateReason reason_after(Change change) {
  StraightDrive robot;
  WriteGate gate{{}};
  drive(robot, gate, 10.0);
  EXPECT_TRUE(gate.is_open());
  TrackedScan tracked = robot.next();
  change(tracked.estimate);
  gate.observe(tracked);
  return gate.reason();
}

TEST(WriteGate, IsOpenWhileThePoseIsSure) {
  StraightDrive robot;
  WriteGate gate{{}};
  drive(robot, gate, 60.0);
  EXPECT_TRUE(gate.is_open());
  EXPECT_EQ(shut_s(gate.times()), 0.0);
  EXPECT_NEAR(observed_s(gate.times()), 60.0, 2 * kPeriod_s);
}

TEST(WriteGate, TellsWhyItIsShut) {
  EXPECT_EQ(reason_after([](Estimate& e) { e.state = LocalizerState::kLost; }), GateReason::kLost);
  EXPECT_EQ(reason_after([](Estimate& e) { e.state = LocalizerState::kGlobal; }), GateReason::kSearching);
  EXPECT_EQ(reason_after([](Estimate& e) { e.belief.verdict = PoseVerdict::kWrong; }), GateReason::kWrong);
  EXPECT_EQ(reason_after([](Estimate& e) { e.belief.pose_right = 0.6; }), GateReason::kDoubtful);
  EXPECT_EQ(reason_after([](Estimate& e) { e.belief.pose_right = 0.2; }), GateReason::kDisbelieved);
  EXPECT_EQ(reason_after([](Estimate& e) { e.belief.other_share = 0.5; }), GateReason::kOtherHypothesis);
  EXPECT_EQ(reason_after([](Estimate& e) { ++e.relocalizations; }), GateReason::kRelocalized);
  EXPECT_EQ(reason_after([](Estimate& e) { e.map_from_robot.x += 1.0; }), GateReason::kOpen) << "the wheels slip";
  EXPECT_EQ(reason_after([](Estimate& e) { e.covariance(1, 1) = 1.0; }), GateReason::kSpread);
  EXPECT_EQ(reason_after([](Estimate& e) { e.belief.elsewhere = {.expected = 2, .fit = 2}; }), GateReason::kSpread);
}

TEST_F(DrivenGate, IsShutWhileASensorIsOtherThanBelieved) {
  for (const auto& [doubt, reason] : {std::pair{SensorDoubt::kWheels, GateReason::kWheels},
                                      {SensorDoubt::kMount, GateReason::kMount},
                                      {SensorDoubt::kScale, GateReason::kScale}}) {
    TrackedScan tracked = robot.next();
    tracked.sensor_doubt = doubt;
    gate.observe(tracked);
    EXPECT_EQ(gate.reason(), reason);
    EXPECT_FALSE(gate.has_proven_wrong()) << name_of(reason);
    gate.observe(robot.next());
    EXPECT_TRUE(gate.is_open());
  }
  EXPECT_EQ(shut_by_reason(gate.times()).count("mount"), 1u);
}

TEST(WriteGate, IsOpenWhereTheMapExpectsNothingWhileWheelsAndScansCarryThePoseOn) {
  const auto without_beams = [](Estimate& e) { e.belief.elsewhere = e.belief.stable = {}; };
  EXPECT_EQ(reason_after(without_beams), GateReason::kSpread);
  EXPECT_EQ(reason_after([&](Estimate& e) {
              without_beams(e);
              e.belief.is_carried = true;
            }),
            GateReason::kOpen);
}

TEST(WriteGate, SeesTheSpreadAlongASlantingAxis) {
  EXPECT_EQ(reason_after([](Estimate& e) {
              e.covariance(0, 0) = e.covariance(1, 1) = 0.06;
              e.covariance(0, 1) = e.covariance(1, 0) = 0.055;
            }),
            GateReason::kSpread);
}

TEST_F(DrivenGate, DoubtShutsItAndProvesNothing) {
  TrackedScan tracked = robot.next();
  tracked.estimate.belief.pose_right = 0.6;
  gate.observe(tracked);
  EXPECT_FALSE(gate.is_open());
  EXPECT_FALSE(gate.has_proven_wrong());
  gate.observe(robot.next());
  EXPECT_TRUE(gate.is_open());
  EXPECT_FALSE(gate.trusted_since());
}

TEST_F(DrivenGate, AWrongPoseIsToldOnceAndHasToHoldBeforeItOpensAgain) {
  int told = 0;
  for (int i = 0; i < 20; ++i) {
    TrackedScan tracked = robot.next();
    tracked.estimate.state = LocalizerState::kLost;
    gate.observe(tracked);
    told += gate.has_proven_wrong() ? 1 : 0;
  }
  EXPECT_EQ(told, 1);
  drive(robot, gate, 19.7);
  EXPECT_EQ(gate.reason(), GateReason::kConfirming);
  EXPECT_EQ(gate.confirms_after(), GateReason::kLost);
  drive(robot, gate, 0.6);
  EXPECT_EQ(gate.confirms_after(), GateReason::kOpen);
  EXPECT_TRUE(gate.is_open());
  EXPECT_NEAR(seconds(robot.now() - *gate.trusted_since()), 0.0, 0.6);
  const auto shut = shut_by_reason(gate.times());
  EXPECT_NEAR(shut.at("lost"), 2.0, 2 * kPeriod_s);
  EXPECT_NEAR(shut.at("confirming"), 20.0, 3 * kPeriod_s);
  EXPECT_EQ(shut.size(), 2u);
}

/// Shuts it for so long without a proof.
void doubt(StraightDrive& robot, WriteGate& gate, double duration_s) {
  for (double t = 0.0; t < duration_s - 1e-9; t += kPeriod_s) {
    TrackedScan tracked = robot.next();
    tracked.estimate.belief.pose_right = 0.6;
    gate.observe(tracked);
  }
}

/// Shuts it by one scan at a pose that is rather wrong, followed all along.
void disbelieve(StraightDrive& robot, WriteGate& gate) {
  TrackedScan tracked = robot.next();
  tracked.estimate.belief.pose_right = 0.2;
  gate.observe(tracked);
}

TEST_F(DrivenGate, APoseThatWasFollowedAllAlongIsConfirmedSoonerThanOneThatWasFound) {
  disbelieve(robot, gate);
  drive(robot, gate, 7.7);
  EXPECT_EQ(gate.reason(), GateReason::kConfirming);
  EXPECT_EQ(gate.confirms_after(), GateReason::kDisbelieved);
  drive(robot, gate, 0.6);
  EXPECT_TRUE(gate.is_open());
}

TEST_F(DrivenGate, WhatASearchHasFoundRemainsFoundWhateverSpeaksAgainstItLater) {
  TrackedScan tracked = robot.next();
  tracked.estimate.state = LocalizerState::kGlobal;
  gate.observe(tracked);
  drive(robot, gate, 5.0);
  disbelieve(robot, gate);
  EXPECT_EQ(gate.confirms_after(), GateReason::kSearching);
  drive(robot, gate, 19.7);
  EXPECT_EQ(gate.reason(), GateReason::kConfirming);
  drive(robot, gate, 0.6);
  EXPECT_TRUE(gate.is_open());
}

TEST_F(DrivenGate, ADoubtForAMomentHoldsUpAConfirmationAndAProofBeginsItAnew) {
  disbelieve(robot, gate);
  drive(robot, gate, 5.0);
  doubt(robot, gate, 2.0);
  drive(robot, gate, 2.7);
  EXPECT_FALSE(gate.is_open());
  drive(robot, gate, 0.6);
  EXPECT_TRUE(gate.is_open());
  disbelieve(robot, gate);
  drive(robot, gate, 5.0);
  disbelieve(robot, gate);
  drive(robot, gate, 7.7);
  EXPECT_FALSE(gate.is_open());
}

TEST(WriteGate, SearchingAtTheStartProvesNothing) {
  StraightDrive robot;
  WriteGate gate{{}};
  for (int i = 0; i < 50; ++i) {
    TrackedScan tracked = robot.next();
    tracked.estimate.state = LocalizerState::kGlobal;
    gate.observe(tracked);
    EXPECT_EQ(gate.reason(), GateReason::kSearching);
    EXPECT_FALSE(gate.has_proven_wrong());
  }
  EXPECT_NEAR(gate.shut_for_s(), 5.0, 3 * kPeriod_s);
  gate.observe(robot.next());
  EXPECT_TRUE(gate.is_open());
  EXPECT_EQ(gate.shut_for_s(), 0.0);
}

TEST_F(DrivenGate, AStandingRobotConfirmsNothing) {
  TrackedScan tracked = robot.next();
  tracked.estimate.state = LocalizerState::kLost;
  gate.observe(tracked);
  robot.speed_m_per_s = 0.0;
  drive(robot, gate, 600.0);
  EXPECT_EQ(gate.reason(), GateReason::kConfirming);
}

/// Of 150 beams that the map expects to end somewhere.
TrackedScan seeing(TrackedScan tracked, std::uint32_t short_of, std::uint32_t beyond) {
  tracked.estimate.belief.elsewhere = {150, 150 - short_of - beyond, short_of, beyond};
  return tracked;
}

TEST(WriteGate, StaysOpenWhereScansStopFittingAndNothingBreaksOff) {
  StraightDrive robot;
  WriteGate gate{{}};
  for (int i = 0; i < 100; ++i) gate.observe(seeing(robot.next(), 5, 5));
  for (int i = 0; i < 20; ++i) {
    gate.observe(seeing(robot.next(), 60, 40));
    EXPECT_TRUE(gate.is_open());
  }
}

TEST_F(DrivenGate, ABreakOfTheScansShutsItForAMomentWhereTheMapStillFits) {
  const Timestamp at = robot.now();
  drive(robot, gate, 0.9, at);
  EXPECT_EQ(gate.reason(), GateReason::kConfirming);
  drive(robot, gate, 0.4, at);
  EXPECT_TRUE(gate.is_open());
  EXPECT_FALSE(gate.trusted_since());  // nothing has proven wrong
}

TEST_F(DrivenGate, ABreakThatLiesAheadIsNoneWhereTheClockHasFallenBack) {
  drive(robot, gate, 1.0, robot.now() + duration_from_seconds(3600.0));
  EXPECT_TRUE(gate.is_open());
}

TEST_F(DrivenGate, ACarriedRobotWritesNothingUntilAsMuchFitsAsBefore) {
  const Timestamp at = robot.now();
  for (int i = 0; i < 400; ++i) {
    gate.observe(broken_off(robot.next(), at, true));
    ASSERT_FALSE(gate.is_open()) << i;
  }
  EXPECT_EQ(gate.confirms_after(), GateReason::kConfirming);
  drive(robot, gate, 7.7, at);
  EXPECT_FALSE(gate.is_open());
  drive(robot, gate, 0.6, at);
  EXPECT_TRUE(gate.is_open());
}

TEST_F(DrivenGate, ARobotThatIsCarriedWhileItsPoseIsConfirmedBeginsAnew) {
  disbelieve(robot, gate);
  drive(robot, gate, 7.0);
  const Timestamp at = robot.now();
  drive(robot, gate, 7.9, at);
  EXPECT_FALSE(gate.is_open());
  drive(robot, gate, 0.6, at);
  EXPECT_TRUE(gate.is_open());
}

TEST_F(DrivenGate, ARobotThatIsCarriedWhileItsPoseIsConfirmedHasTheWholeWayBeforeIt) {
  disbelieve(robot, gate);
  drive(robot, gate, 7.0);  // 3.5 of 4 m
  const Timestamp at = robot.now();
  robot.speed_m_per_s = 0.0;
  drive(robot, gate, 20.0, at);
  robot.speed_m_per_s = kSpeed_m_per_s;
  drive(robot, gate, 7.5, at);
  EXPECT_FALSE(gate.is_open()) << "what it drove before somebody carried it tells nothing of the pose since";
  drive(robot, gate, 1.0, at);
  EXPECT_TRUE(gate.is_open());
}

TEST(WriteGate, NamesTheOtherHypothesisThatLeavesThePoseDoubtful) {
  EXPECT_EQ(reason_after([](Estimate& e) {
              e.belief.pose_right = 0.6;
              e.belief.other_share = 0.4;
            }),
            GateReason::kOtherHypothesis);
  EXPECT_EQ(reason_after([](Estimate& e) {
              e.belief.pose_right = 0.2;
              e.belief.other_share = 0.8;
            }),
            GateReason::kDisbelieved);
}

}  // namespace
}  // namespace deltamap::mapping::gate
