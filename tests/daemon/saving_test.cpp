// SPDX-License-Identifier: Apache-2.0
// What the outputs of the running daemon do while the disk is full, and when it is not any more.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <sstream>

#include "core/grid_file.hpp"
#include "daemon/line_file.hpp"
#include "daemon/live_recording.hpp"
#include "daemon/map_outputs.hpp"
#include "daemon/start_error.hpp"
#include "mapping/map_store.hpp"
#include "tests/support/full_disk.hpp"
#include "tests/support/not_root.hpp"
#include "tests/support/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

Timestamp at_s(double time_s) { return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(time_s); }

std::string content_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

class Saving : public testing::Test {
 protected:
  [[nodiscard]] RetryingOutput::Warn warn() {
    return [this](const std::string& line) { warnings.push_back(line); };
  }
  [[nodiscard]] OutputStatus status(const std::string& name) const {
    for (const OutputStatus& output : telemetry.outputs.all()) {
      if (output.name == name) return output;
    }
    ADD_FAILURE() << name << " is not on the board";
    return {};
  }

  test::TemporaryFolder folder;
  Telemetry telemetry;
  std::vector<std::string> warnings;
};

TEST_F(Saving, IsTriedAgainAfterOneTwoFourAndEightSeconds) {
  RetryingOutput output{"store", "store.sqlite", telemetry.outputs, warn()};
  std::vector<double> attempts;
  for (double time_s = 0.0; time_s < 40.0; time_s += 0.5) {
    (void)output.attempt(at_s(time_s), [&] {
      attempts.push_back(time_s);
      throw std::runtime_error("store.sqlite: full");
    });
  }
  EXPECT_EQ(attempts, (std::vector<double>{0.0, 1.0, 3.0, 7.0, 15.0, 23.0, 31.0, 39.0}));
  EXPECT_EQ(warnings, (std::vector<std::string>{"saving pauses: store: store.sqlite: full"}));
  EXPECT_FALSE(status("store").written);
  EXPECT_EQ(status("store").since, at_s(0.0));
  EXPECT_EQ(status("store").why, "store.sqlite: full");
  EXPECT_TRUE(output.attempt(at_s(60.0), [] {}));
  EXPECT_EQ(warnings.back(), "saving goes on: store after 60 s: store.sqlite");
  EXPECT_TRUE(status("store").written);
}

TEST_F(Saving, LinesAreNeverCutAndNoneIsLostWhileThereIsRoomToWait) {
  const auto file = folder.path() / "trajectory.tum";
  LiveLines lines{file, {"trajectory", file, telemetry.outputs, warn()}};
  lines.write("first line\n", at_s(0));
  lines.flush(at_s(0));
  {
    const test::FullDisk full{16};  // in the middle of the second line
    lines.write("second line\n", at_s(1));
    lines.flush(at_s(1));
    EXPECT_EQ(content_of(file), "first line\n");
    lines.write("third line\n", at_s(2));
    lines.flush(at_s(2.5));
  }
  lines.flush(at_s(10));
  EXPECT_EQ(content_of(file), "first line\nsecond line\nthird line\n");
  EXPECT_EQ(status("trajectory").lost, 0u);
  EXPECT_EQ(warnings.size(), 2u);
}

TEST_F(Saving, LinesThatFindNoRoomToWaitAreCounted) {
  const auto file = folder.path() / "trajectory.tum";
  LiveLines lines{file, {"trajectory", file, telemetry.outputs, warn()}};
  {
    const test::FullDisk full;
    for (int i = 0; i < 3000; ++i) {
      lines.write(std::string(999, 'x') + "\n", at_s(i));
      lines.flush(at_s(i));
    }
  }
  lines.close(at_s(4000));
  const auto written = fs::file_size(file) / 1000;
  EXPECT_GE(written, 1000u);
  EXPECT_LE(written, 1100u);
  EXPECT_EQ(status("trajectory").lost, 3000u - written);
}

TEST_F(Saving, AFileThatCannotBeBegunIsBegunLater) {
  const auto file = folder.path() / "later" / "trajectory.tum";
  LiveLines lines{file, {"trajectory", file, telemetry.outputs, warn()}};
  lines.write("a line\n", at_s(0));
  lines.flush(at_s(0));
  EXPECT_FALSE(status("trajectory").written);
  fs::create_directory(folder.path() / "later");
  lines.flush(at_s(2));
  EXPECT_EQ(content_of(file), "a line\n");
}

drivers::port::ByteRecord record_at(double time_s, std::uint8_t byte) {
  drivers::port::ByteRecord record;
  record.port = drivers::port::PortId::kLaser;
  record.stamp = at_s(time_s);
  record.bytes.assign(100, byte);
  return record;
}

class Recording : public Saving {
 protected:
  [[nodiscard]] LiveRecording::Options options() const {
    return {.file = file, .bauds = {9600, 9600}, .first_notes = {"run"}, .began = at_s(0), .max_gigabytes = 1.0};
  }
  /// The notes, and "laser 7" for the laser's bytes 7.
  [[nodiscard]] std::vector<std::string> told() const {
    drivers::port::ByteLogReader reader{file};
    std::vector<std::string> all;
    while (const auto record = reader.next()) {
      all.push_back(record->note.empty()
                        ? "laser " + std::to_string(record->bytes[0]) + " at " + std::to_string(record->baud)
                        : record->note);
    }
    EXPECT_FALSE(reader.cut()) << reader.cut()->text;
    return all;
  }
  fs::path file = folder.path() / "bytes.pcapng";
};

TEST_F(Recording, GoesOnBehindTheLastWholeBlockWithANoteOfTheGap) {
  {
    LiveRecording recording{options(), telemetry, warn()};
    recording.write(record_at(1, 1), at_s(1));
    recording.flush(at_s(1));
    {
      const test::FullDisk full{fs::file_size(file) + 50};  // in the middle of a block
      recording.write(record_at(2, 2), at_s(2));
      recording.flush(at_s(2));
      EXPECT_FALSE(telemetry.records.value());
      EXPECT_FALSE(status("recording").written);
      drivers::port::ByteRecord faster = record_at(2.5, 3);
      faster.bytes.clear();
      faster.note = drivers::port::baud_note(38400);
      recording.write(faster, at_s(2.5));
    }
    recording.write(record_at(10, 4), at_s(10));
    recording.write(record_at(11, 5), at_s(11));
    recording.close(at_s(12));
  }
  EXPECT_EQ(told(), (std::vector<std::string>{"run", "laser 1 at 9600", "records lost here", "baud 9600", "baud 38400",
                                              "laser 4 at 38400", "laser 5 at 38400"}));
  EXPECT_EQ(warnings.size(), 2u);
  EXPECT_EQ(status("recording").lost, 1u);
}

TEST_F(Recording, BeginsLaterWhereTheDiskIsFullAtTheStart) {
  {
    std::optional<LiveRecording> recording;
    {
      const test::FullDisk full;
      recording.emplace(options(), telemetry, warn());
      EXPECT_FALSE(status("recording").written);
    }
    recording->write(record_at(5, 7), at_s(5));
    recording->close(at_s(6));
  }
  EXPECT_EQ(told(),
            (std::vector<std::string>{"run", "records lost here", "baud 9600", "baud 9600", "laser 7 at 9600"}));
}

TEST_F(Recording, AlwaysSaysWhatTheRunBeganFrom) {
  for (const rlim_t room : {400u, 480u, 560u, 640u}) {  // behind the header, and in the middle of the notes
    LiveRecording::Options large = options();
    large.first_notes = {"run", "map " + std::string(300, 'x')};
    {
      std::optional<LiveRecording> recording;
      {
        const test::FullDisk full{room};
        recording.emplace(large, telemetry, warn());
        recording->flush(at_s(0.5));
      }
      recording->write(record_at(5, 7), at_s(5));
      recording->close(at_s(6));
    }
    const std::vector<std::string> all = told();
    ASSERT_GE(all.size(), 3u) << room;
    EXPECT_EQ(std::vector<std::string>(all.begin(), all.begin() + 2), large.first_notes) << room;
    EXPECT_EQ(std::count(all.begin(), all.end(), "run"), 1) << room;
    EXPECT_EQ(all.back(), "laser 7 at 9600");
  }
}

TEST_F(Recording, OfAnotherDaemonIsNotTouched) {
  LiveRecording first{options(), telemetry, warn()};
  first.write(record_at(1, 1), at_s(1));
  first.flush(at_s(1));
  try {
    const LiveRecording second{options(), telemetry, warn()};
    FAIL() << "the first records there";
  } catch (const FileInUse& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(getpid())), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(folder.path() / "bytes.previous.pcapng"));
  EXPECT_EQ(told().size(), 2u);
}

TEST_F(Recording, BehindALinkIsKeptAndLockedWhereItIs) {
  (void)folder.write("bytes.pcapng", "older");
  LiveRecording::Options linked = options();
  fs::create_directory(folder.path() / "links");
  linked.file = folder.path() / "links" / "link.pcapng";
  fs::create_symlink(file, linked.file);
  LiveRecording recording{linked, telemetry, warn()};
  EXPECT_TRUE(fs::is_symlink(linked.file));
  EXPECT_EQ(content_of(folder.path() / "bytes.previous.pcapng"), "older");
  EXPECT_THROW(LiveRecording(options(), telemetry, warn()), FileInUse);
}

TEST_F(Recording, InAFolderThatIsNotThereIsAPersonsMistake) {
  LiveRecording::Options nowhere = options();
  nowhere.file = folder.path() / "missing" / "bytes.pcapng";
  EXPECT_THROW(LiveRecording(nowhere, telemetry, warn()), StartError);
}

TEST_F(Recording, WhereThisUserMayNotWriteIsAPersonsMistake) {
  fs::permissions(folder.path(), fs::perms{0555});
  {
    const test::NotRoot another_user;
    EXPECT_THROW(LiveRecording(options(), telemetry, warn()), StartError);
  }
  fs::permissions(folder.path(), fs::perms::all);
  fs::permissions(folder.write("bytes.pcapng.lock", ""), fs::perms::none);
  const test::NotRoot another_user;
  EXPECT_THROW(LiveRecording(options(), telemetry, warn()), StartError);
}

TEST_F(Recording, OnAReadOnlyFileSystemPausesAndKeepsTheOlderOneLater) {
  if (getuid() != 0) GTEST_SKIP() << "only root can mount: run this test as root";
  const fs::path mounted = folder.path() / "mounted";
  fs::create_directory(mounted);
  if (mount("tmpfs", mounted.c_str(), "tmpfs", 0, "size=8m") != 0) GTEST_SKIP() << "nothing can be mounted here";
  file = mounted / "bytes.pcapng";
  (void)folder.write("mounted/bytes.pcapng", "older");
  EXPECT_EQ(mount(nullptr, mounted.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  try {
    LiveRecording recording{options(), telemetry, warn()};
    EXPECT_FALSE(status("recording").written);
    EXPECT_EQ(warnings.size(), 1u);
    EXPECT_EQ(mount(nullptr, mounted.c_str(), nullptr, MS_REMOUNT, nullptr), 0);
    recording.write(record_at(5, 7), at_s(5));
    recording.close(at_s(6));
    EXPECT_EQ(told().front(), "run");
    EXPECT_EQ(content_of(mounted / "bytes.previous.pcapng"), "older");
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
  }
  EXPECT_EQ(umount(mounted.c_str()), 0);
}

/// A Δ that makes one more cell occupied than the one before.
MapStep::Result result_of(std::uint32_t number) {
  auto map = std::make_shared<OccupancyGrid>(GridGeometry{40, 30, 0.1, {0.0, 0.0}}, CellState::kFree);
  for (std::uint32_t cell = 0; cell < number; ++cell) map->set({static_cast<int>(cell), 3}, CellState::kOccupied);
  MapStep::Result result;
  result.revision =
      MapRevision{.number = number,
                  .time = at_s(number),
                  .map = map,
                  .changes = {{{static_cast<int>(number) - 1, 3}, CellState::kFree, CellState::kOccupied}},
                  .field_patch = {}};
  result.note.revision = number;
  result.note.phase = number;
  return result;
}

MapStep::Result refusal_of(std::uint32_t phase) {
  MapStep::Result result;
  result.note.phase = phase;
  result.note.reason = "too few scans";
  return result;
}

class SavingMaps : public Saving {
 protected:
  [[nodiscard]] MapOutputs::Options options() const {
    StoreToKeep to;
    to.store.emplace(store, *start.map);
    return {.out = out, .store_file = store, .store = std::move(to), .start = start, .method = "evidence"};
  }

  StartMap start{std::make_shared<OccupancyGrid>(GridGeometry{40, 30, 0.1, {0.0, 0.0}}, CellState::kFree), 0};
  fs::path out = folder.path();
  fs::path store = folder.path() / "store.sqlite";
};

TEST_F(SavingMaps, WhatWasMissedIsStoredWholeWhenThereIsRoomAgain) {
  {
    MapOutputs outputs{options(), telemetry.outputs, warn(), at_s(0)};
    for (std::uint32_t number : {1u, 2u}) outputs.save(result_of(number), at_s(number));
    {
      const test::FullDisk full;
      for (std::uint32_t number : {3u, 4u, 5u}) outputs.save(result_of(number), at_s(number));
      outputs.save(refusal_of(6), at_s(6));
      outputs.retry(at_s(7));
      for (const char* name : {"changes", "map", "history", "store"}) EXPECT_FALSE(status(name).written) << name;
    }
    EXPECT_EQ(warnings.size(), 4u) << "one an output";
    outputs.retry(at_s(30));
    for (const char* name : {"changes", "map", "history", "store"}) EXPECT_TRUE(status(name).written) << name;
    EXPECT_EQ(warnings.size(), 8u);
    outputs.save(result_of(6), at_s(31));
    outputs.close(at_s(32));
  }
  EXPECT_EQ(read_grid(out / "map.yaml"), *result_of(6).revision->map);
  const std::string changes = content_of(out / "changes.jsonl");
  EXPECT_EQ(std::count(changes.begin(), changes.end(), '\n'), 7);
  for (const fs::path& file : {store, out / "map_store.sqlite"}) {
    const mapping::MapStore kept{file, *start.map};
    EXPECT_EQ(kept.dropped(), 0u);
    EXPECT_EQ(kept.newest(), 6u);
    for (const std::uint32_t number : {1u, 2u, 5u, 6u}) {
      EXPECT_EQ(kept.grid(number), *result_of(number).revision->map) << number;
    }
    EXPECT_THROW((void)kept.grid(4), std::runtime_error);
    const auto history = kept.history();
    EXPECT_EQ(history[3].note.cause, "evidence (3 to 5 in one)");
    EXPECT_EQ(history[3].occupied, 3u);
    EXPECT_TRUE(history[4].refused);
  }
}

TEST_F(SavingMaps, GoesOnBehindWhatAnotherProgramHasWrittenIntoTheStore) {
  MapOutputs outputs{options(), telemetry.outputs, warn(), at_s(0)};
  outputs.save(result_of(1), at_s(1));
  EXPECT_EQ((mapping::MapStore{store, *start.map}.roll_back(0, at_s(1.5))), 2u);
  outputs.save(result_of(2), at_s(2));
  EXPECT_FALSE(status("store").written);
  outputs.retry(at_s(4));
  EXPECT_TRUE(status("store").written) << status("store").why;
  outputs.save(result_of(3), at_s(5));
  EXPECT_EQ(warnings.size(), 2u);
  const mapping::MapStore kept{store, *start.map};
  EXPECT_EQ(kept.newest(), 4u);
  EXPECT_EQ(kept.grid(2), *start.map);
  for (const std::uint32_t number : {2u, 3u}) EXPECT_EQ(kept.grid(number + 1), *result_of(number).revision->map);
}

TEST_F(SavingMaps, ADiskThatIsFullAtTheStartAndFreeAtTheEnd) {
  std::optional<MapOutputs> outputs;
  MapOutputs::Options late = options();
  late.store.store.reset();
  late.store.open = [this] { return mapping::MapStore{store, *start.map}; };
  late.store.why_not = "store.sqlite: database or disk is full";
  {
    const test::FullDisk full;
    outputs.emplace(std::move(late), telemetry.outputs, warn(), at_s(0));
    outputs->save(result_of(1), at_s(1));
    EXPECT_EQ(warnings.size(), 4u);
  }
  outputs->close(at_s(1.5));
  outputs.reset();
  EXPECT_EQ(read_grid(out / "map.yaml"), *result_of(1).revision->map);
  EXPECT_EQ((mapping::MapStore{store, *start.map}.grid(1)), *result_of(1).revision->map);
  EXPECT_EQ((mapping::MapStore{out / "map_store.sqlite", *start.map}.newest()), 1u);
}

}  // namespace
}  // namespace deltamap::daemon
