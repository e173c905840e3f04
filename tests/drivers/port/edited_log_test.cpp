// SPDX-License-Identifier: Apache-2.0
// What other programs do to a recording: read as it was written, or told.
#include <gtest/gtest.h>

#include <algorithm>

#include "drivers/port/byte_log.hpp"
#include "tests/support/bytes/edited_recording.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::drivers::port {
namespace {

using test::CapturePacket;

struct Read {
  std::vector<ByteRecord> records;
  LogFaults faults;
  std::string refusal;

  [[nodiscard]] bool tells(const std::string& what) const {
    return faults.doubts.size() == 1 && faults.doubts.front().find("r.pcapng: " + what) != std::string::npos;
  }
};

class EditedLog : public testing::Test {
 protected:
  EditedLog() {
    ByteLogWriter writer{folder_.path() / "r.pcapng", {.robot = 9600, .laser = 38400}};
    for (int i = 0; i < 30; ++i) {
      ByteRecord record;
      record.port = i % 2 == 0 ? PortId::kRobot : PortId::kLaser;
      record.stamp = timestamp_from_ns(1'700'000'000'000'000'000 + i * 10'000'000);
      if (i % 5 == 3) {
        record.note = i == 3 ? baud_note(500'000) : "revision " + std::to_string(i) + " before scan 17";
      } else {
        record.bytes.assign(static_cast<std::size_t>(20 + 7 * i), static_cast<std::uint8_t>(i));
        record.direction = i % 5 == 4 ? Direction::kOut : Direction::kIn;
      }
      writer.write(record);
    }
    writer.close();
    whole_ = test::content_of(folder_.path() / "r.pcapng");
    written_ = read(whole_).records;
  }

  Read read(const std::string& file) {
    Read read;
    try {
      ByteLogReader reader{folder_.write("r.pcapng", file)};
      while (auto record = reader.next()) read.records.push_back(std::move(*record));
      read.faults = reader.faults();
    } catch (const std::runtime_error& error) {
      read.refusal = error.what();
    }
    return read;
  }

  void expect_as_written(const std::string& file) {
    const Read again = read(file);
    EXPECT_EQ(again.refusal, "");
    ASSERT_EQ(again.records.size(), written_.size());
    for (std::size_t i = 0; i < written_.size(); ++i) EXPECT_TRUE(again.records[i] == written_[i]) << i;
    for (const std::string& line : again.faults.lines()) ADD_FAILURE() << line;
    EXPECT_FALSE(again.faults.lacks_records);
    EXPECT_FALSE(again.faults.lacks_end);
  }

  test::TemporaryFolder folder_;
  std::string whole_;
  std::vector<ByteRecord> written_;
};

bool carries_note(const CapturePacket& packet) { return !packet.comment().empty(); }
bool any(const CapturePacket&) { return true; }

TEST_F(EditedLog, AsItWasWrittenLacksNothing) {
  EXPECT_EQ(written_.size(), 30u);
  expect_as_written(whole_);
}

TEST_F(EditedLog, RemarksOnAnyPacketLeaveEveryNote) {
  for (const std::string& remark :
       {std::string("here it hit the rack"), std::string("two\r\nlines"), std::string("\n"), std::string("")}) {
    expect_as_written(test::with_remark(whole_, carries_note, remark));
    expect_as_written(test::with_remark(whole_, any, remark));
    expect_as_written(test::with_remark(test::with_remark(whole_, any, remark), any, "and another"));
    expect_as_written(
        test::with_comments_rewritten(whole_, [&](const std::string& note) { return note + "\n" + remark; }));
    expect_as_written(
        test::with_comments_rewritten(whole_, [&](const std::string& note) { return remark + "\r\n" + note; }));
  }
}

TEST_F(EditedLog, ARemarkThatReadsLikeANoteIsNone) {
  expect_as_written(test::with_remark(whole_, any, baud_note(19'200)));
  expect_as_written(test::with_remark(whole_, any, "recording ends at 5"));
}

TEST_F(EditedLog, OfOlderRecordingsEveryLineIsTaken) {
  const std::string older = test::without_option(whole_, CapturePacket::kId);
  for (const std::string& edited :
       {older, test::with_remark(older, carries_note, "here it hit the rack"),
        test::with_comments_rewritten(older, [](const std::string& note) { return "it hit\r\n" + note; })}) {
    const Read again = read(edited);
    EXPECT_FALSE(again.faults.lacks_records);
    EXPECT_EQ(again.faults.lines().size(), 1u) << "that nothing tells whether packets are missing";
    std::vector<std::string> notes;
    for (const ByteRecord& record : again.records) {
      if (record.note.starts_with("revision") || baud_of_note(record.note)) notes.push_back(record.note);
      EXPECT_EQ(record.note.find_first_of("\r\n"), std::string::npos);
    }
    EXPECT_EQ(notes.size(), 6u);
    const auto of_laser = std::find_if(again.records.rbegin(), again.records.rend(),
                                       [](const ByteRecord& record) { return record.port == PortId::kLaser; });
    ASSERT_NE(of_laser, again.records.rend());
    EXPECT_EQ(of_laser->baud, 500'000u);
  }
}

TEST_F(EditedLog, WithoutNumbersItIsToldThatMissingPacketsCannotBeSeen) {
  const std::string older = test::without_option(whole_, CapturePacket::kId);
  const std::string by_others = test::with_writer(older, "Editcap 4.0.6");
  for (const std::string& edited : {older, test::without_packets(older, 10, 14), by_others}) {
    const LogFaults faults = read(edited).faults;
    ASSERT_EQ(faults.doubts.size(), 1u);
    EXPECT_NE(faults.doubts[0].find("whether packets are missing cannot be checked"), std::string::npos);
    EXPECT_EQ(faults.doubts[0].find("direction"), std::string::npos) << faults.doubts[0];
    EXPECT_TRUE(faults.is_unchecked);
    EXPECT_FALSE(faults.lacks_records);
  }
  const LogFaults undirected = read(test::without_option(older, 2)).faults;
  ASSERT_EQ(undirected.doubts.size(), 1u);
  EXPECT_NE(undirected.doubts[0].find("without direction (epb_flags)"), std::string::npos) << undirected.doubts[0];
  EXPECT_FALSE(read(whole_).faults.is_unchecked);
  EXPECT_FALSE(read(test::with_writer(whole_, "Editcap 4.0.6")).faults.is_unchecked);
  const std::string foreign = test::with_writer(test::without_option(older, CapturePacket::kComment), "dumpcap");
  EXPECT_FALSE(read(foreign).faults.is_unchecked) << "written by somebody who knows of no numbers";
}

TEST_F(EditedLog, BlocksWithoutPacketsAndMovedInterfacesChangeNothing) {
  expect_as_written(test::with_other_blocks(whole_));
  const Read merged = read(test::merged_behind_foreign(whole_, 4));
  ASSERT_EQ(merged.records.size(), written_.size());
  for (std::size_t i = 0; i < written_.size(); ++i) EXPECT_TRUE(merged.records[i] == written_[i]) << i;
  EXPECT_FALSE(merged.faults.lacks_records);
  EXPECT_TRUE(merged.tells("7 packets of another interface, eth0 (link type 1), left out"))
      << testing::PrintToString(merged.faults.doubts);
}

TEST_F(EditedLog, PartsThatAreJoinedAgainAreTheRecording) {
  const std::size_t count = test::packets_in(whole_);
  const std::string first = test::without_packets(whole_, 11, count);
  const std::string second = test::without_packets(whole_, 1, 10);
  expect_as_written(first + second);  // two sections
  std::vector<test::CaptureBlock> joined = test::blocks_of(first);
  for (const test::CaptureBlock& block : test::blocks_of(second)) {
    if (block.type == 1) joined.push_back(block);  // as mergecap -I none: four interfaces
    if (block.type != CapturePacket::kType) continue;
    CapturePacket packet = test::packet_of(block);
    packet.interface += 2;
    joined.push_back(test::block_of(packet));
  }
  std::stable_partition(joined.begin(), joined.end(),
                        [](const test::CaptureBlock& block) { return block.type != CapturePacket::kType; });
  expect_as_written(test::file_of(joined));
}

TEST_F(EditedLog, PacketsThatWereTakenOutAreTold) {
  const Read hole = read(test::without_packets(whole_, 9, 14));
  EXPECT_EQ(hole.records.size(), 24u);
  EXPECT_TRUE(hole.faults.lacks_records);
  EXPECT_TRUE(hole.tells("6 packets missing")) << testing::PrintToString(hole.faults.doubts);
  EXPECT_TRUE(read(test::without_packets(whole_, 1, 1)).tells("1 packet missing"));
}

TEST_F(EditedLog, AMissingEndIsTold) {
  for (const std::size_t kept : {1u, 20u, 30u}) {
    const Read begun = read(test::without_packets(whole_, kept + 1, 31));
    EXPECT_EQ(begun.records.size(), kept);
    EXPECT_FALSE(begun.faults.lacks_records);
    EXPECT_TRUE(begun.faults.lacks_end);
    EXPECT_TRUE(begun.tells("its end is missing")) << testing::PrintToString(begun.faults.doubts);
  }
}

TEST_F(EditedLog, PacketsCutByASnapLengthAreLeftOutAndTold) {
  for (const std::string& file : {whole_, test::without_option(whole_, CapturePacket::kId)}) {
    const Read snapped = read(test::with_snap_length(file, 40));
    EXPECT_TRUE(snapped.faults.lacks_records);
    EXPECT_TRUE(snapped.tells("21 packets cut by a snap length")) << testing::PrintToString(snapped.faults.doubts);
    std::size_t notes = 0;
    for (const ByteRecord& record : snapped.records) {
      EXPECT_LE(record.bytes.size(), 40u);
      notes += record.note.empty() ? 0 : 1;
    }
    EXPECT_EQ(notes, 6u);
  }
}

TEST_F(EditedLog, PacketsThatWereChangedAreLeftOutAndTold) {
  const Read chopped = read(test::with_ends_chopped(whole_, 3));
  EXPECT_EQ(chopped.records.size(), 6u) << "the notes";
  EXPECT_TRUE(chopped.tells("24 packets changed")) << testing::PrintToString(chopped.faults.doubts);
  const Read edited = read(test::with_comments_rewritten(
      whole_, [](const std::string& note) { return note == "revision 8 before scan 17" ? note + " (why?)" : note; }));
  EXPECT_EQ(edited.records.size(), 29u);
  EXPECT_TRUE(edited.tells("1 packet changed")) << testing::PrintToString(edited.faults.doubts);
  const Read flipped = read(test::with_packets_edited(whole_, [](std::size_t number, CapturePacket& packet) {
    if (number == 6) packet.bytes[2] = static_cast<char>(packet.bytes[2] ^ 4);
    return true;
  }));
  EXPECT_TRUE(flipped.tells("1 packet changed")) << testing::PrintToString(flipped.faults.doubts);
  const Read without_direction = read(test::without_option(whole_, 2));
  EXPECT_TRUE(without_direction.tells("6 packets changed")) << testing::PrintToString(without_direction.faults.doubts);
  for (const LogFaults& faults : {chopped.faults, edited.faults, flipped.faults, without_direction.faults}) {
    EXPECT_TRUE(faults.lacks_records);
  }
}

TEST_F(EditedLog, ADamagedNumberIsAChangedPacketAndPutsNoneOutOfOrder) {
  for (const std::size_t digit : {4u, 7u}) {
    const Read damaged = read(test::with_packets_edited(whole_, [&](std::size_t number, CapturePacket& packet) {
      for (auto& [code, value] : packet.options) {
        if (number == 9 && code == CapturePacket::kId) value[digit] = static_cast<char>(value[digit] ^ 0x40);
      }
      return true;
    }));
    EXPECT_EQ(damaged.records.size(), 29u);
    EXPECT_EQ(damaged.faults.doubts.size(), 2u) << testing::PrintToString(damaged.faults.doubts);
    EXPECT_NE(damaged.faults.doubts.front().find("1 packet missing"), std::string::npos);
    EXPECT_NE(damaged.faults.doubts.back().find("1 packet changed"), std::string::npos);
  }
}

TEST_F(EditedLog, NotesThatWereTakenOutAreTold) {
  EXPECT_TRUE(read(test::without_option(whole_, CapturePacket::kComment)).faults.lacks_records);
  const std::string older = test::without_option(whole_, CapturePacket::kId);
  const Read silenced = read(test::without_option(older, CapturePacket::kComment));
  EXPECT_TRUE(silenced.faults.lacks_records);
  EXPECT_TRUE(silenced.tells("7 packets without the note")) << testing::PrintToString(silenced.faults.doubts);
}

TEST_F(EditedLog, JoinedDoubledAndReorderedPacketsAreTold) {
  EXPECT_TRUE(read(whole_ + whole_).tells("1 packet out of order"));
  const std::vector<test::CaptureBlock> blocks = test::blocks_of(whole_);
  std::vector<test::CaptureBlock> doubled = blocks;
  doubled.insert(doubled.begin() + 9, blocks[8]);
  std::vector<test::CaptureBlock> swapped = blocks;
  std::swap(swapped[8], swapped[9]);
  for (const auto& file : {doubled, swapped}) {
    const Read again = read(test::file_of(file));
    EXPECT_TRUE(again.faults.lacks_records);
    EXPECT_NE(testing::PrintToString(again.faults.doubts).find("out of order"), std::string::npos);
  }
}

TEST_F(EditedLog, TimesThatWereMovedAreToldAndTheRestIsAsWritten) {
  const Read moved = read(test::shifted_in_time(whole_, 3'600'000'000'000));
  EXPECT_FALSE(moved.faults.lacks_records);
  EXPECT_TRUE(moved.tells("its times were moved by +3600 s")) << testing::PrintToString(moved.faults.doubts);
  ASSERT_EQ(moved.records.size(), written_.size());
  for (std::size_t i = 0; i < written_.size(); ++i) {
    EXPECT_EQ(moved.records[i].stamp - written_[i].stamp, std::chrono::hours{1});
    EXPECT_EQ(moved.records[i].bytes, written_[i].bytes);
  }
}

TEST_F(EditedLog, PacketsThatWereAddedOrHaveNoTimeAreTold) {
  std::vector<test::CaptureBlock> blocks = test::blocks_of(whole_);
  CapturePacket added = test::packet_of(blocks[4]);
  std::erase_if(added.options, [](const test::CaptureOption& option) { return option.first == CapturePacket::kId; });
  blocks.insert(blocks.begin() + 6, test::block_of(added));
  EXPECT_TRUE(read(test::file_of(blocks)).tells("1 packet without a number"));
  EXPECT_TRUE(read(whole_ + test::CaptureBlock{3, std::string(8, '\0')}.bytes()).tells("1 packet without a time"));
}

TEST_F(EditedLog, OtherTicksAndOffsetsGiveTheSameTimes) {
  // As some programs write: microseconds, half a year behind the epoch's second.
  constexpr std::uint64_t kOffset_s = 15'000'000;
  std::vector<test::CaptureBlock> blocks = test::blocks_of(whole_);
  for (test::CaptureBlock& block : blocks) {
    if (block.type == 1) {
      std::vector<test::CaptureOption> options = test::options_in(block.body.substr(8));
      for (auto& [code, value] : options) {
        if (code == 9) value = "\x06";
      }
      options.emplace_back(14, test::little_endian(kOffset_s));
      block.body = block.body.substr(0, 8) + test::bytes_of_options(options);
    } else if (block.type == CapturePacket::kType) {
      CapturePacket packet = test::packet_of(block);
      packet.ticks = packet.ticks / 1000 - kOffset_s * 1'000'000;
      block = test::block_of(packet);
    }
  }
  expect_as_written(test::file_of(blocks));
}

TEST_F(EditedLog, WhatCannotBeReadIsNamedWithWhatToDo) {
  const auto refusal = [&](const std::string& file) { return read(file).refusal; };
  EXPECT_NE(refusal("\x1F\x8B\x08 gzip").find("compressed with gzip; unpack it first: gunzip -k "), std::string::npos);
  EXPECT_NE(refusal("\x28\xB5\x2F\xFD and more").find("Zstandard"), std::string::npos);
  EXPECT_NE(refusal("\xD4\xC3\xB2\xA1 and more").find("the older pcap format"), std::string::npos);
  EXPECT_NE(refusal("\x4D\x3C\xB2\xA1 and more").find("the older pcap format"), std::string::npos);
  const std::string big_endian("\x0A\x0D\x0D\x0A\x00\x00\x00\x1C\x1A\x2B\x3C\x4D\x00\x01\x00\x00", 16);
  EXPECT_NE(refusal(big_endian + whole_).find("a big-endian recording"), std::string::npos);
  EXPECT_NE(refusal(whole_ + big_endian).find("a big-endian recording"), std::string::npos) << "a later section";
  std::string renamed = whole_;
  renamed.replace(renamed.find("robot"), 5, "eth00");
  EXPECT_NE(refusal(renamed).find("no interface is named robot; neither robot nor laser is eth00 (link type 147)"),
            std::string::npos)
      << refusal(renamed);
}

}  // namespace
}  // namespace deltamap::drivers::port
