// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/thing_score.hpp"

#include <gtest/gtest.h>

#include <array>

namespace deltamap::experiments {
namespace {

using mapping::things::Outline;
using mapping::things::Thing;

TEST(ThingScore, WhatWasSeenAllAroundIsPartOfWhatWasSeen) {
  std::array<TrueChange, 3> changes;
  changes[0].is_seen = true;
  changes[1].is_seen = changes[1].is_seen_all_around = true;
  EXPECT_EQ(score_of({}, changes).changes, 2u);
  EXPECT_EQ(score_of({}, only_seen_all_around(changes)).changes, 1u);
}

TEST(ThingScore, AnAssumedSideIsRightWhereASideOfABoxLies) {
  Thing thing;
  thing.at = Outline{{5.0, 5.0}, 2.4, 1.6, 0.0, {false, false, true, true}, {true, true, false, false}};
  const std::array things{thing};
  const std::array as_told{simulation::Box{{5.0, 5.0}, 2.4, 1.6, 0.0}};
  const std::array deeper{simulation::Box{{5.0, 5.2}, 2.4, 2.0, 0.0}};  // farther to the side of +width alone
  EXPECT_EQ(assumed_score_of(things, as_told).sides, 2u);
  EXPECT_EQ(assumed_score_of(things, as_told).right, 2u);
  EXPECT_EQ(assumed_score_of(things, as_told).of_seen, 0u);
  EXPECT_EQ(assumed_score_of(things, deeper).right, 1u);
  EXPECT_EQ(assumed_score_of(things, {}).right, 0u);
}

TEST(ThingScore, AMoveOnIsAnotherEventThanTheMoveBefore) {
  mapping::things::ThingEvent event;
  event.thing.id = 1;
  event.thing.kind = mapping::things::ThingKind::kMoved;
  event.time = timestamp_from_ns(0);
  event.is_new = true;
  mapping::things::ThingEvent update = event;
  update.is_new = false;
  mapping::things::ThingEvent on = event;
  on.time = event.time + duration_from_seconds(100.0);
  EXPECT_EQ(told_at_last(std::array{event, update, on}, 60.0).size(), 2u);
  EXPECT_EQ(told_at_last(std::array{event, update}, 60.0).size(), 1u);
}

}  // namespace
}  // namespace deltamap::experiments
