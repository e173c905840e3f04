// SPDX-License-Identifier: Apache-2.0
#include "tool/ctl/status_table.hpp"

#include <gtest/gtest.h>

namespace deltamap::tool {
namespace {

void expect_line(const std::string& reply, const std::string& expected) {
  const std::string table = status_table(reply);
  EXPECT_NE(table.find(expected + "\n"), std::string::npos) << expected << "\nis not in\n" << table;
}

TEST(StatusTable, TellsWhatDrivingHasToldOfWheelsAndMount) {
  const std::string reply =
      R"({"state":"tracking","calibration":{"distance_percent":-1.04,"turn_percent":1.9,"drift_deg_per_m":0.17,)"
      R"("lag_ms":41.6,"mount":{"x_mm":-3.2,"y_mm":8.0,"yaw_deg":0.25},"deviations":{"distance_percent":0.02,)"
      R"("turn_percent":0.1,"drift_deg_per_m":0.01,"lag_ms":2.2,"mount":{"x_mm":1.0,"y_mm":2.0,"yaw_deg":0.03}}}})";
  expect_line(reply,
              "wheels       distance -1.04 ± 0.02 %, turn +1.90 ± 0.10 %, drift +0.170 ± 0.010 deg/m, lag 42 ± 2 ms");
  expect_line(reply, "laser mount  off by x -3 ± 1, y +8 ± 2 mm, yaw +0.25 ± 0.03 deg");
}

TEST(StatusTable, SaysWhereDrivingHasToldNothingYet) {
  for (const char* reply : {R"({"state":"global","calibration":null})", "{}", "no json"}) {
    expect_line(reply, "wheels       nothing found yet");
  }
  expect_line(R"({"calibration":{"lag_ms":40}})",
              "wheels       distance +0.00 ± 0.00 %, turn +0.00 ± 0.00 %, drift +0.000 ± 0.000 deg/m, lag 40 ± 0 ms");
}

TEST(StatusTable, SaysWhyARobotIsNeverDriven) {
  expect_line(R"({"never_driven":"its subtype \"p3at\" is unknown: set its hull"})",
              R"(not driven   its subtype "p3at" is unknown: set its hull)");
  for (const char* reply : {R"({"never_driven":""})", "{}", R"({"never_driven":1})"}) {
    EXPECT_EQ(status_table(reply).find("not driven"), std::string::npos) << reply;
  }
}

TEST(StatusTable, TellsNoWeightOfAScanWithoutAReturn) {
  expect_line(R"({"particles":500,"n_eff":400,"w_avg":0.731,"fit":0.9})",
              "filter       500 particles, n_eff 400, w_avg 0.731, 90 % of the beams fit");
  expect_line(R"({"particles":500,"n_eff":400,"w_avg":null,"fit":null})",
              "filter       500 particles, n_eff 400; no beam tells how well the scan fits");
}

TEST(StatusTable, SaysWhyPlannersMustNotDrive) {
  expect_line(R"({"may_drive_by_pose":true,"forbidden_by":"none"})", "planners     may drive by this pose");
  expect_line(R"({"may_drive_by_pose":false,"forbidden_by":"laser sees nothing"})",
              "planners     must not drive by this pose: laser sees nothing");
}

TEST(StatusTable, SaysWhatNobodyKnows) {
  const std::string nothing =
      R"({"state":"no scan yet","pose":null,"covariance":null,"belief":null,"particles":null,"n_eff":null,)"
      R"("latency_ms":null,"battery_v":null,"ports":{"robot":"down","laser":"down"},)"
      R"("port_troubles":{"robot":"/dev/ttyUSB0: busy","laser":""}})";
  expect_line(nothing, "pose         unknown");
  expect_line(nothing, "belief       none");
  expect_line(nothing, "filter       no scan yet");
  expect_line(nothing, "scans        0, 0 localized, 0 messages dropped, latency unknown");
  expect_line(nothing, "ports        robot down, laser down\n             robot: /dev/ttyUSB0: busy");
  EXPECT_EQ(status_table(nothing).find("0.00"), std::string::npos);
  expect_line(R"({"state":"tracking","pose":{"x_m":1},"ports":{"laser":"down"}})",
              "state        was tracking: the laser is down");
}

}  // namespace
}  // namespace deltamap::tool
