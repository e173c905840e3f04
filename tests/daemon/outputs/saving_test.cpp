// SPDX-License-Identifier: Apache-2.0
// What lines and the recording of the running daemon do while the disk is full, and when it is not any more.
#include <sys/mount.h>
#include <unistd.h>

#include <fstream>

#include "daemon/outputs/line_file.hpp"
#include "daemon/records/live_recording.hpp"
#include "daemon/settings/start_error.hpp"
#include "tests/support/daemon/saving_fixture.hpp"
#include "tests/support/files/full_disk.hpp"
#include "tests/support/files/not_root.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using test::at_s;
using test::content_of;

class Saving : public test::SavingFixture {};

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
      lines.write(std::string(999, 'x').append("\n"), at_s(i));
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

TEST_F(Recording, SaysBehindAGapWhetherMappingIsPaused) {
  {
    LiveRecording recording{options(), telemetry, warn()};
    recording.flush(at_s(1));
    {
      const test::FullDisk full{fs::file_size(file)};
      for (const char* said : {"mapping paused before scan 5 at 1700000002000000000", "scan 6 dropped"}) {
        drivers::port::ByteRecord note;
        note.stamp = at_s(2);
        note.note = said;
        recording.write(note, at_s(2));
        recording.flush(at_s(2));
      }
    }
    recording.write(record_at(10, 4), at_s(10));
    recording.close(at_s(12));
  }
  EXPECT_EQ(told(),
            (std::vector<std::string>{"run", "records lost here", "baud 9600", "baud 9600",
                                      "mapping paused before scan 5 at 1700000002000000000", "laser 4 at 9600"}));
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

}  // namespace
}  // namespace deltamap::daemon
