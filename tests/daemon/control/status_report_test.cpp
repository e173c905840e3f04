// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/status_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace deltamap::daemon::control {
namespace {

TEST(StatusReport, TellsNoWeightOfAScanOfWhichNoBeamTells) {
  Telemetry telemetry;
  const auto told = [&] { return nlohmann::json::parse(status_json_line(telemetry, {}, 1.0)); };
  const auto is_null = [&](const char* field) { return told().contains(field) && told()[field].is_null(); };
  EXPECT_TRUE(is_null("w_avg")) << "no scan yet";
  EXPECT_TRUE(is_null("fit"));
  telemetry.localized.set(1);
  telemetry.estimate.w_avg.set(0.75);
  telemetry.fit.set(0.5);
  EXPECT_EQ(told()["w_avg"], 0.75);
  EXPECT_EQ(told()["fit"], 0.5);
  telemetry.fit.set(-1.0);
  EXPECT_TRUE(is_null("w_avg")) << "that would be an older scan's";
  EXPECT_TRUE(is_null("fit"));
}

}  // namespace
}  // namespace deltamap::daemon::control
