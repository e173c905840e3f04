// SPDX-License-Identifier: Apache-2.0
// What is wrong with the text of a settings file is called by its true cause, and hides nothing of the other lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "tests/support/daemon/settings_lines.hpp"

namespace deltamap::daemon {
namespace {

using test::errors_of;
using test::Lines;

struct Case {
  std::string yaml;
  Lines errors;

  /// For the names of the tests: what is no plain character of a word or of a path stands as '_'.
  friend std::ostream& operator<<(std::ostream& out, const Case& one) {
    constexpr std::string_view kPlain{"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.:/=-@"};
    for (const char letter : one.yaml) out << (kPlain.find(letter) == std::string_view::npos ? '_' : letter);
    return out;
  }
};

class SettingsText : public testing::TestWithParam<Case> {};

TEST_P(SettingsText, IsCalledByItsTrueCause) { EXPECT_EQ(errors_of(GetParam().yaml), GetParam().errors); }

const std::string kSlowSeed = "seed: slow\n";  // in every case, so that nothing hides it
const std::string kSeedError = ": seed: needs a whole number (from 0), not 'slow'";

/// The text and its mistake; behind it, or before it, a value of the wrong type that must be told as well.
std::vector<Case> with_others(const std::vector<Case>& cases) {
  std::vector<Case> all;
  for (const Case& one : cases) {
    const long lines = std::count(one.yaml.begin(), one.yaml.end(), '\n');
    Case behind{one.yaml + kSlowSeed, one.errors};
    behind.errors.push_back("f:" + std::to_string(lines + 1) + ":7" + kSeedError);
    all.push_back(behind);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(
    Blanks, SettingsText,
    testing::ValuesIn(with_others({
        {"laser:\n\tport: a\n", {"f:2:1: a tab in the indentation: YAML wants blanks"}},
        {"laser:\n\tmount:\n\t\tx_m: 1\n",
         {"f:2:1: a tab in the indentation: YAML wants blanks", "f:3:1: a tab in the indentation: YAML wants blanks"}},
        {"laser:\n\xC2\xA0 port: a\n", {"f:2:1: a non-breaking space (U+00A0): YAML wants plain blanks"}},
        {"laser:\n  port:\xC2\xA0/dev/x\n", {"f:2:8: a non-breaking space (U+00A0): YAML wants plain blanks"}},
        {"laser:\xC2\xA0\n  port: x\n", {"f:1:7: a non-breaking space (U+00A0): YAML wants plain blanks"}},
        {"laser:\n  baud: 9600\xE2\x80\xAF\n", {"f:2:13: a non-breaking space (U+202F): YAML wants plain blanks"}},
        {"laser:\n\xE3\x80\x80port: x\n", {"f:2:1: a wide space (U+3000): YAML wants plain blanks"}},
        {"laser:\n  \xE2\x80\x8B"
         "baud: 9600\n",
         {"f:2:3: an invisible character (U+200B): YAML wants plain blanks"}},
        {"map:\n  file: a\xE2\x80\xA8"
         "b\n",
         {"f:2:10: a line separator (U+2028): YAML wants plain blanks"}},
    })));

INSTANTIATE_TEST_SUITE_P(
    Quotes, SettingsText,
    testing::ValuesIn(with_others({
        {"map:\n  file: \xE2\x80\x9C/a.yaml\xE2\x80\x9D\n", {"f:2:9: a typographic quote: YAML wants \" or '"}},
        {"map: {file: \xE2\x80\x98"
         "a\xE2\x80\x99, store: b}\n",
         {"f:1:13: a typographic quote: YAML wants \" or '"}},
        {"map:\n  file: \xC2\xAB"
         "a\xC2\xBB\n",
         {"f:2:9: a typographic quote: YAML wants \" or '"}},
        {"map:\n  file: \"a\n  store: b\n", {"f:2:9: the quote \" that is opened here is not closed on its line"}},
        {"map: {file: 'a,\n  store: b}\n", {"f:1:13: the quote ' that is opened here is not closed on its line"}},
        {"map:\n  file: \"C:\\maps\"\n",
         {"f:2:14: not YAML: a backslash in double quotes: write it twice, or use single quotes"}},
    })));

INSTANTIATE_TEST_SUITE_P(
    Structure, SettingsText,
    testing::ValuesIn(with_others({
        {"map.file=m0.pgm\n",
         {"f:1:1: the file must hold keys, not 'map.file=m0.pgm': 'key=value' is for --set, the file has 'key: "
          "value'"}},
        {"map: {}\nmap.file=m0.pgm\n",
         {"f:2:1: the file must hold keys, not 'map.file=m0.pgm': 'key=value' is for --set, the file has 'key: "
          "value'"}},
        {"laser:\n  port=/dev/x\n",
         {"f:2:3: laser: must hold keys, not 'port=/dev/x': 'key=value' is for --set, the file has 'key: value'"}},
        {"laser:\n  port:/dev/x\n",
         {"f:2:3: laser: must hold keys, not 'port:/dev/x': a blank belongs behind the colon"}},
        {"- laser\n- robot\n",
         {"f:1:1: the file must hold keys, not a list", "f:2:1: the file must hold keys, not a list"}},
        {"laser:\n  - port\n", {"f:2:3: laser: must hold keys, not a list"}},
        {"map:\n  file: /a b\n    c.yaml\n", {"f:3:5: goes on with the value of line 2: a value ends on its line"}},
        {"  map: {}\nlaser: {}\n",
         {"f:2:1: not YAML: this belongs to no key: look at the indentation of this line and of those above"}},
        {"map:\n  file: |\n    \"a\n  store: 3\n", {"f:2:9: '|' begins a text of several lines: no key takes one"}},
        {"laser:\n  port: a\n baud: 9600\n",
         {"f:3:2: not YAML: this belongs to no key: look at the indentation of this line and of those above"}},
        {"map:\n  file: @x\n", {"f:2:9: not YAML: a character that begins no value: put the value into quotes"}},
        {"map:\n  file: x: y\n  store: 3\n",
         {"f:2:10: not YAML: a ':' is out of place: look at the indentation, or put the value into quotes"}},
        {"lazer:\n  port: x\n", {"f:1:1: lazer: unknown section (nearest section laser)"}},
        {"mount:\n  x_m: 1\n", {"f:1:1: mount: unknown section (nearest section laser.mount)"}},
        {"port: x\n", {"f:1:1: port: unknown key (nearest key robot.port or laser.port or dashboard.port)"}},
        {"laser:\nport: x\n", {"f:2:1: port: unknown key (nearest key robot.port or laser.port or dashboard.port)"}},
        {"laser: {port: a}\nlaser: {baud: 9600}\n", {"f:2:1: laser: given twice, first in line 1"}},
        {"laser.mount: {x_m: 1}\nlaser: {mount: {y_m: 1}}\n", {"f:2:9: laser.mount: given twice, first in line 1"}},
        {"laser: [1,\n2]\n", {"f:1:8: laser: must hold keys, not a list"}},
        {"? [a]\n: 1\n", {"f:1:3: a key must be a word"}},
    })));

INSTANTIATE_TEST_SUITE_P(
    WhatEndsTheReading, SettingsText,
    testing::Values(Case{"seed: 1\rlaser: {port: x}\r",
                         {"f:1:8: a carriage return without a line feed: save the file with Unix line ends"}},
                    Case{kSlowSeed + "---\nlaser: {prot: x}\n",
                         {"f:1:7" + kSeedError, "f:2:1: a second YAML document begins here: the settings are one"}},
                    Case{std::string("\x7F"
                                     "ELF\x02",
                                     5),
                         {"f:1:1: no text file: it has the byte 7Fh"}},
                    Case{"seed: 1\nmap: {file: caf\xE9}\nlaser: {prot: x}\n",
                         {"f:2:16: the byte E9h is no UTF-8: save the file as UTF-8",
                          "f:3:9: laser.prot: unknown key (nearest key laser.port)"}}));

TEST(SettingsText, WhatStandsInQuotesAndCommentsIsAsItIs) {
  EXPECT_EQ(errors_of("map: {file: \"a\xC2\xA0"
                      "b \xE2\x80\x9Cq\xE2\x80\x9D\"}  # \xC2\xA0 \xE2\x80\x9Cq\xE2\x80\x9D\n"
                      "robot: {port: /dev/caf\xC3\xA9}\n"),
            Lines{});
}

TEST(SettingsText, EveryPartOfABrokenFileIsReadThatCanBe) {
  EXPECT_EQ(errors_of("laser:\n"
                      "  prot: x\n"
                      "  mount:\n"
                      "    x_m: far\n"
                      "    y_m: : 3\n"
                      "    yaw_deg: 400\n"
                      "  baud: 12\n"
                      "robot:\n"
                      "  port: \"open\n"
                      "  sonar: maybe\n"
                      "lazer: {port: a}\n"),
            (Lines{"f:2:3: laser.prot: unknown key (nearest key laser.port)",
                   "f:4:10: laser.mount.x_m: needs a number (m, -5 to 5), not 'far'",
                   "f:5:10: not YAML: a ':' is out of place: look at the indentation, or put the value into quotes",
                   "f:6:14: laser.mount.yaw_deg: needs a number in its range (degrees, -180 to 180), not '400'",
                   "f:7:9: laser.baud: needs one of 9600 | 19200 | 38400 | 500000, not '12'",
                   "f:9:9: the quote \" that is opened here is not closed on its line",
                   "f:10:10: robot.sonar: needs true or false, not 'maybe'",
                   "f:11:1: lazer: unknown section (nearest section laser)"}));
}

TEST(SettingsText, AContradictionIsToldBesideOtherMistakesButNotOfValuesThatMayBeOthers) {
  const std::string contradiction = "navigation: {wander: {shortest_leg_s: 30, longest_leg_s: 10}}\n";
  const std::string rule = ": navigation.wander.shortest_leg_s: must not exceed 'navigation.wander.longest_leg_s'";
  EXPECT_EQ(errors_of(contradiction + kSlowSeed), (Lines{"f:1:39" + rule, "f:2:7" + kSeedError}));
  EXPECT_EQ(errors_of("navigation: {wander: {longest_leg_s: 3}}\n"), Lines{"f:1:38" + rule})
      << "at the one that is given";
  EXPECT_EQ(errors_of("navigation: {wander: {shortest_leg_s: 30, longest_leg: 40}}\n"),
            Lines{"f:1:43: navigation.wander.longest_leg: unknown key (nearest key navigation.wander.longest_leg_s)"});
  EXPECT_EQ(errors_of("navigation:\n  wander:\n    shortest_leg_s: 30\n    longest_leg_s: \"40\n").size(), 1u);
}

TEST(SettingsText, ALastLineWithoutAKeyGetsItsHint) {
  EXPECT_EQ(errors_of("map: {}\nmap.file=m0.pgm\n"),
            Lines{"f:2:1: map.file=m0.pgm: unknown key (nearest key map.file): 'key=value' is for --set, the file has "
                  "'key: value'"});
  EXPECT_EQ(errors_of("map: {}\nseed:3\n"),
            Lines{"f:2:1: seed:3: unknown key (nearest key seed): a blank belongs behind the colon"});
}

TEST(SettingsText, ANestOfBracketsEndsInOneLine) {
  const Lines lines = errors_of("laser: " + std::string(100000, '[') + "\n" + kSlowSeed);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].ends_with("not YAML: brackets are nested too deeply")) << lines[0];
}

TEST(SettingsTextOfKeysThatContradict, AreToldWhereBothCouldBeRead) {
  const Lines both = errors_of("map:\n  file: \"x\nlocalization:\n  particles:\n    min: 900\n    max: 100\n");
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NE(both[1].find("localization.particles.min: "), std::string::npos) << both[1];
  EXPECT_EQ(errors_of("map:\n  file: \"x\nlocalization:\n  particles:\n    max: 100\n").size(), 1U)
      << "what could not be read may say how many there are at least";
}

}  // namespace
}  // namespace deltamap::daemon
