// SPDX-License-Identifier: Apache-2.0
#include "reports/svg_chart.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "reports/number_text.hpp"

namespace deltamap::reports {
namespace {

TEST(Chart, MakesTextHarmless) {
  const std::string html = figure_of({"t", "a < b", "y", {{"\"one\"", {{0.0, 1.0}, {1.0, 2.0}}}}});
  EXPECT_EQ(html.find("a < b"), std::string::npos);
  EXPECT_NE(html.find("a &lt; b"), std::string::npos);
  EXPECT_NE(html.find("&quot;one&quot;"), std::string::npos);
}

TEST(Chart, AxesFitTheDataAndHaveRoundEnds) {
  const auto ends = [](double low, double high) {
    const Axis axis = axis_for(low, high);
    EXPECT_GE((axis.high - axis.low) / axis.step, 2.0 - 1e-9) << low << " " << high;
    EXPECT_LE((axis.high - axis.low) / axis.step, 9.0 + 1e-9) << low << " " << high;
    return std::pair{axis.low, axis.high};
  };
  const auto [low, high] = ends(0.981, 0.992);
  EXPECT_NEAR(low, 0.98, 1e-9) << "not from 0";
  EXPECT_NEAR(high, 0.992, 0.0021);
  EXPECT_EQ(ends(0.2, 0.9).first, 0.0) << "0 is near";
  EXPECT_EQ(ends(-9.0, -1.0).second, 0.0);
  EXPECT_LT(ends(5.0, 5.0).first, 5.0);
  EXPECT_GT(ends(5.0, 5.0).second, 5.0);
  EXPECT_LT(ends(0.0, 0.0).first, ends(0.0, 0.0).second);
}

TEST(Chart, ALineLeavesOutWhatIsNoNumberAndNothingIsDrawnOfNothing) {
  const double nothing = std::nan("");
  const std::string html =
      figure_of({"t", "x", "y", {{"one", {{0.0, 1.0}, {1.0, nothing}, {2.0, 3.0}}}, {"none", {}}}});
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_NE(html.find("points=\"\""), std::string::npos);
  EXPECT_EQ(figure_of({"t", "x", "y"}).find("nan"), std::string::npos);
}

TEST(Chart, NumbersHaveThreeDigits) {
  EXPECT_EQ(short_text(0.0123456), "0.0123");
  EXPECT_EQ(short_text(12345.678), "12346");
  EXPECT_EQ(short_text(1764000000.0), "1764000000");
  EXPECT_EQ(short_text(std::nan("")), "–");
  EXPECT_EQ(shortened("0.123456 (0.1 … 1.98765), seed 10001, 1.23456e-05"), "0.123 (0.1 … 1.99), seed 10001, 1.23e-05");
  EXPECT_EQ(shortened("version 1.2.3, 4 of 5."), "version 1.2.3, 4 of 5.");
}

}  // namespace
}  // namespace deltamap::reports
