// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/byte_log.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/support/bytes/cut_file.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::port {
namespace {

const std::vector<ByteRecord> kRecords = {
    {PortId::kRobot,
     Direction::kOut,
     timestamp_from_ns(976055546374470001),
     {0xFA, 0xFB, 0x03, 0x00, 0x00, 0x00},
     "",
     9600},
    {PortId::kRobot, Direction::kIn, timestamp_from_ns(976055546374480002), {0xFA}, "", 9600},
    {PortId::kLaser,
     Direction::kIn,
     timestamp_from_ns(976055546374480003),
     {0x02, 0x80, 0x00, 0x00, 0x06},
     "with a word",
     38400},
    {PortId::kLaser, Direction::kIn, timestamp_from_ns(976055546400000000), {}, baud_note(500000), 500000},
    {PortId::kRobot, Direction::kIn, timestamp_from_ns(976055546400000001), {}, "revision 3 before scan 17", 9600},
    {PortId::kLaser, Direction::kIn, timestamp_from_ns(976055546500000004), {1, 2, 3, 4, 5, 6, 7, 8}, "", 500000},
};

void write_log(const std::filesystem::path& file, const std::vector<ByteRecord>& records = kRecords) {
  ByteLogWriter writer{file, {.robot = 9600, .laser = 38400}};
  for (const auto& record : records) writer.write(record);
  writer.close();
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string refusal(const std::filesystem::path& file) {
  try {
    ByteLogReader reader{file};
    while (reader.next()) {
    }
    return reader.cut() ? reader.cut()->text : "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(ByteLog, GivesBackEveryRecordInOrderWithTheBaudInForce) {
  const test::TemporaryFolder folder;
  write_log(folder.path() / "a.pcapng");
  ByteLogReader reader{folder.path() / "a.pcapng"};
  for (const auto& expected : kRecords) {
    const auto record = reader.next();
    ASSERT_TRUE(record);
    EXPECT_TRUE(*record == expected) << expected.note << unix_ns(record->stamp);
  }
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.cut());
  EXPECT_EQ(reader.read_bytes(), reader.size_bytes());
}

TEST(ByteLog, BeginsWithTheBytesOfThePcapngSpecification) {
  const test::TemporaryFolder folder;
  write_log(folder.path() / "a.pcapng", {});
  const std::string head = bytes_of(folder.path() / "a.pcapng");
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(head.at(i)); };
  EXPECT_EQ(head.substr(0, 4), "\x0A\x0D\x0D\x0A");
  EXPECT_EQ(head.substr(8, 4), "\x4D\x3C\x2B\x1A");
  const std::size_t interface = at(4);
  EXPECT_EQ(at(interface), 1);        // interface description
  EXPECT_EQ(at(interface + 8), 147);  // LINKTYPE_USER0
  EXPECT_NE(head.find(std::string("\x02\0\x05\0robot\0\0\0", 12)), std::string::npos);
  EXPECT_NE(head.find(std::string("\x08\0\x08\0\x80\x25\0\0\0\0\0\0", 12)), std::string::npos);  // 9600 bit/s
  EXPECT_NE(head.find(std::string("\x09\0\x01\0\x09\0\0\0", 8)), std::string::npos);
}

TEST(ByteLog, CutAtAnyByteGivesAllWholeRecordsAndThePlaceOfTheCut) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "cut.pcapng";
  write_log(file);
  const std::string whole = bytes_of(file);
  const std::vector<std::size_t> blocks = test::block_ends(whole);
  const std::size_t header = blocks[2];
  const std::vector<std::size_t> ends{blocks.begin() + 3, blocks.end() - 1};  // of each record's block
  for (std::size_t kept = header; kept < whole.size(); ++kept) {
    folder.write("cut.pcapng", whole.substr(0, kept));
    const auto complete =
        static_cast<std::size_t>(std::count_if(ends.begin(), ends.end(), [&](auto end) { return end <= kept; }));
    ByteLogReader reader{file};
    for (std::size_t i = 0; i < complete; ++i) ASSERT_TRUE(reader.next().value() == kRecords[i]) << kept;
    EXPECT_FALSE(reader.next());
    const std::size_t clean = complete == 0 ? header : ends[complete - 1];
    ASSERT_EQ(reader.cut().has_value(), kept != clean) << kept;
    if (reader.cut()) {
      EXPECT_NE(reader.cut()->text.find("cut.pcapng: byte " + std::to_string(clean) + ": cut short"),
                std::string::npos);
    }
  }
}

TEST(ByteLog, ADamagedBlockEndsItAsACutDoes) {
  const test::TemporaryFolder folder;
  write_log(folder.path() / "a.pcapng");
  const std::string whole = bytes_of(folder.path() / "a.pcapng");
  for (const std::string& tail :
       {std::string(5000, '\0'), std::string(5000, '\xFF'), std::string("\6\0\0\0\7\0\0\0", 8)}) {
    ByteLogReader reader{folder.write("b.pcapng", whole + tail + whole)};
    std::size_t count = 0;
    while (reader.next()) ++count;
    EXPECT_EQ(count, kRecords.size());
    ASSERT_TRUE(reader.cut());
    EXPECT_EQ(reader.cut()->byte, whole.size());
    EXPECT_EQ(reader.cut()->unread_bytes, tail.size() + whole.size());
    EXPECT_EQ(reader.cut()->last_record, kRecords.back().stamp);
    EXPECT_NE(reader.cut()->text.find("the last whole record is of 2000-12-05T22:32:26.500Z, 0.126 s after the first"),
              std::string::npos)
        << reader.cut()->text;
  }
}

TEST(ByteLog, CutInsideItsHeaderIsToldWithThePlace) {
  const test::TemporaryFolder folder;
  write_log(folder.path() / "a.pcapng", {});
  const std::string head = bytes_of(folder.path() / "a.pcapng");
  for (std::size_t kept = 1; kept < head.size(); ++kept) {
    EXPECT_NE(refusal(folder.write("cut.pcapng", head.substr(0, kept))).find("cut.pcapng: byte "), std::string::npos)
        << kept;
  }
  EXPECT_EQ(refusal(folder.write("whole.pcapng", head)), "");
}

TEST(ByteLog, EveryDamagedByteOfTheGrammarIsRefusedOrReadButNeverOverruns) {
  const test::TemporaryFolder folder;
  write_log(folder.path() / "a.pcapng");
  const std::string whole = bytes_of(folder.path() / "a.pcapng");
  int refused = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0xFF);
    refused +=
        refusal(folder.write("damaged.pcapng", damaged)).find("damaged.pcapng: byte ") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(refused, 80);  // types of unknown blocks, padding and contents cannot be told from other ones
}

TEST(ByteLog, NamesForeignFilesInOneLine) {
  const test::TemporaryFolder folder;
  EXPECT_NE(refusal(folder.path() / "none.pcapng").find("none.pcapng: No such file"), std::string::npos);
  EXPECT_NE(refusal(folder.path()).find("is a directory"), std::string::npos);
  EXPECT_NE(refusal(folder.write("e.pcapng", "")).find("e.pcapng: byte 0: the file is empty"), std::string::npos);
  EXPECT_NE(refusal(folder.write("t.pcapng", "P5 100")).find("t.pcapng: byte 0: not a recording (pcapng)"),
            std::string::npos);
  write_log(folder.path() / "a.pcapng");
  std::string ethernet = bytes_of(folder.path() / "a.pcapng");
  for (std::size_t at; (at = ethernet.find("robot")) != std::string::npos;) ethernet.replace(at, 5, "eth00");
  EXPECT_NE(refusal(folder.write("eth.pcapng", ethernet)).find("neither robot nor laser"), std::string::npos);
}

TEST(ByteLog, SkipsBlocksOfOtherTools) {
  const test::TemporaryFolder folder;
  write_log(folder.path() / "a.pcapng");
  const std::string statistics("\x05\0\0\0\x10\0\0\0\0\0\0\0\x10\0\0\0", 16);  // an interface statistics block
  ByteLogReader reader{folder.write("b.pcapng", bytes_of(folder.path() / "a.pcapng") + statistics)};
  std::size_t count = 0;
  while (reader.next()) ++count;
  EXPECT_EQ(count, kRecords.size());
}

TEST(ByteLog, ReportsAFullDiskAndTakesNoMore) {
  EXPECT_THROW(
      {
        try {
          ByteLogWriter writer("/dev/full", FirstBauds{});
        } catch (const std::runtime_error& error) {
          EXPECT_NE(std::string(error.what()).find("/dev/full: cannot be written: No space left"), std::string::npos);
          throw;
        }
      },
      std::runtime_error);
  EXPECT_THROW(ByteLogWriter("/nowhere/a.pcapng", FirstBauds{}), std::runtime_error);
}

TEST(ByteLog, EndsWithAWholeBlockWhereTheDiskFilledUp) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "full.pcapng";
  rlimit old_limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100'001, old_limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::size_t taken = 0;
  std::string told;
  {
    ByteLogWriter writer{file, {}};
    try {
      for (; taken < 100'000; ++taken) writer.write(kRecords[2]);
    } catch (const std::runtime_error& error) {
      told = error.what();
    }
    writer.write(kRecords[2]);
    EXPECT_THROW(writer.flush(), std::runtime_error) << "tried again, and still full";
  }
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(told.find("full.pcapng: cannot be written: File too large"), std::string::npos) << told;
  ByteLogReader reader{file};
  std::size_t kept = 0;
  while (reader.next()) ++kept;
  EXPECT_FALSE(reader.cut());
  EXPECT_GT(kept, 1000u);
  EXPECT_LE(kept, taken);
}

TEST(ByteLog, IsReadByCapinfos) {
  if (std::system("command -v capinfos > /dev/null 2>&1") != 0) GTEST_SKIP() << "capinfos is not installed";
  const test::TemporaryFolder folder;
  const auto file = (folder.path() / "a.pcapng").string();
  write_log(file);
  EXPECT_EQ(std::system(("capinfos '" + file + "' > '" + file + ".txt' 2>&1").c_str()), 0);
  const std::string told = bytes_of(file + ".txt");
  EXPECT_NE(told.find("Number of packets:   7"), std::string::npos) << told;
  EXPECT_NE(told.find("Name = laser"), std::string::npos) << told;
  EXPECT_NE(told.find("nanosecond"), std::string::npos) << told;
}

}  // namespace
}  // namespace deltamap::drivers::port
