// SPDX-License-Identifier: Apache-2.0
#include "core/files/yaml_tree.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

namespace deltamap {
namespace {

const std::string kOfNoKey =
    "not YAML: this belongs to no key: look at the indentation of this line and of those above";

std::string told(const std::string& text) {
  try {
    (void)only_yaml_tree(text);
    return "";
  } catch (const YAML::Exception& error) {
    return placed_meaning_of(error, text);
  }
}

TEST(YamlTree, ATextIsReadWhole) {
  EXPECT_EQ(only_yaml_tree("a: 1\nb: 2\n")["b"].as<int>(), 2);
  EXPECT_EQ(only_yaml_tree("---\na: 1\n...\n")["a"].as<int>(), 1);
  EXPECT_EQ(only_yaml_tree("a: 1\n---\n")["a"].as<int>(), 1) << "nothing stands behind it";
  EXPECT_EQ(only_yaml_tree("a: 1\n---\n# end\n...\n")["a"].as<int>(), 1);
  EXPECT_TRUE(only_yaml_tree("").IsNull());
  EXPECT_TRUE(only_yaml_tree("# nothing yet\n").IsNull());
}

TEST(YamlTree, WhatStandsBehindTheFirstTreeIsTold) {
  EXPECT_EQ(told("a: 1\n---\nb: 2\n"), "line 2: " + kOfNoKey);
  EXPECT_EQ(told("a: 1\n...\nb: 2\n"), "line 3: " + kOfNoKey);
  EXPECT_EQ(told("  a: 1\nb: 2\n"), "line 2: " + kOfNoKey);
}

/// The parser takes all that follows for the quote's text, to the end, or to the next quote.
TEST(YamlTree, AQuoteClosesOnItsLine) {
  const std::string open = ": not YAML: a quote is not closed on its line";
  EXPECT_EQ(told("a: 1\nb: \"c\nd: 2\n"), "line 2" + open);
  EXPECT_EQ(told("a: 1\nb: 'c\nd: 2\n"), "line 2" + open);
  EXPECT_EQ(told("a: [x, 'it''s]\nd: 2\n"), "line 1" + open) << "'' is a quote within the text";
  EXPECT_EQ(told("a: \"x\\\"\nd: 2\n"), "line 1" + open) << "as is one behind a backslash";
  EXPECT_EQ(told("l:\n  - a: \"x\n    b: 1\n  - a: \"y\"\n"), "line 2" + open);
  EXPECT_EQ(told("a: 1\n\"b: 2\nd: 2\n"), "line 2" + open);
  EXPECT_EQ(told("\xEF\xBB\xBF\"caf\xC3\xA9\": '\xC3\xA9'\nb: \"x\nc: 1\n"), "line 2" + open);
  EXPECT_EQ(told("a: &name \"x\nc: 1\n"), "line 1" + open);
  EXPECT_EQ(told("a: &name \"x\"\nb: 'it''s'\nc: \"\\\"\"\nd: |\n  \"x\ne: it's\n"), "");
}

TEST(YamlTree, MistakesAreToldInWordsWithALineThatIsThere) {
  EXPECT_EQ(told("a: [1, 2\n"), "line 1: not YAML: a '[' is not closed");
  EXPECT_EQ(told("a: {b: 2"), "line 1: not YAML: a '{' is not closed");
  EXPECT_EQ(told("a: 1\n b: 2\n").substr(0, 32), "line 2: not YAML: a ':' is out o");
  EXPECT_EQ(told("a: \"\\q\"\n"),
            "line 1: not YAML: a backslash in double quotes: write it twice, or use single quotes");
  EXPECT_EQ(told("a: 1\n? b\n"), "");  // valid, if odd
}

TEST(YamlTree, SignsWithAMeaningOfTheirOwnAreToldWithWhatToDo) {
  const std::string sign = "line 1: not YAML: a '*', '&' or '!' begins a value: put the value into quotes";
  for (const char* text : {"a: *", "a: & b", "a: !<b", "a: !!", "a: !a !b c", "a: &a &b c"})
    EXPECT_EQ(told(text), sign) << text;
  EXPECT_EQ(told("a: *b"), "line 1: not YAML: a '*' begins a value, and names no anchor: put the value into quotes");
  const std::string bracket = "a ']' or '}' closes no bracket that is open: look at the brackets, or use quotes";
  for (const char* text : {"b: 1\na: ]", "b: 1\na: [}"}) EXPECT_EQ(told(text), "line 2: not YAML: " + bracket) << text;
  for (const char* text : {"a: - 1", "a: [- 1]"}) {
    EXPECT_EQ(told(text),
              "line 1: not YAML: a '-' is out of place: begin a line of its own with it, or put the value into quotes");
  }
  EXPECT_EQ(told("a: ? b"),
            "line 1: not YAML: a '?' or a key is out of place: look at the indentation, or put the value into quotes");
  EXPECT_EQ(told("a:\n  b: 1\n\tc: 2"), "line 3: not YAML: a tab in the indentation: YAML wants blanks");
  for (const char* text : {"a: |x\n y", "a: >0\n y"})
    EXPECT_EQ(told(text), "line 1: not YAML: a '|' or '>' begins a text of lines: put the value into quotes") << text;
}

/// Each of what the library says of a text that it cannot read.
TEST(YamlTree, NoWordsOfTheLibraryComeThrough) {
  for (const char* text : {"a: ]",
                           "a: - 1",
                           "a: ? b",
                           "a: b: c",
                           "a:\n  b: 1\n\tc: 2",
                           "a: *b",
                           "a: *",
                           "a: & b",
                           "a: !<b",
                           "a: !!",
                           "a: !a !b c",
                           "a: \"\\q\"",
                           "a: \"\\xZZ\"",
                           "a: \"\\UFFFFFFFF\"",
                           "a: |x\n y",
                           "a: |0\n y",
                           "a: @b",
                           "%YAML\na: 1",
                           "%YAML 9.0\n---\n",
                           "%YAML x\n---\n",
                           "%YAML 1.1\n%YAML 1.1\n---\n",
                           "%TAG a\n---\n"}) {
    try {
      (void)YAML::Load(text);
      ADD_FAILURE() << text;
    } catch (const YAML::Exception& error) {
      EXPECT_EQ(meaning_of(error).find(error.msg), std::string::npos) << text;
    }
  }
}

/// The parser below steps over no sign that begins no value: whoever asks it for the next tree asks forever.
TEST(YamlTree, EachTextOfAFewSignsIsReadToItsEnd) {
  const std::string signs = "a:,-?[}\n ";
  std::string text(4, signs.front());
  std::size_t refused = 0;
  for (std::size_t number = 0; number < signs.size() * signs.size() * signs.size() * signs.size(); ++number) {
    for (std::size_t at = 0, left = number; at < text.size(); ++at, left /= signs.size()) {
      text[at] = signs[left % signs.size()];
    }
    if (!told(text).empty()) ++refused;
  }
  EXPECT_GT(refused, 1000u);
}

TEST(YamlTree, WordsThatNobodyHasExplainedStandAsTheyAre) {
  EXPECT_EQ(meaning_of(YAML::Exception(YAML::Mark::null_mark(), "some new words")), "not YAML: some new words");
}

}  // namespace
}  // namespace deltamap
