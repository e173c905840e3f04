// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/packed_scan.hpp"

#include <gtest/gtest.h>

#include "localization/motion/deskew.hpp"

namespace deltamap::localization::motion {
namespace {

Scan seen() {
  Scan scan;
  scan.time = Timestamp{std::chrono::seconds{7}};
  scan.first_bearing_rad = -1.5;
  scan.bearing_step_rad = 0.0087;
  scan.range_deviation_m = 0.02;
  scan.robot_from_laser = {0.21, -0.01, 0.03};
  for (int i = 0; i < 361; ++i) {
    scan.beams.push_back({1.0F + 0.013F * static_cast<float>(i), 7.4e-5F * static_cast<float>(i), BeamKind::kRange});
  }
  scan.beams[5] = {0.0F, 3.7e-4F, BeamKind::kDazzled};
  return scan;
}

TEST(PackedScan, GivesBackAllThatIsDrawnBitForBit) {
  const Scan scan = seen();
  const BodyVelocity velocity{.speed_m_per_s = 0.73, .turn_rate_rad_per_s = -1.1};
  const PackedScan packed{scan, velocity};
  const TrackedScan tracked = packed.tracked();
  const auto rays = deskewed(scan, velocity);
  ASSERT_EQ(tracked.rays.size(), rays.size());
  ASSERT_EQ(packed.size(), rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(tracked.rays[i].origin, rays[i].origin) << i;
    EXPECT_EQ(tracked.rays[i].end, rays[i].end) << i;
    EXPECT_EQ(packed.end(i), rays[i].end) << i;
    EXPECT_EQ(tracked.scan.beams[i].range_m, scan.beams[i].range_m) << i;
    EXPECT_EQ(tracked.scan.beams[i].kind == BeamKind::kRange, i != 5) << i;
  }
  EXPECT_EQ(packed.time(), scan.time);
  EXPECT_EQ(tracked.scan.range_deviation_m, 0.02);
}

TEST(PackedScan, EndsWithinALengthWhatHasARangeNoLongerThanThat) {
  Scan scan = seen();
  scan.beams.resize(7);
  scan.beams[6].range_m = 4.0F;
  const PackedScan packed{scan};
  EXPECT_TRUE(packed.ends_within(6, 4.0));
  EXPECT_FALSE(packed.ends_within(6, 3.9));
  EXPECT_FALSE(packed.ends_within(5, 80.0));
  EXPECT_EQ(packed.ends(80.0).size(), 6U);
  EXPECT_EQ(packed.ends(3.9).size(), 5U);
}

TEST(PackedScan, SharesNothingWithAnotherLasers) {
  const PackedScan first{seen()};
  Scan other = seen();
  other.robot_from_laser.x = 0.5;
  const PackedScan packed{other, {}, &first};
  EXPECT_EQ(packed.tracked().rays[0].origin.x(), 0.5F);
  EXPECT_EQ(PackedScan(seen(), {}, &first).tracked().rays[0].origin.x(), 0.21F);
}

}  // namespace
}  // namespace deltamap::localization::motion
