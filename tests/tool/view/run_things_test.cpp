// SPDX-License-Identifier: Apache-2.0
#include "tool/view/run_things.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/files/scratch_folder.hpp"

namespace deltamap::tool {
namespace {

using nlohmann::json;

std::string kinds_at(RunThings& things, double time_s) {
  std::string kinds;
  const json told = json::parse(things.at(timestamp_from_ns(0) + duration_from_seconds(time_s)));
  for (const json& thing : told["things"])
    kinds += thing["thing"].dump() + " " + thing["kind"].get<std::string>() + ";";
  return kinds;
}

TEST(RunThings, AreTheNewestLineOfEachUpToAMoment) {
  const ScratchFolder folder;
  const auto file = folder.path() / "things.jsonl";
  std::ofstream{file} << R"({"time":100.0,"thing":2,"kind":"appeared"})" << '\n'
                      << R"({"time":101.0,"thing":1,"kind":"gone"})" << '\n'
                      << "no line of it\n"
                      << R"({"time":102.5,"thing":2,"kind":"moved"})" << '\n'
                      << R"({"time":103.0,"thing":3,"ki)";
  RunThings things{file};
  EXPECT_EQ(kinds_at(things, 99.0), "");
  EXPECT_EQ(kinds_at(things, 101.0), "1 gone;2 appeared;");
  EXPECT_EQ(kinds_at(things, 200.0), "1 gone;2 moved;");
  EXPECT_EQ(json::parse(things.at({}))["unread"], 1) << "not the one that is being written";
  std::ofstream{file, std::ios::app} << R"(nd":"gone"})" << '\n';
  EXPECT_EQ(kinds_at(things, 200.0), "1 gone;2 moved;3 gone;") << "by now it is written";
}

TEST(RunThings, OfAFileThatWasBegunAnewAreReadAnew) {
  const ScratchFolder folder;
  const auto file = folder.path() / "things.jsonl";
  std::ofstream{file} << R"({"time":100.0,"thing":1,"kind":"appeared"})" << '\n';
  RunThings things{file};
  EXPECT_EQ(kinds_at(things, 200.0), "1 appeared;");
  std::ofstream{file} << R"({"time":90.0,"thing":11,"kind":"gone","words":"longer than the line before"})" << '\n'
                      << R"({"time":91.0,"thing":12,"kind":"gone"})" << '\n';
  EXPECT_EQ(kinds_at(things, 200.0), "11 gone;12 gone;");
  EXPECT_EQ(json::parse(things.at({}))["unread"], 0);
}

TEST(RunThings, AreNoneWithoutAFile) {
  RunThings things{"/no/such/things.jsonl"};
  EXPECT_TRUE(json::parse(things.at({}))["things"].empty());
}

TEST(RunThings, ReadOfALongFileOnlyWhatIsNewAndWhatIsShown) {
  const ScratchFolder folder;
  const auto file = folder.path() / "things.jsonl";
  constexpr int kLines = 2000;
  {
    std::ofstream out{file};
    for (int i = 0; i < kLines; ++i)
      out << R"({"time":)" << 100 + i << R"(,"thing":)" << i % 3 << R"(,"kind":"of )" << i << "\"}\n";
  }
  RunThings things{file};
  EXPECT_EQ(kinds_at(things, 99.0 + kLines), "0 of 1998;1 of 1999;2 of 1997;");
  // In place, as long as before: lines that have been read, and are not shown, are read no more, but the first.
  const auto second = static_cast<std::streamoff>(std::string(R"({"time":100,"thing":0,"kind":"of 0"})").size() + 1);
  (std::fstream{file, std::ios::in | std::ios::out}.seekp(second)) << "no line";
  EXPECT_EQ(kinds_at(things, 99.0 + kLines), "0 of 1998;1 of 1999;2 of 1997;");
  EXPECT_EQ(json::parse(things.at({}))["unread"], 0);
  std::ofstream{file} << R"({"time":50,"thing":7,"kind":"another run's"})" << '\n';
  EXPECT_EQ(kinds_at(things, 200.0), "7 another run's;") << "a shorter file is another one";
}

}  // namespace
}  // namespace deltamap::tool
