// SPDX-License-Identifier: Apache-2.0
// What the simulated scanner measures on request or as a stream: selected values, means, rasters, reflectivity.
#include <gtest/gtest.h>

#include <cmath>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/value_selection.hpp"
#include "tests/support/scans/lms200_rig.hpp"

namespace deltamap::simulation::devices {
namespace {

using Kind = lms200::Telegram::Kind;

TEST(VirtualLms200, SendsOneScanOnRequest) {
  Lms200Rig rig;
  const auto answers = rig.ask(lms200::scan_request(), 2.0);
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_TRUE(lms200::decoded_measurement(answers[1]));
}

TEST(VirtualLms200, SendsTheSelectedValuesOnRequest) {
  Lms200Setup setup;
  setup.baud = 38400;
  setup.variant = {180, 100};
  Lms200Rig rig{setup};
  using Selection = lms200::ValueSelection;
  const auto words = [&](Selection::Kind kind) {
    const auto measurement =
        lms200::decoded_measurement(answer_of(rig, lms200::selection_request({kind, 1, {}}, false)));
    EXPECT_TRUE(measurement);
    return measurement ? measurement->words : std::vector<std::uint16_t>{};
  };
  EXPECT_EQ(words(Selection::Kind::kAll).size(), 181u);
  EXPECT_EQ(words(Selection::Kind::kSmallest), std::vector<std::uint16_t>{500});
  EXPECT_EQ(words(Selection::Kind::kEverySecond).size(), 91u);
  EXPECT_EQ(words(Selection::Kind::kEveryTwentieth).size(), 10u);
  const auto mean = lms200::decoded_selected_values(
      answer_of(rig, lms200::selection_request({Selection::Kind::kMean, 20, {}}, false)));
  ASSERT_TRUE(mean);
  EXPECT_EQ(mean->mean_of, 20);
  EXPECT_EQ(mean->measurement.words, std::vector<std::uint16_t>(181, 500));
  const lms200::ValueRange range{11, 20};
  const auto part = lms200::decoded_selected_values(
      answer_of(rig, lms200::selection_request({Selection::Kind::kSubRange, 1, {range}}, false)));
  ASSERT_TRUE(part);
  EXPECT_EQ(part->range, range);
  EXPECT_EQ(part->measurement.words.size(), 10u);
  const auto both = lms200::decoded_selected_values(
      answer_of(rig, lms200::selection_request({Selection::Kind::kMeanSubRange, 3, {range}}, false)));
  ASSERT_TRUE(both);
  EXPECT_EQ(both->mean_of, 3);
  EXPECT_EQ(both->measurement.words.size(), 10u);
}

TEST(VirtualLms200, TakesTheMeanOverConsecutiveScans) {
  Lms200Setup setup;
  setup.baud = 38400;
  Lms200Rig rig{setup};
  (void)rig.ask(lms200::selection_request({lms200::ValueSelection::Kind::kMean, 8, {}}, true), 3.0);
  ASSERT_GE(rig.sweeps.size(), 16u);
  for (std::size_t i = 1; i < 8; ++i) {
    EXPECT_NEAR(seconds(rig.sweeps[i].begin - rig.sweeps[i - 1].begin), setup.variant.scan_duration_s(), 1e-9);
  }
  EXPECT_TRUE(rig.laser.is_streaming());
}

TEST(VirtualLms200, StreamsWhatPlayerReadsAtOneDegree) {
  Lms200Setup setup;
  setup.baud = 38400;
  setup.variant = {180, 100};
  Lms200Rig rig{setup};
  const auto answers =
      rig.ask(lms200::selection_request({lms200::ValueSelection::Kind::kSubRange, 1, {{1, 181}}}, true), 2.0);
  ASSERT_GE(answers.size(), 10u);
  EXPECT_TRUE(lms200::mode_was_switched(answers[1]).value_or(false));
  for (std::size_t i = 2; i < answers.size(); ++i) {
    const auto values = lms200::decoded_selected_values(answers[i]);
    ASSERT_TRUE(values);
    EXPECT_EQ(values->range, (lms200::ValueRange{1, 181}));
    EXPECT_EQ(values->measurement.words.size(), 181u);
  }
  const auto status = lms200::decoded_status(rig.ask(lms200::status_request(), 0.06).back());
  ASSERT_TRUE(status);
  EXPECT_EQ(status->operating_mode, lms200::mode::kStreamSubRange);
}

TEST(VirtualLms200, StreamsTheFourRastersOfAnInterlacedScan) {
  Lms200Setup setup;
  setup.baud = 500000;
  Lms200Rig rig{setup};
  const auto answers = rig.ask(lms200::selection_request({lms200::ValueSelection::Kind::kPartial, 1, {}}, true), 1.0);
  ASSERT_GE(answers.size(), 60u) << "every turn (B7)";
  for (std::size_t i = 2; i < answers.size(); ++i) {
    const auto measurement = lms200::decoded_measurement(answers[i]);
    ASSERT_TRUE(measurement && measurement->is_partial);
    EXPECT_EQ(measurement->words.size(), measurement->partial_number == 0 ? 181u : 180u) << "B6";
    EXPECT_DOUBLE_EQ(rig.sweeps[i - 2].first_angle_shift_deg, 0.25 * measurement->partial_number);
    const auto before = lms200::decoded_measurement(answers[i - 1]);
    if (before) {
      EXPECT_EQ(measurement->partial_number, (before->partial_number + 1) % 4);
    }
  }
}

TEST(VirtualLms200, StreamsRangesWithReflectivity) {
  Lms200Setup setup;
  setup.baud = 500000;
  Lms200Rig rig{setup};
  const std::vector<lms200::ValueRange> asked{{1, 50}, {100, 180}};
  const auto answers =
      rig.ask(lms200::selection_request({lms200::ValueSelection::Kind::kWithReflectivity, 1, asked}, true), 0.5);
  ASSERT_GE(answers.size(), 10u);
  const auto parts = lms200::decoded_reflecting_ranges(answers.back());
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->size(), 2u);
  EXPECT_EQ((*parts)[1].range, asked[1]);
  EXPECT_EQ((*parts)[1].measurement.words.size(), 81u);
}

TEST(VirtualLms200, RefusesSelectionsThatItsVariantDoesNotHave) {
  Lms200Setup setup;
  setup.baud = 38400;
  setup.variant = {180, 100};
  Lms200Rig rig{setup};
  const lms200::ValueSelection too_far{lms200::ValueSelection::Kind::kSubRange, 1, {{1, 182}}};
  for (const bool as_stream : {true, false}) {
    EXPECT_EQ(answer_of(rig, lms200::selection_request(too_far, as_stream)).command, lms200::response::kRefused);
  }
  EXPECT_FALSE(rig.laser.is_streaming());
}

}  // namespace
}  // namespace deltamap::simulation::devices
