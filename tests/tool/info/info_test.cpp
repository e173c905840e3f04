// SPDX-License-Identifier: Apache-2.0
// `deltamap info`, run in-process on recordings that are written here.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/records/journal.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/steps/run_begin.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/status.hpp"
#include "tests/support/bytes/written_recording.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tool/info/rhythm.hpp"

namespace deltamap::tool {
namespace {

namespace lms = drivers::lms200;
namespace pioneer = drivers::pioneer;
using drivers::port::Direction;
using drivers::port::PortId;
using test::run_deltamap;
using test::WrittenRecording;

nlohmann::json info_of(const std::string& file, std::vector<std::string> more = {}) {
  std::vector<std::string> words{"info", file, "--json"};
  words.insert(words.end(), more.begin(), more.end());
  const auto run = run_deltamap(words);
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  return nlohmann::json::parse(run.output).at(0);
}

std::vector<std::uint8_t> scan_telegram() {
  lms::Measurement measurement;
  measurement.words.assign(181, 1000);
  return lms::encoded_measurement(measurement);
}

/// SIPs every 0.1 s and scans every 0.2 s.
void drive(WrittenRecording& recording, double from_s, double to_s) {
  for (double at_s = from_s; at_s < to_s - 1e-9; at_s += 0.1) {
    recording.bytes(at_s, PortId::kRobot, Direction::kIn, pioneer::encoded_sip({}));
    if (std::lround(at_s * 10) % 2 == 0) recording.bytes(at_s, PortId::kLaser, Direction::kIn, scan_telegram());
  }
}

TEST(Info, TellsTheDevicesByWhatTheySayOfThemselves) {
  WrittenRecording recording;
  recording.bytes(0.0, PortId::kRobot, Direction::kIn, pioneer::encoded_identity({"demo", "Pioneer", "p3dx-sh"}));
  lms::DeviceStatus status;
  status.resolution_centideg = 50;
  status.units = 1;
  status.measuring_mode = 0x06;
  recording.bytes(0.1, PortId::kLaser, Direction::kIn, lms::status_reply(status));
  recording.bytes(0.2, PortId::kRobot, Direction::kOut, pioneer::encoded_command({pioneer::CommandNumber::kVel, 1}));
  recording.note(0.3, "baud 9600", PortId::kLaser);
  const auto info = info_of(recording.closed());
  EXPECT_EQ(info["robot"]["identity"]["subtype"], "p3dx-sh");
  EXPECT_EQ(info["laser"]["variants"][0]["value"], "180/0.5");
  EXPECT_EQ(info["laser"]["units"][0]["value"], "mm");
  EXPECT_EQ(info["laser"]["measuring_modes"][0]["value"], "06");
  EXPECT_EQ(info["laser"]["bauds"][1]["value"], "9600");
  EXPECT_EQ(info["robot"]["said"]["frames"], (nlohmann::json{{"SYNC2 reply", 1}}));
  EXPECT_EQ(info["robot"]["heard"]["frames"], (nlohmann::json{{"VEL", 1}}));
  EXPECT_EQ(info["began"], "2023-11-14T22:13:20.000Z");
}

TEST(Info, TellsRatesAndWhatIsMissingOfThem) {
  WrittenRecording recording;
  drive(recording, 0.0, 5.0);
  drive(recording, 5.4, 10.0);  // two scans and four SIPs are not there
  drive(recording, 13.0, 20.0);
  const auto info = info_of(recording.closed());
  EXPECT_NEAR(info["laser"]["period_s"].get<double>(), 0.2, 1e-3);
  EXPECT_EQ(info["laser"]["messages"], 83);
  EXPECT_EQ(info["laser"]["missing"], 2) << "a silence is told apart";
  EXPECT_NEAR(info["robot"]["period_s"].get<double>(), 0.1, 1e-3);
  ASSERT_EQ(info["laser"]["silences"].size(), 1u);
  EXPECT_NEAR(info["laser"]["silences"][0]["after_s"].get<double>(), 9.8, 0.1);
  EXPECT_NEAR(info["both_silent"][0]["length_s"].get<double>(), 3.1, 0.1);
  EXPECT_NEAR(info["length_s"].get<double>(), 19.9, 1e-6);
}

TEST(Info, CountsTheTimeThatHasPassedWhereTheClockWasSetBack) {
  WrittenRecording recording;
  drive(recording, 100.0, 110.0);
  drive(recording, 10.0, 15.0);
  const auto info = info_of(recording.closed());
  ASSERT_EQ(info["set_back"].size(), 1u);
  EXPECT_NEAR(info["set_back"][0]["length_s"].get<double>(), 99.9, 1e-6);
  EXPECT_NEAR(info["length_s"].get<double>(), 14.8, 0.2);
  EXPECT_EQ(info["laser"]["silences"].size(), 0u) << "no scan was missing";
}

TEST(Info, TellsBrokenFramesAndWhereRecordsAreMissing) {
  WrittenRecording recording;
  auto broken = scan_telegram();
  broken[40] ^= 1;
  recording.bytes(0.0, PortId::kLaser, Direction::kIn, broken);
  recording.note(1.0, std::string(daemon::kGapNote));
  recording.note(1.1, "scan 7 dropped");
  const auto info = info_of(recording.closed());
  EXPECT_EQ(info["laser"]["said"]["bad_checksum"], 1);
  EXPECT_EQ(info["laser"]["said"]["garbage_bytes"], broken.size());
  EXPECT_EQ(info["records_missing_s"], (nlohmann::json{1.0}));
  EXPECT_EQ(info["dropped"]["scans overtaken by newer ones"], 1);
}

daemon::Settings recorded_settings(const std::vector<std::string>& overrides) {
  std::vector<std::string> all{"recording.file=drive.pcapng"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return daemon::settings_or_defaults("", all);
}

void begin_run(WrittenRecording& recording, const daemon::Settings& settings) {
  for (const std::string& note : daemon::first_notes(settings, 0x1234, {})) recording.note(0.0, note);
}

TEST(Info, TellsBaysAndZonesThatARunBeganWithApartFromThoseThatWereTakenLater) {
  WrittenRecording recording;
  begin_run(recording, recorded_settings({}));
  drive(recording, 0.0, 3.0);
  const auto site = std::make_shared<const daemon::Site>();
  for (const std::string& note : daemon::notes_of(daemon::SetSite{0, Timestamp{}, site})) recording.note(0.0, note);
  for (const std::string& note : daemon::notes_of(daemon::SetSite{12, WrittenRecording::at(2.4), site}))
    recording.note(2.4, note);
  const auto info = info_of(recording.closed());
  EXPECT_EQ(info["run"]["begins_with"], "bays: 0, zones: 0");
  ASSERT_EQ(info["operator"].size(), 1u);
  EXPECT_EQ(info["operator"][0]["what"], "bays: 0, zones: 0");
  EXPECT_NEAR(info["operator"][0]["after_s"].get<double>(), 2.4, 1e-9);
}

TEST(Info, TellsTheSettingsOfTheRunAndWhetherTheseAreTheyAndTheOrdersOfTheOperator) {
  WrittenRecording recording;
  begin_run(recording, recorded_settings({"localization.beams=60"}));
  drive(recording, 0.0, 3.0);
  recording.note(3.0, "mapping paused before scan 12 at " + std::to_string(unix_ns(WrittenRecording::at(2.4))));
  recording.note(3.0, "relocalized to 1 2 0 before scan 14");
  const std::string file = recording.closed();
  const auto info = info_of(file);
  EXPECT_EQ(info["run"]["changed"]["localization.beams"], "60");
  EXPECT_EQ(info["operator"][0]["what"], "mapping paused");
  EXPECT_NEAR(info["operator"][0]["after_s"].get<double>(), 2.4, 1e-9);
  EXPECT_EQ(info["operator"][1]["what"], "relocalized to 1.000, 2.000, 0.0°");
  EXPECT_EQ(info["bit_for_bit"]["possible"], true);
  EXPECT_EQ(info_of(file, {"--set", "localization.beams=60"})["bit_for_bit"]["possible"], true);
  EXPECT_EQ(info_of(file, {"--set", "localization.beams=90"})["bit_for_bit"]["why"], "not obeyed: other settings");
}

TEST(Info, SaysWhyNoReplayCanRepeatTheRun) {
  WrittenRecording imported;
  drive(imported, 0.0, 1.0);
  EXPECT_EQ(info_of(imported.closed())["bit_for_bit"]["why"],
            "no run of the daemon stands in it: a replay decides by itself");
  WrittenRecording with_gap;
  begin_run(with_gap, recorded_settings({}));
  with_gap.note(1.0, std::string(daemon::kGapNote));
  EXPECT_EQ(info_of(with_gap.closed())["bit_for_bit"]["why"], "not obeyed: records are missing");
}

TEST(Info, PrintsTextForPeople) {
  WrittenRecording recording;
  drive(recording, 0.0, 2.0);
  const std::string file = recording.closed();
  const std::string text = run_deltamap({"info", file}).output;
  EXPECT_TRUE(text.starts_with(file + ": 1.9 s from 2023-11-14T22:13:20.000Z, ")) << text;
  EXPECT_NE(text.find("\n            SIPs 20, one every 100.0 ms (10.00 a second)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n  replay    not bit for bit: no run"), std::string::npos) << text;
}

TEST(Info, TellsTheOthersWhereOneRecordingCannotBeRead) {
  WrittenRecording recording;
  drive(recording, 0.0, 1.0);
  const std::string file = recording.closed();
  const auto run = run_deltamap({"info", "/nowhere.pcapng", file});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.output.find(file), std::string::npos);
  EXPECT_NE(run.errors.find("/nowhere.pcapng"), std::string::npos) << run.errors;
}

TEST(Info, RefusesSettingsThatCannotBeBeforeItReadsAnything) {
  WrittenRecording recording;
  begin_run(recording, recorded_settings({}));
  drive(recording, 0.0, 1.0);
  const std::string file = recording.closed();
  const auto run = run_deltamap({"info", file, file, "--set", "localization.beems=1"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.output, "");
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << "once: " << run.errors;
}

TEST(Rhythm, CountsWhatALongIntervalLacks) {
  Rhythm rhythm;
  for (const double at_s : {0.0, 0.1, 0.2, 0.3, 0.6, 0.7}) rhythm.add(at_s);
  EXPECT_NEAR(rhythm.period_s(), 0.1, 1e-9);
  EXPECT_EQ(rhythm.missing(), 2u);
  EXPECT_TRUE(rhythm.silences().empty()) << "less than a second";
  EXPECT_EQ(Rhythm{}.missing(), 0u);
}

}  // namespace
}  // namespace deltamap::tool
