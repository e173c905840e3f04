// SPDX-License-Identifier: Apache-2.0
// The localizer alone on logs that real robots recorded, against their reference poses. Skips loudly without the data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "localization/localizer_params.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/scans/carmen_feed.hpp"
#include "tests/support/worlds/recorded_map.hpp"

namespace deltamap::localization {
namespace {

constexpr double kLostM = 0.5;
constexpr double kSameTimeS = 0.05;

struct RealLog {
  std::string log;
  std::string map;
  double laser_ahead_m;
  bool initial_pose_given;
  std::uint64_t seed;
  double median_m;
  double p95_m;
};

std::ostream& operator<<(std::ostream& out, const RealLog& real) {
  return out << real.log << " on " << real.map << ", seed " << real.seed
             << (real.initial_pose_given ? "" : ", anywhere");
}

struct ReferencePose {
  Timestamp time;
  Pose2 map_from_laser;
};

std::filesystem::path unpacked(const std::filesystem::path& packed, const std::filesystem::path& folder) {
  std::filesystem::path to = folder / packed.stem();
  const std::string command = "xz -dc '" + packed.string() + "' > '" + to.string() + "'";
  // NOLINTNEXTLINE(concurrency-mt-unsafe): one thread
  if (std::system(command.c_str()) != 0) throw std::runtime_error(packed.string() + ": cannot be unpacked");
  return to;
}

std::vector<ReferencePose> reference_poses(const std::filesystem::path& file) {
  std::vector<ReferencePose> poses;
  std::ifstream in{file};
  std::string line;
  while (std::getline(in, line)) {
    double time_s = 0.0;
    Pose2 pose;
    if (std::sscanf(line.c_str(), "%lf %lf %lf %lf", &time_s, &pose.x, &pose.y, &pose.theta) != 4) continue;
    poses.push_back({timestamp_from_ns(0) + duration_from_seconds(time_s), pose});
  }
  return poses;
}

double share_above(const std::vector<double>& values, double limit) {
  return static_cast<double>(std::count_if(values.begin(), values.end(), [&](double v) { return v > limit; })) /
         static_cast<double>(values.size());
}

class RealLogs : public testing::TestWithParam<RealLog> {};

TEST_P(RealLogs, AreFollowedWithinTheFiguresThatWePromise) {
  const RealLog& real = GetParam();
  const std::filesystem::path log = test::data_folder() / "logs" / (real.log + ".log.xz");
  const auto map = test::recorded_map(real.map);
  if (!map || !std::filesystem::exists(log)) GTEST_SKIP() << "no recorded data in " << test::data_folder();
  const test::TemporaryFolder folder;
  const auto reference =
      reference_poses(unpacked(test::data_folder() / "reference" / (real.log + ".gt.txt.xz"), folder.path()));
  ASSERT_FALSE(reference.empty());

  const Pose2 laser_from_robot{-real.laser_ahead_m, 0.0, 0.0};
  LocalizerParams params;
  params.particles.min = 500;
  std::optional<particles::InitialPose> initial;
  if (real.initial_pose_given) {
    params.particles.max = 500;
    initial = particles::InitialPose{reference.front().map_from_laser * laser_from_robot};
  }
  Localizer localizer{params, std::make_shared<const OccupancyGrid>(*map), initial, real.seed};
  test::CarmenFeed feed{unpacked(log, folder.path()), real.laser_ahead_m};
  std::vector<double> errors_m;
  std::size_t nearest = 0;
  while (auto scan = feed.next(localizer)) {
    const Estimate estimate = localizer.observe(std::move(*scan)).estimate;
    while (nearest + 1 < reference.size() &&
           reference[nearest + 1].time <= estimate.time + duration_from_seconds(0.001)) {
      ++nearest;
    }
    if (std::abs(seconds(estimate.time - reference[nearest].time)) > kSameTimeS) continue;
    const Pose2 map_from_laser = estimate.map_from_robot * inverse(laser_from_robot);
    errors_m.push_back(distance_between(map_from_laser, reference[nearest].map_from_laser));
  }
  ASSERT_GE(errors_m.size(), reference.size() * 99 / 100);
  EXPECT_LE(share_above(errors_m, kLostM), 0.01);
  EXPECT_LE(share_above(errors_m, real.median_m), 0.5);
  EXPECT_LE(share_above(errors_m, real.p95_m), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Recorded, RealLogs,
                         testing::Values(RealLog{"intel", "ref_intel", 0.0, true, 1, 0.045, 0.15},
                                         RealLog{"intel", "ref_intel", 0.0, true, 2, 0.045, 0.15},
                                         RealLog{"intel", "ref_intel", 0.0, false, 1, 0.045, 0.15},
                                         RealLog{"wean3", "wean5300", 0.25, true, 1, 0.15, 0.25},
                                         RealLog{"wean3", "wean5300", 0.25, false, 1, 0.15, 0.25}));

}  // namespace
}  // namespace deltamap::localization
