// SPDX-License-Identifier: Apache-2.0
#include "tool/view/run_things.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/files/scratch_folder.hpp"

namespace deltamap::tool {
namespace {

using nlohmann::json;

TEST(RunThings, AreTheNewestLineOfEachUpToAMoment) {
  const ScratchFolder folder;
  const auto file = folder.path() / "things.jsonl";
  std::ofstream{file} << R"({"time":100.0,"thing":2,"kind":"appeared"})" << '\n'
                      << R"({"time":101.0,"thing":1,"kind":"gone"})" << '\n'
                      << "no line of it\n"
                      << R"({"time":102.5,"thing":2,"kind":"moved"})" << '\n'
                      << R"({"time":103.0,"thing":3,"ki)";
  const auto kinds_at = [&](double time_s) {
    std::string kinds;
    const json told = json::parse(things_at(file, timestamp_from_ns(0) + duration_from_seconds(time_s)));
    for (const json& thing : told["things"])
      kinds += thing["thing"].dump() + " " + thing["kind"].get<std::string>() + ";";
    return kinds;
  };
  EXPECT_EQ(kinds_at(99.0), "");
  EXPECT_EQ(kinds_at(101.0), "1 gone;2 appeared;");
  EXPECT_EQ(kinds_at(200.0), "1 gone;2 moved;");
  EXPECT_EQ(json::parse(things_at(file, timestamp_from_ns(0)))["unread"], 1) << "not the one that is being written";
}

TEST(RunThings, AreNoneWithoutAFile) {
  EXPECT_TRUE(json::parse(things_at("/no/such/things.jsonl", timestamp_from_ns(0)))["things"].empty());
}

}  // namespace
}  // namespace deltamap::tool
