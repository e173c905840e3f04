// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/kept_bays.hpp"

#include <gtest/gtest.h>

#include "tests/support/daemon/saving_fixture.hpp"

namespace deltamap::daemon {
namespace {

using mapping::bays::Bay;
using mapping::bays::BayState;
using mapping::bays::BayStatus;
using test::at_s;

constexpr std::uint64_t kMap = 0xFEDCBA9876543210u;

Bay bay(const std::string& id, double x) { return {.id = id, .polygon = {{x, 1.001}, {x + 2.4, 1.0}, {x + 2.4, 3.4}}}; }
BayStatus seen(BayState state, double s) {
  return {.state = state, .share = 0.9, .confidence = 0.8, .seen = at_s(s), .since = at_s(s - 5.0)};
}
BayList earlier() {
  return {{bay("B1", 1.0), bay("B2", 4.0), bay("B3", 7.0)},
          {seen(BayState::kFull, 100.0), {.since = at_s(90)}, seen(BayState::kEmpty, 110.0)}};
}
BayList kept_at(double now_s, std::uint64_t map = kMap) {
  return bays_of_kept_text(kept_text(earlier(), kMap), map, at_s(now_s));
}

TEST(KeptBays, WhatIsKnownSurvivesWithItsTimesAndWhatIsUnknownDoesNot) {
  const BayList kept = kept_at(200.0);
  ASSERT_EQ(kept.bays.size(), 2u);
  EXPECT_EQ(kept.bays[0], bay("B1", 1.0));
  EXPECT_EQ(kept.statuses[0], seen(BayState::kFull, 100.0));
  EXPECT_EQ(kept.statuses[1], seen(BayState::kEmpty, 110.0));
}

TEST(KeptBays, NothingIsKeptOfAnotherMapOfAClockThatWasAheadOrOfADamagedFile) {
  EXPECT_TRUE(kept_at(200.0, kMap + 1).bays.empty());
  EXPECT_EQ(kept_at(105.0).bays.size(), 1u) << "the other would look younger than it is";
  for (const std::string& text :
       {std::string{}, std::string{"{}"}, std::string{"[1]"}, kept_text(earlier(), kMap).substr(0, 90),
        std::string{R"({"map":"fedcba9876543210","bays":[{"bay":"B1"}]})"}})
    EXPECT_TRUE(bays_of_kept_text(text, kMap, at_s(200)).bays.empty()) << text;
}

TEST(KeptBays, ARestartShowsThemAsOldAsTheyAreUntilItHasLookedItself) {
  RememberedBays remembered{kept_at(200.0)};
  BayList now{{bay("B1", 1.0), bay("B3", 7.5), bay("B4", 9.0)}, std::vector<BayStatus>(3)};
  auto shown = remembered.beside(now);
  EXPECT_EQ(shown->statuses[0], seen(BayState::kFull, 100.0));
  EXPECT_EQ(shown->statuses[1], BayStatus{}) << "it has been moved";
  EXPECT_EQ(shown->is_remembered, (std::vector<bool>{true, false, false}));
  now.statuses[0] = seen(BayState::kEmpty, 210.0);
  shown = remembered.beside(now);
  EXPECT_EQ(shown->statuses[0], now.statuses[0]);
  EXPECT_FALSE(shown->is_remembered[0]);
  now.statuses[0] = {.since = at_s(220)};
  EXPECT_EQ(remembered.beside(now)->statuses[0], now.statuses[0])
      << "taken back: what was before is remembered no more";
  now.statuses[0] = {};
  EXPECT_EQ(remembered.beside(now)->statuses[0], BayStatus{});
}

TEST(KeptBays, AFileThatIsNotThereIsNone) {
  EXPECT_TRUE(remembered_bays("/nowhere/store.bays-seen.json", kMap, at_s(0)).beside({})->bays.empty());
}

}  // namespace
}  // namespace deltamap::daemon
