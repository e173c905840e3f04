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
    return {read_settings(file_, overrides_), [this] { return read_settings(file_, overrides_); }};
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
