// SPDX-License-Identifier: Apache-2.0
// What is told about a settings file that is no good: every mistake, each with its place and its true cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "tests/support/daemon/settings_lines.hpp"
#include "tests/support/files/not_root.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

using test::errors_of;
using test::Lines;

TEST(SettingsErrors, AllMistakesOfAFileAndOfTheCommandLineAreToldAtOnce) {
  EXPECT_EQ(
      errors_of("seed: x\n"
                "laser:\n"
                "  prot: /dev/y\n"
                "  baud: 12\n"
                "  mount: 4\n"
                "robbot: {port: a}\n",
                {"seed=-1", "map.fiel=a"}),
      (Lines{"f:1:7: seed: needs a whole number (from 0), not 'x'",
             "f:3:3: laser.prot: unknown key (nearest key laser.port)",
             "f:4:9: laser.baud: needs one of 9600 | 19200 | 38400 | 500000, not '12'",
             "f:5:10: laser.mount: must hold keys, not '4'", "f:6:1: robbot: unknown section (nearest section robot)",
             "--set seed=-1: seed: needs a whole number in its range (from 0), not '-1'",
             "--set map.fiel=a: map.fiel: unknown key (nearest key map.file)"}));
}

TEST(SettingsErrors, AllContradictionsAreToldAtTheKeyThatEachNamesFirst) {
  EXPECT_EQ(errors_of("localization:\n  particles: {max: 800, min: 900}\n", {"navigation.wander.shortest_leg_s=3000"}),
            (Lines{"f:2:30: localization.particles.min: must not exceed 'localization.particles.max'",
                   "--set navigation.wander.shortest_leg_s=3000: navigation.wander.shortest_leg_s: must not exceed "
                   "'navigation.wander.longest_leg_s'"}));
}

TEST(SettingsErrors, AMisspeltSectionIsNamedAsOne) {
  EXPECT_EQ(errors_of("lazer:\n  port: a\n"), Lines{"f:1:1: lazer: unknown section (nearest section laser)"});
  EXPECT_EQ(errors_of("localisation: {particles: {min: 3}}"),
            Lines{"f:1:1: localisation: unknown section (nearest section localization)"});
  EXPECT_EQ(errors_of("laser: {mont: {x_m: 1}}"),
            Lines{"f:1:9: laser.mont: unknown section (nearest section laser.mount)"});
  EXPECT_EQ(errors_of("", {"lazer=3"}), Lines{"--set lazer=3: lazer: unknown key (nearest section laser)"});
}

TEST(SettingsErrors, AKeyThatIsFixedNowIsToldAsSuch) {
  const std::string fixed = ": no longer a setting: its value is fixed, remove the line";
  EXPECT_EQ(errors_of("localization:\n  fit: {lost_below: 0.3}\n  motion: {slip_m: 0.1, turn_per_turn: 0.2}\n",
                      {"mapping.gate.hold_s=2"}),
            (Lines{"f:2:9: localization.fit.lost_below" + fixed, "f:3:12: localization.motion.slip_m" + fixed,
                   "--set mapping.gate.hold_s=2: mapping.gate.hold_s" + fixed}));
}

TEST(SettingsErrors, ARenamedKeyIsToldItsNewName) {
  EXPECT_EQ(errors_of("localization: {rivals: {elsewhere_prior: 0.1}}\n"),
            Lines{"f:1:25: localization.rivals.elsewhere_prior: is now called 'localization.kidnapping_prior'"});
  EXPECT_EQ(
      errors_of("localization: {refinement: {range_deviation_m: 0.02}}\n", {"mapping.evidence.range_deviation_m=0.02"}),
      (Lines{"f:1:29: localization.refinement.range_deviation_m: is now called 'laser.range_deviation_m'",
             "--set mapping.evidence.range_deviation_m=0.02: mapping.evidence.range_deviation_m: is now called "
             "'laser.range_deviation_m'"}));
}

TEST(SettingsErrors, WhatIsLikeNothingGetsNoHint) {
  EXPECT_EQ(errors_of("<<: {seed: 1}"),
            Lines{"f:1:1: <<: unknown section (none is near: --print-config lists them all)"});
}

TEST(SettingsErrors, AQuoteThatIsNotClosedOnItsLineIsRefused) {
  EXPECT_EQ(errors_of("laser:\n  port: \"/dev/ttyS0\n  baud: 9600\n"),
            Lines{"f:2:9: the quote \" that is opened here is not closed on its line"});
  EXPECT_EQ(errors_of("map: {file: 'it''s, store: x}\n"),
            Lines{"f:1:13: the quote ' that is opened here is not closed on its line"});
  EXPECT_EQ(errors_of("", {"map.file=\"a"}),
            Lines{"--set map.file=\"a: the quote \" that is opened here is not closed on its line"});
}

TEST(SettingsErrors, AFlowOfQuotedKeysNeedsNoBlankBehindAColon) {
  EXPECT_EQ(errors_of(R"({"map":{"file":"a, 'b.yaml","store":"x: 'c"}})"), Lines{});
}

TEST(SettingsErrors, AFileOfMistakesIsNotToldToItsEnd) {
  std::string yaml;
  for (int i = 0; i < 3000; ++i) yaml += "key" + std::to_string(i) + ": 1\n";
  const Lines lines = errors_of(yaml);
  ASSERT_EQ(lines.size(), 51u);
  EXPECT_EQ(lines.back(), "f:51:1: more mistakes follow");
}

TEST(SettingsErrors, WhateverANameOrAValueHoldsAMistakeIsOneShortLine) {
  for (const std::string& yaml :
       {std::string("\"a\\nb\": 1\n"), std::string("seed: \"a\\nb\\e[31m\"\n"),
        std::string(500000, 'k').append(": 1\n"), std::string("seed: ").append(500000, 'v').append("\n")}) {
    const Lines lines = errors_of(yaml);
    ASSERT_EQ(lines.size(), 1u) << yaml.substr(0, 40);
    EXPECT_LT(lines[0].size(), 250u);
    EXPECT_TRUE(std::none_of(lines[0].begin(), lines[0].end(), [](char c) { return c >= 0 && c < 0x20; })) << lines[0];
  }
}

TEST(SettingsErrors, QuotesThatAreClosedAndThoseWithinWordsAreNotRefused) {
  EXPECT_EQ(errors_of("map:\n  file: \"a \\\" b\"   # don't\n  store: 'it''s'\nlaser: {port: \"a\", units: 'mm'}\n"
                      "recording:\n  file: o'clock\n"),
            Lines{});
}

TEST(SettingsErrors, ASecondDocumentIsRefused) {
  EXPECT_EQ(errors_of("seed: 1\n---\nseed: 2\n---\n"),
            Lines{"f:2:1: a second YAML document begins here: the settings are one"});
  EXPECT_EQ(errors_of("seed: 1\n...\nrubbish\n"),
            Lines{"f:3:1: a second YAML document begins here: the settings are one"});
  EXPECT_EQ(errors_of("# first\n%YAML 1.2\n---\nseed: 1\n...\n# the end\n"), Lines{});
}

TEST(SettingsErrors, TabsAreNamedWhereTheyIndent) {
  EXPECT_EQ(errors_of("laser:\n\tport: a\n \tbaud: 9600\n"),
            (Lines{"f:2:1: a tab in the indentation: YAML wants blanks",
                   "f:3:2: a tab in the indentation: YAML wants blanks"}));
  EXPECT_EQ(errors_of("seed:\t5\t# a tab elsewhere\n\t\n\t# or in an empty line\n"), Lines{});
}

TEST(SettingsErrors, ABinaryFileIsCalledOne) {
  EXPECT_EQ(errors_of(std::string("seed: 5\n\x7F"
                                  "ELF\x02",
                                  13)),
            Lines{"f:2:1: no text file: it has the byte 7Fh"});
  EXPECT_EQ(errors_of(std::string("seed: 5\0", 8)), Lines{"f:1:8: no text file: it has the byte 00h"});
  EXPECT_EQ(errors_of(std::string("\xFF\xFEs\0", 4)), Lines{"f:1:1: UTF-16: save it as UTF-8"});
  EXPECT_EQ(errors_of("\xEF\xBB\xBFseed: 5\r\n"), Lines{}) << "UTF-8 with its mark and the line ends of other systems";
}

TEST(SettingsErrors, WhatIsNoYamlIsToldInTheWordsOfTheFile) {
  EXPECT_EQ(errors_of("map:\n  file: \"C:\\maps\"\n"),
            Lines{"f:2:14: not YAML: a backslash in double quotes: write it twice, or use single quotes"});
  EXPECT_EQ(errors_of("laser: {port: a\nseed: 1\n").size(), 1u);
  EXPECT_NE(errors_of("laser: {port: a\nseed: 1\n").front().find("a '{' is not closed"), std::string::npos);
  EXPECT_EQ(errors_of("localization:\n  initial_pose: [1, 2\n\n# the end\n"),
            Lines{"f:2:22: not YAML: a '[' is not closed"});
  EXPECT_EQ(errors_of("laser:\n  port: a\n baud: 9600\n"),
            Lines{"f:3:2: not YAML: this belongs to no key: look at the indentation of this line and of those above"});
  EXPECT_EQ(errors_of("map:\n  file: |\n    a\n"),
            Lines{"f:2:9: '|' begins a text of several lines: no key takes one"});
}

TEST(SettingsErrors, AMissingBlankBehindAColonIsNamed) {
  EXPECT_EQ(errors_of("seed:5\n"),
            Lines{"f:1:1: the file must hold keys, not 'seed:5': a blank belongs behind the colon"});
  EXPECT_EQ(errors_of("laser:\n  port:/dev/x\n"),
            Lines{"f:2:3: laser: must hold keys, not 'port:/dev/x': a blank belongs behind the colon"});
}

TEST(SettingsErrors, AValueThatIsMissingIsNamedAtItsKey) {
  EXPECT_EQ(errors_of("laser:\n  baud:\n"),
            Lines{"f:2:3: laser.baud: needs one of 9600 | 19200 | 38400 | 500000, not nothing"});
}

TEST(SettingsErrors, WhatHasAnUnknownKeyChangesNothingElse) {
  EXPECT_EQ(errors_of("seed: 1\nseed: 2\nlaser: {port: [a, [b]]}\n"),
            (Lines{"f:2:1: seed: given twice, first in line 1", "f:3:15: laser.port: takes no nested lists"}));
}

TEST(SettingsErrors, AFileThatMayNotBeReadIsNamedWithTheReason) {
  const test::TemporaryFolder folder;
  const auto inside = folder.path() / "inside";
  std::filesystem::create_directory(inside);
  (void)folder.write("inside/robot.yaml", "seed: 1\n");
  std::filesystem::permissions(inside, std::filesystem::perms::none);
  const test::NotRoot not_root;
  try {
    (void)read_settings(inside / "robot.yaml", {});
    ADD_FAILURE() << "it was read";
  } catch (const SettingsError& error) {
    EXPECT_EQ(error.lines(), Lines{(inside / "robot.yaml").string() + ": cannot read the settings: Permission denied"});
  }
}

}  // namespace
}  // namespace deltamap::daemon
