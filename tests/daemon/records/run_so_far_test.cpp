// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/run_so_far.hpp"

#include <gtest/gtest.h>

#include "daemon/records/journal.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "drivers/lms200/command.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "tests/support/daemon/saving_fixture.hpp"

namespace deltamap::daemon {
namespace {

using drivers::port::ByteRecord;
using drivers::port::PortId;
using test::at_s;

ByteRecord record(PortId port, double time_s, std::vector<std::uint8_t> bytes, std::string note = {}) {
  return {.port = port, .stamp = at_s(time_s), .bytes = std::move(bytes), .note = std::move(note)};
}

std::vector<std::uint8_t> reply(std::uint8_t command, std::uint8_t content) {
  return drivers::lms200::encoded_reply(command, std::vector<std::uint8_t>(4, content));
}

TEST(RunSoFar, SaysTheNewestOfWhatADeviceToldOfItselfAndNoScan) {
  RunSoFar so_far{{9600, 9600}};
  so_far.read(record(PortId::kLaser, 0.0, {}, session_note(PortId::kLaser)));
  so_far.read(record(PortId::kLaser, 1.0, reply(drivers::lms200::response::kStatus, 1)));
  so_far.read(record(PortId::kLaser, 2.0, {}, "baud 38400"));
  so_far.read(record(PortId::kLaser, 3.0, reply(drivers::lms200::response::kScan, 2)));
  std::vector<std::uint8_t> cut = reply(drivers::lms200::response::kStatus, 3);
  const std::vector<std::uint8_t> end(cut.begin() + 5, cut.end());
  cut.resize(5);
  so_far.read(record(PortId::kLaser, 4.0, cut));
  so_far.read(record(PortId::kLaser, 4.01, end));
  EXPECT_EQ(so_far.bauds().laser, 38400u);
  EXPECT_EQ(so_far.bauds().robot, 9600u);
  const auto begin = so_far.beginning({"run"}, at_s(5.0));
  ASSERT_EQ(begin.size(), 4u);
  EXPECT_EQ(begin[0].note, "run");
  EXPECT_EQ(begin[1].note, kEarlierNote);
  EXPECT_EQ(begin[2].bytes, reply(drivers::lms200::response::kStatus, 3));
  EXPECT_EQ(begin[3].note, kPartNote);
  for (const ByteRecord& one : begin) EXPECT_EQ(one.stamp, at_s(5.0));
}

TEST(RunSoFar, ForgetsWhatWasSaidInAnEarlierSession) {
  RunSoFar so_far{{9600, 9600}};
  const std::vector<std::uint8_t> sync2 = drivers::pioneer::encoded_packet(std::vector<std::uint8_t>{0x02, 'a', 0});
  so_far.read(record(PortId::kRobot, 0.0, sync2));
  EXPECT_EQ(so_far.beginning({}, at_s(1.0)).size(), 3u);
  so_far.read(record(PortId::kRobot, 2.0, {}, session_note(PortId::kRobot)));
  EXPECT_EQ(so_far.beginning({}, at_s(3.0)).size(), 2u);
}

TEST(RunSoFar, SaysThatMappingIsPaused) {
  RunSoFar so_far{{9600, 9600}};
  const std::string paused = note_of({Decision::Kind::kPaused, 5, 0, {}, at_s(1.0)});
  so_far.read(record(PortId::kRobot, 1.0, {}, paused));
  EXPECT_EQ(so_far.beginning({}, at_s(2.0)).back().note, paused);
}

TEST(RunSoFar, SaysWhichBaysAndZonesAreInForce) {
  RunSoFar so_far{{9600, 9600}};
  SharedSite newest;
  for (const char* id : {"early", "late"}) {
    const Zone zone{.id = id, .polygon = {{1, 1}, {2, 1}, {2, 2}}};
    newest = std::make_shared<const Site>(Site{{{.id = "B4", .polygon = {{1, 1}, {2, 1}, {2, 2}}}}, {zone}});
    for (std::string& note : notes_of(SetSite{7, at_s(0.5), newest}))
      so_far.read(record(PortId::kRobot, 1.0, {}, note));
  }
  Journal journal;
  journal.read(note_of(RunIdentity{}));
  for (const ByteRecord& one : so_far.beginning({}, at_s(2.0))) journal.read(one.note);
  ASSERT_EQ(journal.commands().size(), 1u) << "the newest alone";
  EXPECT_EQ(*journal.commands().front().site, *newest);
  Scan first;
  first.time = at_s(2.1);
  EXPECT_TRUE(std::is_lt(journal.place_of(journal.commands().front(), first))) << "before the part's first scan";
  for (const std::string& note : so_far.site_notes()) journal.read(note);
  EXPECT_EQ(journal.commands().size(), 1u) << "repeated behind a gap it is no other command";
}

TEST(RunSoFar, WhatWasSaidBeforeIsDecodedAndNotHandedOver) {
  RecordingDecoder decoder{Settings{}};
  std::uint32_t odometry = 0;
  const RecordingDecoder::Sinks sinks{[&](Odometry&&, std::uint32_t number) { EXPECT_EQ(number, odometry++); },
                                      [](Scan&&) {}};
  std::vector<std::uint8_t> sip(24, 0);
  sip[0] = 0x32;
  const auto packet = drivers::pioneer::encoded_packet(sip);
  decoder.feed(record(PortId::kRobot, 0.0, {}, std::string(kEarlierNote)), sinks);
  decoder.feed(record(PortId::kRobot, 0.0, packet), sinks);
  EXPECT_EQ(odometry, 0u);
  decoder.feed(record(PortId::kRobot, 0.0, {}, std::string(kPartNote)), sinks);
  decoder.feed(record(PortId::kRobot, 0.1, packet), sinks);
  EXPECT_EQ(odometry, 1u);
  EXPECT_EQ(decoder.counts().at("robot.frames"), 2u);
}

}  // namespace
}  // namespace deltamap::daemon
