// SPDX-License-Identifier: Apache-2.0
// Zones in whole replays and runs: what is written, and what the pose is worth.
#include <cmath>

#include "daemon/replay/sequential_run.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/daemon/pipeline_fixture.hpp"
#include "tests/support/worlds/container_hall.hpp"

namespace deltamap::daemon {
namespace {

/// A recorded drive in which a box appears.
class ZonedReplay : public test::PipelineFixture {
 protected:
  static inline const Polygon kAroundTheBox{{4.6, 4.6}, {6.0, 4.6}, {6.0, 5.8}, {4.6, 5.8}};

  void set_zone(const std::string& type) {
    settings_.zones.file = folder_.path() / (type + ".yaml");
    std::ofstream{settings_.zones.file} << "zones:\n  - {zoneId: Z, zoneType: " << type
                                        << ", vertices: [[4.6, 4.6], [6, 4.6], [6, 5.8], [4.6, 5.8]]}\n";
  }
  struct Result {
    std::size_t cells_inside = 0;
    std::size_t cells_outside = 0;
    bool was_transient = false;  // something stood there and was not map
  };
  [[nodiscard]] Result replayed(const std::string& out) {
    Result result;
    ReplayJob job;
    job.recording = folder_.path() / "drive.pcapng";
    job.map = folder_.path() / "room.yaml";
    job.settings = settings_;
    job.out = folder_.path() / out;
    job.watch.change = [&](const MapRevision* revision, const ChangeNote&) {
      if (revision == nullptr) return;
      for (const CellChange& change : revision->changes) {
        const bool is_inside = contains(kAroundTheBox, revision->map->geometry().centre_of(change.cell));
        ++(is_inside ? result.cells_inside : result.cells_outside);
      }
    };
    job.watch.scan = [&](const ReplayedScan& scan) {
      const auto& transients = scan.awareness.transients();
      result.was_transient = result.was_transient || (transients && transients->stands_at({5.3, 4.85}));
    };
    last_phases_ = run_replay(job, [](double) { return true; }).phases;
    return result;
  }
  std::uint64_t last_phases_ = 0;
};

TEST_F(ZonedReplay, WithoutAZoneTheBoxIsWritten) { EXPECT_GT(replayed("plain").cells_inside, 20u); }

TEST_F(ZonedReplay, InAFrozenZoneNoCellIsWrittenAndNothingIsDrawnInVain) {
  set_zone("FROZEN");
  const Result result = replayed("frozen");
  EXPECT_EQ(result.cells_inside, 0u);
  EXPECT_LE(last_phases_, 1u);
}

TEST_F(ZonedReplay, InATemporaryZoneWhatStandsThereStaysTransient) {
  set_zone("TEMPORARY");
  const Result result = replayed("temporary");
  EXPECT_EQ(result.cells_inside, 0u);
  EXPECT_TRUE(result.was_transient);
}

/// Drives round the containers of a hall; the map stays as it is.
class IgnoredContainers : public testing::Test {
 protected:
  static constexpr double kPeriod_s = 0.2;

  static Pose2 on_way(double time_s) {
    const double angle = 2.0 * M_PI * time_s / 60.0;
    const Point2 at{6.0 + 5.0 * std::cos(angle), 4.0 + 3.2 * std::sin(angle)};
    return {at.x(), at.y(), std::atan2(3.2 * std::cos(angle), -5.0 * std::sin(angle))};
  }

  /// RMS of the position, m, over a minute.
  static double error_in(const test::Containers& standing, const Zones& zones) {
    Settings settings;
    settings.initial_pose = on_way(0.0);
    settings.localizer.particles.min = settings.localizer.particles.max = 300;
    StartMap start{.map = std::make_shared<const OccupancyGrid>(test::map_of(test::containers_in_order()))};
    start.site = std::make_shared<const Site>(Site{{}, zones});
    SequentialRun run{settings, start, nullptr, 0.0};
    const OccupancyGrid world = test::world_of(standing);
    Random random{11};
    double squares = 0.0;
    int scans = 0;
    for (double time_s = 0.0; time_s < 60.0; time_s += kPeriod_s, ++scans) {
      Odometry odometry;
      odometry.time = timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(time_s);
      odometry.odom_from_robot = on_way(time_s);
      run.observe(odometry);
      Scan scan = test::cast_scan(world, on_way(time_s), odometry.time, {}, random);
      run.take_what_is_due(scan);
      const Pose2 pose = run.observe(std::move(scan)).estimate.map_from_robot;
      squares += std::pow(distance_between(pose, on_way(time_s)), 2);
    }
    return std::sqrt(squares / scans);
  }
};

TEST_F(IgnoredContainers, AllThatStandsInTheZoneMovesAndThePoseIsAsGood) {
  const Zones zones{
      {.id = "stacks", .kind = ZoneKind::kIgnore, .polygon = {{2.3, 1.3}, {9.7, 1.3}, {9.7, 7.2}, {2.3, 7.2}}}};
  test::Containers moved = test::containers_in_order();
  for (Point2& container : moved) container += Point2{0.25, 0.2};
  const double unmoved = error_in(test::containers_in_order(), zones);
  const double ignored = error_in(moved, zones);
  const double misled = error_in(moved, {});
  EXPECT_LE(ignored, 1.1 * unmoved);
  EXPECT_GT(misled, 1.1 * ignored) << "else this test shows nothing";
}

}  // namespace
}  // namespace deltamap::daemon
