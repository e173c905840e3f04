// SPDX-License-Identifier: Apache-2.0
// A recording that is a ring of parts.
#include <gtest/gtest.h>

#include "daemon/records/live_recording.hpp"
#include "daemon/records/recording_parts.hpp"
#include "drivers/port/byte_log.hpp"
#include "tests/support/daemon/saving_fixture.hpp"
#include "tests/support/files/full_disk.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using test::at_s;

class RecordingRing : public test::SavingFixture {
 protected:
  [[nodiscard]] LiveRecording::Options options(const RingLimits& limits) const {
    return {.file = file,
            .bauds = {9600, 9600},
            .first_notes = {"run"},
            .began = at_s(0),
            .max_gigabytes = 1e-9,
            .ring = limits,
            .part_notes = [](const Checkpoint& from) {
              return std::vector<std::string>{"from " + std::to_string(from.row.number)};
            }};
  }
  /// 100 kB and a checkpoint.
  static void record(LiveRecording& recording, int second) {
    drivers::port::ByteRecord record;
    record.port = drivers::port::PortId::kLaser;
    record.stamp = at_s(second);
    record.bytes.assign(100'000, static_cast<std::uint8_t>(second));
    recording.write(record, at_s(second));
    Checkpoint checkpoint;
    checkpoint.row.number = static_cast<std::uint32_t>(second);
    recording.begin_part(checkpoint, at_s(second));
  }
  /// First note and the laser's bytes, once each.
  [[nodiscard]] static std::string told(const fs::path& part, bool is_whole = true) {
    drivers::port::ByteLogReader reader{part};
    std::string text;
    while (const auto record = reader.next()) {
      if (!record->bytes.empty())
        text += " " + std::to_string(record->bytes[0]);
      else if (text.empty())
        text = record->note;
    }
    EXPECT_TRUE(!is_whole || reader.faults().lines().empty()) << reader.faults().lines().front();
    return text;
  }
  fs::path file = folder.path() / "ring.pcapng";
};

TEST_F(RecordingRing, BeginsAPartWhereTheOneBeforeIsFullAndDropsTheOldest) {
  {
    LiveRecording recording{options({.keep_gigabytes = 2e-3}), telemetry, warn()};  // parts of 200 kB, 2 MB in all
    for (int second = 1; second <= 50; ++second) record(recording, second);
    recording.close(at_s(51));
  }
  const std::vector<fs::path> parts = parts_of(file);
  ASSERT_EQ(parts.size(), 9u);
  EXPECT_EQ(parts.back().filename(), "ring.20231114T221408Z.pcapng") << "named after its beginning";
  EXPECT_EQ(told(parts.front()), "from 32 33 34");
  EXPECT_EQ(told(parts.back()), "from 48 49 50");
  EXPECT_EQ(told(file), "from 50");
  std::uintmax_t bytes = fs::file_size(file);
  for (const fs::path& part : parts) bytes += fs::file_size(part);
  EXPECT_LE(bytes, 2'000'000u);
  EXPECT_TRUE(telemetry.records.value()) << "max_gigabytes does not end it";
  EXPECT_TRUE(warnings.empty());
}

TEST_F(RecordingRing, TheRecordingOfTheRunBeforeIsAPart) {
  for (int run = 0; run < 2; ++run) {
    LiveRecording recording{options({.keep_hours = 1e4}), telemetry, warn()};
    record(recording, 1 + 10 * run);
    recording.close(at_s(2 + 10 * run));
  }
  ASSERT_EQ(parts_of(file).size(), 1u);
  EXPECT_EQ(told(parts_of(file).front()), "run 1");
  EXPECT_EQ(told(file), "run 11");
}

TEST_F(RecordingRing, PartsThatAreTooOldGo) {
  {
    LiveRecording recording{options({.keep_hours = 0.01}), telemetry, warn()};  // parts of 3.6 s
    for (int second = 1; second <= 12; ++second) record(recording, second);
    recording.close(at_s(13));
  }
  ASSERT_EQ(parts_of(file).size(), 3u);
  fs::last_write_time(parts_of(file)[0], fs::file_time_type::clock::now() - std::chrono::seconds{40});
  fs::last_write_time(parts_of(file)[1], fs::file_time_type::clock::now() - std::chrono::seconds{30});
  drop_oldest_parts(file, {.keep_hours = 0.01});
  EXPECT_EQ(parts_of(file).size(), 2u);
}

TEST_F(RecordingRing, WhereTheDiskIsFullNoPartIsOverwritten) {
  {
    LiveRecording recording{options({.keep_gigabytes = 2e-3}), telemetry, warn()};
    record(recording, 1);
    {
      const test::FullDisk full{50};
      record(recording, 2);
      record(recording, 3);
    }
    for (int second = 20; second <= 22; ++second) record(recording, second);
    recording.close(at_s(23));
  }
  const std::vector<fs::path> parts = parts_of(file);
  ASSERT_FALSE(parts.empty());
  EXPECT_TRUE(told(parts.front(), false).starts_with("run 1"));
}

TEST_F(RecordingRing, OtherFilesBesideItAreNoParts) {
  for (const char* name : {"ring.previous.pcapng", "ring.20231114T221408Z.txt", "other.20231114T221408Z.pcapng"})
    (void)folder.write(name, "x");
  EXPECT_TRUE(parts_of(file).empty());
}

}  // namespace
}  // namespace deltamap::daemon
