// SPDX-License-Identifier: Apache-2.0
#include "tool/view/run_events.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

namespace deltamap::tool {
namespace {

using daemon::Decision;
using nlohmann::json;

constexpr double kBeganS = 1'700'000'000.0;
Timestamp after_s(double time_s) {
  return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(time_s);
}

TEST(RunEvents, AreThoseThatAPersonJumpsToInTheOrderOfTime) {
  RunEvents events;
  daemon::LocalizationRow row;
  const auto scan = [&](double time_s, LocalizerState state) {
    row.time = after_s(time_s);
    row.state = state;
    events.observe(row);
  };
  scan(0.0, LocalizerState::kTracking);
  scan(1.0, LocalizerState::kTracking);
  scan(4.0, LocalizerState::kTracking);
  scan(5.0, LocalizerState::kLost);
  daemon::ChangeNote note;
  note.time = after_s(2.0);
  note.reason = "too few scans";
  events.observe(note);
  note.time = after_s(3.0);
  note.revision = 7;
  events.observe(note);
  events.add_orders({{Decision::Kind::kPaused, 5, 0, {}, after_s(6.0)}, {Decision::Kind::kResumed, 9}});
  daemon::Incident incident;
  incident.events = {{daemon::IncidentKind::kMark, after_s(5.5), "marked by an operator: pallet fell"}};
  events.add(incident);
  const json expected{
      {{"kind", "gap"}, {"time", kBeganS + 1.0}, {"words", "no scan for 3.0 s"}},
      {{"kind", "refusal"}, {"time", kBeganS + 2.0}, {"words", "too few scans"}},
      {{"kind", "change"}, {"time", kBeganS + 3.0}, {"words", "revision 7"}},
      {{"kind", "loss"}, {"time", kBeganS + 5.0}, {"words", "the pose was lost: the scans speak against it"}},
      {{"kind", "incident"}, {"time", kBeganS + 5.5}, {"words", "mark: marked by an operator: pallet fell"}},
      {{"kind", "order"}, {"time", kBeganS + 6.0}, {"words", "mapping paused"}}};
  EXPECT_EQ(json::parse(events.json()), expected);
}

TEST(RunEvents, BaysAndZonesThatARunBeganWithAreNoOrder) {
  RunEvents events;
  const auto site = std::make_shared<const daemon::Site>();
  events.add_orders({{.kind = Decision::Kind::kSiteSet, .scan = 0, .scan_time = Timestamp{}, .site = site},
                     {.kind = Decision::Kind::kSiteSet, .scan = 9, .scan_time = after_s(3.0), .site = site}});
  EXPECT_EQ(json::parse(events.json()),
            (json{{{"kind", "order"}, {"time", kBeganS + 3.0}, {"words", "bays: 0, zones: 0"}}}));
}

TEST(RunEvents, OfNothingAreNone) { EXPECT_EQ(RunEvents{}.json(), "[]"); }

}  // namespace
}  // namespace deltamap::tool
