// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/localization_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace deltamap::daemon {
namespace {

TrackedScan some_scan() {
  TrackedScan tracked;
  tracked.scan.time = timestamp_from_ns(976052857'123456789);
  tracked.scan.number = 42;
  tracked.speed_m_per_s = 0.25;
  tracked.turn_rate_rad_per_s = -0.5;
  tracked.weights = {.w_fast = 0.375, .w_slow = 0.5};
  Estimate& estimate = tracked.estimate;
  estimate.map_from_robot = {1.5, -2.25, 0.75};
  estimate.covariance(0, 2) = 0.125;
  estimate.state = LocalizerState::kLost;
  estimate.w_avg = 0.625;
  estimate.n_eff = 99.5;
  estimate.particles = 500;
  estimate.revision = 3;
  estimate.belief.pose_right = 0.0625;
  estimate.belief.verdict = PoseVerdict::kWrong;
  estimate.belief.is_checked = true;
  estimate.belief.stable = {.expected = 10, .fit = 2, .short_of = 3, .beyond = 5};
  return tracked;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

TEST(LocalizationLog, EveryColumnHasItsNameAndItsValue) {
  const auto names = fields_of(csv_header());
  const auto values = fields_of(csv_line(row_of(some_scan())));
  ASSERT_EQ(names.size(), values.size());
  const auto value_of = [&](const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? "no such column" : values[static_cast<std::size_t>(found - names.begin())];
  };
  EXPECT_EQ(value_of("time"), "976052857.123456789");
  EXPECT_EQ(value_of("number"), "42");
  EXPECT_EQ(value_of("state"), "lost");
  EXPECT_EQ(value_of("x_m"), "1.5");
  EXPECT_EQ(value_of("heading_rad"), "0.75");
  EXPECT_EQ(value_of("w_avg"), "0.625");
  EXPECT_EQ(value_of("w_fast"), "0.375");
  EXPECT_EQ(value_of("w_slow"), "0.5");
  EXPECT_EQ(value_of("r_d"), "0.25");
  EXPECT_EQ(value_of("n_eff"), "99.5");
  EXPECT_EQ(value_of("particles"), "500");
  EXPECT_EQ(value_of("revision"), "3");
  EXPECT_EQ(value_of("pose_right"), "0.0625");
  EXPECT_EQ(value_of("verdict"), "wrong");
  EXPECT_EQ(value_of("stable_expected"), "10");
  EXPECT_EQ(value_of("stable_fit"), "2");
  EXPECT_EQ(value_of("stable_short"), "3");
  EXPECT_EQ(value_of("stable_beyond"), "5");
  EXPECT_EQ(value_of("elsewhere_beyond"), "0");
  EXPECT_EQ(value_of("cov_xh"), "0.125");
  EXPECT_EQ(value_of("speed_m_per_s"), "0.25");
}

TEST(LocalizationLog, TellsStateAndVerdictInOneLineEach) {
  const LocalizationRow row = row_of(some_scan());
  EXPECT_EQ(state_line(row), "localizer: lost x=1.50 y=-2.25 heading=43 w_avg=0.625 scan=42");
  EXPECT_EQ(verdict_line(row),
            "pose verdict: wrong pose_right=0.06 map_wrong=0.50 rival=0.00 scan=42 stable=2/10 elsewhere=0/0");
}

}  // namespace
}  // namespace deltamap::daemon
