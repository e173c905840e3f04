// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/live_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/settings/settings_documents.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

using Lines = std::vector<std::string>;

/// A settings file that a test rewrites, and what the stages were handed.
class LiveSettingsTest : public testing::Test {
 protected:
  LiveSettingsTest() { write("seed: 3\n"); }

  void write(const std::string& yaml) { file_ = folder_.write("f.yaml", yaml); }
  LiveSettings begun() {
    const auto read = [this] { return read_settings_of_a_run(file_, overrides_); };
    return {read(), read};
  }
  std::function<bool(const Settings&)> take_ = [this](const Settings& settings) {
    taken_.push_back(settings);
    return true;
  };

  test::TemporaryFolder folder_;
  std::filesystem::path file_;
  Lines overrides_;
  std::vector<Settings> taken_;
};

TEST_F(LiveSettingsTest, TakesLiveKeysAndNamesThoseThatNeedARestart) {
  LiveSettings live = begun();
  write("seed: 4\nnavigation: {mode: wander, safety: {margin_m: 0.25}, wander: {turn_rate_deg_per_s: 30}}\n");
  const auto outcome = live.reload(take_);
  EXPECT_TRUE(outcome.done);
  EXPECT_EQ(outcome.lines, (Lines{"taken: navigation.safety.margin_m: 0.25 (before 0.08)",
                                  "taken: navigation.wander.turn_rate_deg_per_s: 30 (before 46)",
                                  "needs a restart: seed: 4 (in force 3)",
                                  "needs a restart: navigation.mode: wander (in force off)"}));
  ASSERT_EQ(taken_.size(), 1u);
  EXPECT_EQ(taken_[0].navigation.safety.margin_m, 0.25);
  EXPECT_NEAR(taken_[0].navigation.wander.turn_rate_rad_per_s, radians(30.0), 1e-12);
  EXPECT_EQ(taken_[0].navigation.mode, navigation::DriveMode::kOff) << "no reload lets a robot drive";
  EXPECT_EQ(taken_[0].seed, 3u);
  EXPECT_EQ(settings_as_yaml(live.in_force()), settings_as_yaml(taken_[0]));
}

TEST_F(LiveSettingsTest, WhatWaitsForARestartIsNamedAtEveryReload) {
  LiveSettings live = begun();
  write("seed: 4\nnavigation: {safety: {margin_m: 0.25}}\n");
  (void)live.reload(take_);
  EXPECT_EQ(live.reload(take_).lines, Lines{"needs a restart: seed: 4 (in force 3)"});
  write("seed: 3\nnavigation: {safety: {margin_m: 0.25}}\n");
  EXPECT_EQ(live.reload(take_).lines, Lines{"the settings are as they were"});
  EXPECT_EQ(taken_.size(), 1u);
}

TEST_F(LiveSettingsTest, AFileWithMistakesChangesNothingAndAllOfThemAreTold) {
  LiveSettings live = begun();
  write("sed: 4\nnavigation: {safety: {margin_m: 0.25, hidden_width_m: far}}\n");
  const auto outcome = live.reload(take_);
  EXPECT_FALSE(outcome.done);
  ASSERT_EQ(outcome.lines.size(), 3u);
  EXPECT_EQ(outcome.lines[0], "the settings stay as they are: the file cannot be taken");
  EXPECT_NE(outcome.lines[1].find("f.yaml:1:1: sed: unknown key"), std::string::npos);
  EXPECT_NE(outcome.lines[2].find("f.yaml:2:55: navigation.safety.hidden_width_m: needs"), std::string::npos);
  EXPECT_TRUE(taken_.empty());
  write("seed: 3\n");
  EXPECT_EQ(live.reload(take_).lines, Lines{"the settings are as they were"});
}

TEST_F(LiveSettingsTest, AFileThatHasGoneChangesNothing) {
  LiveSettings live = begun();
  std::filesystem::remove(file_);
  const auto outcome = live.reload(take_);
  EXPECT_FALSE(outcome.done);
  EXPECT_NE(outcome.lines.back().find("cannot read the settings: No such file"), std::string::npos);
}

TEST_F(LiveSettingsTest, WhereTheStagesCannotTakeThemNothingHasChanged) {
  LiveSettings live = begun();
  write("seed: 3\nnavigation: {safety: {margin_m: 0.25}}\n");
  const auto refused = live.reload([](const Settings&) { return false; });
  EXPECT_FALSE(refused.done);
  EXPECT_EQ(refused.lines, Lines{"the settings stay as they are: the daemon is busy, try again"});
  EXPECT_EQ(live.reload(take_).lines, Lines{"taken: navigation.safety.margin_m: 0.25 (before 0.08)"});
}

TEST_F(LiveSettingsTest, WhatWasSetOnTheCommandLineStaysSet) {
  overrides_ = {"navigation.safety.margin_m=0.3"};
  LiveSettings live = begun();
  write("seed: 3\nnavigation: {safety: {margin_m: 0.25}}\n");
  EXPECT_EQ(live.reload(take_).lines, Lines{"the settings are as they were"});
}

// --- a file that an editor or a full disk has emptied or cut ---

const std::string kWhole =
    "map: {file: hall.yaml}\n"
    "navigation:\n"
    "  mode: wander\n"
    "  safety:\n"
    "    max_speed_m_per_s: 0.12\n"
    "    margin_m: 0.3\n"
    "  wander:\n"
    "    speed_m_per_s: 0.1\n"
    "control:\n"
    "  socket: ctl.sock\n"
    "recording:\n"
    "  max_gigabytes: 40  # of 80\n"
    "# the end\n";

TEST_F(LiveSettingsTest, AFileThatIsCutAnywhereChangesNothing) {
  write(kWhole);
  LiveSettings live = begun();
  const std::size_t end_of_keys = kWhole.find("# the end");
  for (std::size_t size = 0; size < end_of_keys; ++size) {
    write(kWhole.substr(0, size));
    const auto outcome = live.reload(take_);
    EXPECT_FALSE(outcome.done) << "cut behind: " << kWhole.substr(0, size);
    EXPECT_TRUE(outcome.lines.front().starts_with("the settings stay as they are: ")) << outcome.lines.front();
    EXPECT_GE(outcome.lines.size(), 2u) << "what is wrong, and what to do";
  }
  EXPECT_TRUE(taken_.empty());
  for (const std::string& whole : {kWhole, kWhole.substr(0, end_of_keys)}) {
    write(whole);
    EXPECT_EQ(live.reload(take_).lines, Lines{"the settings are as they were"});
  }
}

TEST_F(LiveSettingsTest, AnEmptiedFileNamesWhatIsGone) {
  write(kWhole);
  LiveSettings live = begun();
  write("");
  const std::string file = file_.string();
  EXPECT_EQ(
      live.reload(take_).lines,
      (Lines{"the settings stay as they are: the file does not say any more what it said",
             file + ": 'recording.max_gigabytes', with which it ended before, is gone: is it cut? Put the key back, "
                    "or restart",
             file + ": 'navigation.safety.margin_m' is gone: 0.3 is in force, 0.08 is as delivered; write the one "
                    "that is meant",
             file + ": 'navigation.safety.max_speed_m_per_s' is gone: 0.12 is in force, 0.7 is as delivered; write "
                    "the one that is meant",
             file + ": 'navigation.wander.speed_m_per_s' is gone: 0.1 is in force, 0.5 is as delivered; write the "
                    "one that is meant"}));
}

TEST_F(LiveSettingsTest, AKeyThatIsTakenOutOnPurposeIsNoLossWhereItWaitsForARestart) {
  write(kWhole);
  LiveSettings live = begun();
  std::string edited = kWhole;
  edited.erase(edited.find("control:"), std::string("control:\n  socket: ctl.sock\n").size());
  write(edited);
  const auto outcome = live.reload(take_);
  EXPECT_TRUE(outcome.done);
  EXPECT_EQ(outcome.lines, Lines{"needs a restart: control.socket: \"\" (in force ctl.sock)"});
}

TEST_F(LiveSettingsTest, ALimitIsNotRaisedByTheLineThatHasVanished) {
  write(kWhole);
  LiveSettings live = begun();
  std::string edited = kWhole;
  edited.erase(edited.find("    max_speed"), std::string("    max_speed_m_per_s: 0.12\n").size());
  write(edited);
  const auto outcome = live.reload(take_);
  EXPECT_FALSE(outcome.done);
  EXPECT_EQ(outcome.lines.back(), file_.string() +
                                      ": 'navigation.safety.max_speed_m_per_s' is gone: 0.12 is in force, 0.7 is as "
                                      "delivered; write the one that is meant");
  edited.insert(edited.find("    margin_m"), "    max_speed_m_per_s: 0.4\n");
  write(edited);
  EXPECT_EQ(live.reload(take_).lines, Lines{"taken: navigation.safety.max_speed_m_per_s: 0.4 (before 0.12)"});
}

TEST_F(LiveSettingsTest, WhatTheFileEndedWithIsTheLastFileThatWasTaken) {
  LiveSettings live = begun();
  write("seed: 3\nnavigation: {safety: {margin_m: 0.25}}\n");
  EXPECT_TRUE(live.reload(take_).done);
  write("seed: 3\n");
  EXPECT_FALSE(live.reload(take_).done);
  write("navigation: {safety: {margin_m: 0.2}}\nseed: 3\n");
  EXPECT_TRUE(live.reload(take_).done) << "in another order";
}

TEST_F(LiveSettingsTest, AFileThatIsCutBehindWhatAnEarlierOneEndedWithChangesNothing) {
  LiveSettings live = begun();  // ends with the seed
  const std::string longer =
      "seed: 3\nrecording:\n  max_gigabytes: 40\n";  // no live key: its loss shows by the end alone
  write(longer);
  EXPECT_EQ(live.reload(take_).lines, Lines{"needs a restart: recording.max_gigabytes: 40 (in force 8)"});
  write("seed: 3\n");
  EXPECT_EQ(live.reload(take_).lines,
            (Lines{"the settings stay as they are: the file does not say any more what it said",
                   file_.string() + ": 'recording.max_gigabytes', with which it ended before, is gone: is it cut? Put "
                                    "the key back, or restart"}));
  write(longer);
  EXPECT_TRUE(live.reload(take_).done);
  write("recording:\n  max_gigabytes: 40\n");
  EXPECT_TRUE(live.reload(take_).done) << "the seed is not what the newest file has ended with";
}

TEST(LiveKeys, AreThoseThatDecideNoResultAndNeverWhoDrives) {
  Settings settings;
  const std::vector<SettingKey> keys = keys_of(settings);
  EXPECT_GT(std::count_if(keys.begin(), keys.end(), [](const SettingKey& key) { return key.is_live; }), 10);
  for (const SettingKey& key : keys) {
    if (!key.is_live) continue;
    EXPECT_FALSE(key.affects_result) << key.name << ": a replay would not know of the change";
    EXPECT_TRUE(key.name.starts_with("navigation.safety.") || key.name.starts_with("navigation.wander.")) << key.name;
    EXPECT_EQ(key.assign({SettingValue::Kind::kScalar, {key.text()}}), std::nullopt) << key.name;
  }
}

}  // namespace
}  // namespace deltamap::daemon
