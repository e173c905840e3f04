// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/live_board.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "daemon/dashboard/wire.hpp"
#include "daemon/live/live_messages.hpp"
#include "daemon/live/live_stream.hpp"
#include "tests/support/bytes/live_decoding.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kPeriod_s = 0.25;

TrackedScan tracked_scan() {
  TrackedScan tracked;
  tracked.scan.beams = {{.range_m = 2.0F, .kind = BeamKind::kRange}, {.kind = BeamKind::kBeyondMaximum}};
  tracked.rays.resize(2);
  tracked.rays[0].end = {1.5F, -0.5F};
  return tracked;
}

LocalizationRow row_at(int scan) {
  LocalizationRow row;
  row.time = timestamp_from_ns(1'000'000'000'000) + duration_from_seconds(kPeriod_s * scan);
  row.map_from_robot = {1.0 + scan, 2.0, 0.5};
  row.w_avg = 0.75;
  return row;
}

class LiveBoardTest : public testing::Test {
 protected:
  void show_scans(int first, int last) {
    for (int i = first; i < last; ++i) board_.show(tracked_scan(), row_at(i), 0.002);
  }
  void show_change(Cell cell) {
    revision_.changes = {{cell, CellState::kFree, CellState::kOccupied}};
    revision_.map = std::make_shared<const OccupancyGrid>(patched(*board_.map().grid, revision_.changes));
    ++revision_.number;
    ChangeNote note;
    note.revision = revision_.number;
    board_.show(&revision_, note);
  }
  /// All that a stream has, of one kind, as text of its bytes.
  static std::vector<std::string> all_of(LiveStream& stream, dashboard::MessageKind kind) {
    std::vector<std::string> found;
    while (const auto message = stream.next()) {
      if (message->is_binary && test::u32_at(*message->bytes, 0) == static_cast<std::uint32_t>(kind)) {
        found.push_back(*message->bytes);
      }
    }
    return found;
  }

  std::shared_ptr<const OccupancyGrid> start_ =
      std::make_shared<const OccupancyGrid>(test::drawn_grid({"#....", "#....", "#####"}));
  LiveBoard board_{start_, 3};
  MapRevision revision_{.number = 3, .time = {}, .map = start_, .changes = {}, .field_patch = {}};
  LiveNews news_;
};

TEST_F(LiveBoardTest, KeepsOneScanASecondUnlessSomebodyWatches) {
  LiveScan scan;
  EXPECT_FALSE(board_.fetch(scan));
  show_scans(0, 7);
  ASSERT_TRUE(board_.fetch(scan));
  EXPECT_EQ(scan.row.map_from_robot.x, 5.0) << "one second after the first";
  EXPECT_FALSE(board_.fetch(scan)) << "the same again is no news";
  board_.watch(true);
  show_scans(7, 8);
  ASSERT_TRUE(board_.fetch(scan));
  EXPECT_EQ(scan.row.map_from_robot.x, 8.0);
}

TEST_F(LiveBoardTest, OfAScanTheBeamsWithARangeAreShown) {
  board_.watch(true);
  show_scans(0, 1);
  LiveScan scan;
  ASSERT_TRUE(board_.fetch(scan));
  ASSERT_EQ(scan.beams.size(), 1u);
  EXPECT_EQ(scan.beams[0].x_cm, 150);
  EXPECT_EQ(scan.beams[0].y_cm, -50);
  EXPECT_EQ(scan.latency_s, 0.002);
}

TEST_F(LiveBoardTest, AFewParticlesStandForAllWhereSomebodyWatches) {
  localization::particles::ParticleSet particles;
  particles.resize_uniform(5000);
  board_.show(tracked_scan(), row_at(0), 0.002, &particles);
  LiveScan scan;
  ASSERT_TRUE(board_.fetch(scan));
  EXPECT_TRUE(scan.particles.empty()) << "nobody watches";
  board_.watch(true);
  board_.show(tracked_scan(), row_at(1), 0.002, &particles);
  ASSERT_TRUE(board_.fetch(scan));
  EXPECT_EQ(scan.particles.size(), 256u);
  board_.show(tracked_scan(), row_at(2), 0.002, nullptr);
  ASSERT_TRUE(board_.fetch(scan));
  EXPECT_TRUE(scan.particles.empty()) << "the pose does not rest on them";
}

TEST_F(LiveBoardTest, ParticlesAreToldFromThePoseInEvenSteps) {
  LiveScan scan;
  scan.row.map_from_robot = {10.0, -4.0, 0.0};
  scan.particles = {{10.5, -4.25, 1.0}, {10.0, -4.0, -3.0}};
  const std::string near = particles_message(scan);
  ASSERT_EQ(near.size(), 20u + 2u * 6u);
  EXPECT_EQ(test::u32_at(near, 0), 4u);
  EXPECT_EQ(test::u32_at(near, 4), 2u);
  EXPECT_EQ(test::f32_at(near, 8), 10.0F);
  EXPECT_EQ(test::f32_at(near, 12), -4.0F);
  EXPECT_EQ(test::f32_at(near, 16), 0.001F);
  EXPECT_EQ(static_cast<std::int16_t>(test::number_at(near, 20, 2)), 500);
  EXPECT_EQ(static_cast<std::int16_t>(test::number_at(near, 22, 2)), -250);
  EXPECT_EQ(static_cast<std::int16_t>(test::number_at(near, 30, 2)), std::lround(-3.0 / std::numbers::pi * 32767.0));
  scan.particles.push_back({1010.0, -4.0, 0.0});
  const std::string far = particles_message(scan);
  EXPECT_NEAR(test::f32_at(far, 16) * static_cast<float>(static_cast<std::int16_t>(test::number_at(far, 32, 2))),
              1000.0, 0.1);
}

TEST_F(LiveBoardTest, StoredScansAreShownToWhoWatchesAndLetGoAfter) {
  const auto kept = std::make_shared<const TrackedScan>(tracked_scan());
  board_.show(mapping::StoredScans{.collected = {kept}, .waiting = {}});
  EXPECT_EQ(kept.use_count(), 1) << "nobody watches";
  board_.watch(true);
  board_.show(mapping::StoredScans{.collected = {kept}, .waiting = {}});
  EXPECT_EQ(board_.stored().collected.size(), 1u);
  board_.watch(false);
  EXPECT_EQ(kept.use_count(), 1);
}

TEST_F(LiveBoardTest, StoredScansAreThinnedToTwentyKilobytes) {
  TrackedScan large;
  large.scan.beams.assign(361, {.range_m = 1.0F, .kind = BeamKind::kRange});
  large.rays.resize(361);
  large.estimate.map_from_robot = {3.0, 2.0, 1.0};
  mapping::StoredScans stored;
  stored.collected.assign(400, std::make_shared<const TrackedScan>(large));
  EXPECT_LE(stored_message(stored).size(), 20'200u);
  stored.collected.resize(1);
  stored.waiting.assign(1, std::make_shared<const TrackedScan>(tracked_scan()));
  const std::string two = stored_message(stored);
  EXPECT_EQ(test::u32_at(two, 4), 2u);
  EXPECT_EQ(test::u32_at(two, 8), 0u) << "collected";
  EXPECT_EQ(test::f32_at(two, 12), 3.0F);
  const std::uint32_t ends = test::u32_at(two, 24);
  EXPECT_GE(ends, 61u);
  EXPECT_LE(ends, 120u);
  const std::size_t next = 28 + 4 * ends;
  EXPECT_EQ(test::u32_at(two, next), 1u) << "waits";
  EXPECT_EQ(test::u32_at(two, next + 16), 1u);
  EXPECT_EQ(test::number_at(two, next + 20, 2), 150u);
  EXPECT_EQ(two.size(), next + 24);
}

TEST(PoseMessage, TellsOfNoOpenGateBeforeTheFirstScanVotesNorWithMappingOff) {
  Telemetry telemetry;
  EXPECT_EQ(pose_message({}, telemetry, true).find(R"("open":true)"), std::string::npos);
  telemetry.gate.set(mapping::gate::GateReason::kOpen, {});
  EXPECT_NE(pose_message({}, telemetry, true).find(R"("open":true)"), std::string::npos);
  EXPECT_NE(pose_message({}, telemetry, false).find(R"("gate":null)"), std::string::npos);
}

TEST_F(LiveBoardTest, ThePilotsWishIsToldWhileItDrives) {
  Telemetry telemetry;
  telemetry.wanted_speed_m_per_s.set(0.5);
  EXPECT_EQ(pose_message({}, telemetry, true).find("pilot"), std::string::npos);
  telemetry.drives.set(true);
  EXPECT_NE(pose_message({}, telemetry, true).find(R"("pilot":{"speed_m_per_s":0.5,"turn_rate_rad_per_s":0.0})"),
            std::string::npos);
  telemetry.by_hand.set(true);
  EXPECT_EQ(pose_message({}, telemetry, true).find("pilot"), std::string::npos);
}

TEST_F(LiveBoardTest, WhatForbidsToDriveByThePoseIsTold) {
  using navigation::StopReason;
  Telemetry telemetry;
  const auto forbids = [&](StopReason reason) {
    const std::string told = "\"forbidden_by\":\"" + std::string(name_of(reason)) + "\"";
    return pose_message({}, telemetry, true).find(told) != std::string::npos;
  };
  EXPECT_TRUE(forbids(StopReason::kPoseUnknown)) << "no scan has been localized";
  telemetry.localized.set(1);
  EXPECT_TRUE(forbids(StopReason::kNone));
  telemetry.pose_stop.set(static_cast<std::uint8_t>(StopReason::kStartUnfit));
  EXPECT_TRUE(forbids(StopReason::kStartUnfit));
  telemetry.unfit.set(static_cast<std::uint8_t>(StopReason::kStalled));
  EXPECT_TRUE(forbids(StopReason::kStalled)) << "robot and laser come first";
}

TEST_F(LiveBoardTest, SamplesComeOnceASecondWithTheRateOfScans) {
  show_scans(0, 41);
  const auto past = board_.samples_from(0, 100);
  ASSERT_EQ(past.items.size(), 10u);
  for (const LiveSample& sample : past.items) {
    EXPECT_FLOAT_EQ(sample.values[LiveSample::kScansPerSecond], 4.0F);
    EXPECT_FLOAT_EQ(sample.values[LiveSample::kWAvg], 0.75F);
  }
  TrackedScan blind = tracked_scan();
  blind.scan.beams[0].kind = BeamKind::kBeyondMaximum;
  for (int i = 41; i < 46; ++i) board_.show(blind, row_at(i), 0.002);
  const auto without_a_return = board_.samples_from(10, 100);
  ASSERT_EQ(without_a_return.items.size(), 1u);
  EXPECT_TRUE(std::isnan(without_a_return.items[0].values[LiveSample::kWAvg])) << "that would be an older scan's";
  EXPECT_EQ(board_.samples_from(9, 100).items.size(), 2u);
  EXPECT_EQ(board_.samples_from(0, 3).next(), 3u);
  EXPECT_TRUE(board_.samples_from(11, 100).items.empty());
}

TEST_F(LiveBoardTest, WhatTheStagesHaveUsedSinceTheSampleBeforeIsAShareOfAProcessor) {
  double used_s = 10.0;
  board_.set_figures([&used_s] {
    LiveFigures figures;
    figures.cpu_s[1] = used_s += 0.25;  // localization, in each second
    figures.resident_bytes = 3.0 * 1024 * 1024;
    figures.wheel_turn = -0.02;
    return figures;
  });
  show_scans(0, 13);
  const auto past = board_.samples_from(0, 100);
  ASSERT_EQ(past.items.size(), 3u);
  for (const LiveSample& sample : past.items) {
    EXPECT_FLOAT_EQ(sample.values[LiveSample::kCpuLocalization], 25.0F);
    EXPECT_FLOAT_EQ(sample.values[LiveSample::kMemory], 3.0F);
    EXPECT_FLOAT_EQ(sample.values[LiveSample::kWheelTurn], -2.0F);
    EXPECT_TRUE(std::isnan(sample.values[LiveSample::kCpuMap])) << "not known";
    EXPECT_TRUE(std::isnan(sample.values[LiveSample::kWheelDistance]));
  }
}

TEST_F(LiveBoardTest, WhereTheScansTimeHasGoneBackNoRateIsKnown) {
  double used_s = 10.0;
  board_.set_figures([&used_s] {
    LiveFigures figures;
    figures.cpu_s[1] = used_s += 0.25;
    return figures;
  });
  show_scans(40, 45);
  show_scans(0, 5);
  const auto past = board_.samples_from(0, 100);
  ASSERT_EQ(past.items.size(), 3u);
  EXPECT_FLOAT_EQ(past.items[0].values[LiveSample::kCpuLocalization], 25.0F);
  EXPECT_TRUE(std::isnan(past.items[1].values[LiveSample::kCpuLocalization]));
  EXPECT_TRUE(std::isnan(past.items[1].values[LiveSample::kScansPerSecond]));
  EXPECT_FLOAT_EQ(past.items[2].values[LiveSample::kCpuLocalization], 25.0F);
}

TEST_F(LiveBoardTest, ThePastIsAnHourAndNoMore) {
  show_scans(0, 4 * static_cast<int>(LiveBoard::kSamplesKept) + 41);
  const auto past = board_.samples_from(0, 2 * LiveBoard::kSamplesKept);
  EXPECT_EQ(past.items.size(), LiveBoard::kSamplesKept);
  EXPECT_EQ(past.first, 10u);
}

TEST_F(LiveBoardTest, AStreamBeginsWithTheWholeMapAndGoesOnWithBoxes) {
  LiveStream stream{news_, board_};
  const auto frame = stream.next();
  ASSERT_TRUE(frame);
  EXPECT_NE(frame->bytes->find(R"("type":"map","width":5,"height":3)"), std::string::npos) << *frame->bytes;
  const auto whole = all_of(stream, dashboard::MessageKind::kCells);
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(test::decoded_cells(whole[0]).states.size(), 15u);
  EXPECT_EQ(test::decoded_cells(whole[0]).revision, 3u);

  show_change({2, 1});
  const auto boxes = all_of(stream, dashboard::MessageKind::kCells);
  ASSERT_EQ(boxes.size(), 1u);
  const auto box = test::decoded_cells(boxes[0]);
  EXPECT_EQ(box.box, (CellBox{{2, 1}, {3, 2}}));
  EXPECT_EQ(box.states, std::vector{CellState::kOccupied});
  EXPECT_EQ(box.revision, 4u);
  EXPECT_FALSE(stream.next());
}

TEST_F(LiveBoardTest, AViewerThatWasBehindGetsTheNewestCells) {
  LiveStream stream{news_, board_};
  (void)all_of(stream, dashboard::MessageKind::kCells);
  show_change({2, 1});
  show_change({3, 1});
  const auto boxes = all_of(stream, dashboard::MessageKind::kCells);
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(test::decoded_cells(boxes[0]).revision, 5u) << "cut out of the newest map";
}

TEST_F(LiveBoardTest, AViewerThatHasMissedTooMuchGetsTheWholeMap) {
  LiveStream stream{news_, board_};
  (void)all_of(stream, dashboard::MessageKind::kCells);
  for (std::size_t i = 0; i <= LiveBoard::kBoxesKept; ++i) show_change({1 + static_cast<int>(i % 3), 1});
  const auto boxes = all_of(stream, dashboard::MessageKind::kCells);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(test::decoded_cells(boxes[0]).states.size(), 15u);
}

TEST_F(LiveBoardTest, ARefusedChangeIsListedAndChangesNoCell) {
  ChangeNote note;
  note.reason = "too little";
  board_.show(nullptr, note);
  EXPECT_EQ(board_.map().revision, 3u);
  EXPECT_TRUE(board_.map().changed.items.empty());
  const auto changes = board_.changes_from(0, 10);
  ASSERT_EQ(changes.items.size(), 1u);
  EXPECT_EQ(changes.items[0].reason, "too little");
}

TEST_F(LiveBoardTest, ChangesAreCountedBeyondTheOnesThatAreKept) {
  ChangeNote refused;
  refused.reason = "too little";
  for (std::size_t i = 0; i < LiveBoard::kChangesKept + 7; ++i) board_.show(nullptr, refused);
  show_change({1, 1});
  EXPECT_EQ(board_.changes_from(0, 10'000).items.size(), LiveBoard::kChangesKept);
  EXPECT_EQ(board_.change_counts().refused, LiveBoard::kChangesKept + 7);
  EXPECT_EQ(board_.change_counts().accepted, 1U);
}

TEST_F(LiveBoardTest, OlderPosesAreSkippedForASlowViewer) {
  LiveStream stream{news_, board_};
  (void)all_of(stream, dashboard::MessageKind::kCells);
  news_.pose.set("first");
  news_.pose.set("second");
  const auto message = stream.next();
  ASSERT_TRUE(message);
  EXPECT_EQ(*message->bytes, "second");
  EXPECT_FALSE(stream.next());
}

}  // namespace
}  // namespace deltamap::daemon
