// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/recorder.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

TEST(Recorder, KeepsTheRecordingOfTheRunBefore) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("bytes.pcapng", "what was recorded before the crash");
  Telemetry telemetry;
  {
    const Recorder recorder{{.recording = file,
                             .bauds = {9600, 38400},
                             .began = timestamp_from_ns(1'700'000'000'000'000'000),
                             .first_notes = {"run"},
                             .max_gigabytes = 1.0,
                             .trajectory = {}},
                            telemetry,
                            {.log = [](const std::string&) {}}};
  }
  std::ostringstream kept;
  kept << std::ifstream(folder.path() / "bytes.previous.pcapng", std::ios::binary).rdbuf();
  EXPECT_EQ(kept.str(), "what was recorded before the crash");
  EXPECT_GT(std::filesystem::file_size(file), 0u);
}

TEST(Recorder, NamesTheRecordingThatItCannotBegin) {
  const test::TemporaryFolder folder;
  Telemetry telemetry;
  const Recorder::Options options{.recording = folder.path() / "missing" / "bytes.pcapng",
                                  .bauds = {},
                                  .began = timestamp_from_ns(1'700'000'000'000'000'000),
                                  .first_notes = {"run"},
                                  .max_gigabytes = 1.0,
                                  .trajectory = {}};
  try {
    const Recorder recorder{options, telemetry, {.log = [](const std::string&) {}}};
    FAIL() << "there is no folder for it";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string{error.what()}.find("bytes.pcapng"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace deltamap::daemon
