// SPDX-License-Identifier: Apache-2.0
// A program that listens to the poses of a running daemon, and one that stalls.
#include "daemon/live/pose_stream.hpp"

#include <map>
#include <thread>

#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using nlohmann::json;

class PoseStreamTest : public test::ControlDeskTest {
 protected:
  PoseStreamTest() { settings_.poses.socket = folder_.path() / "poses.sock"; }

  /// Lines of type "pose" by their scan.
  static std::map<int, json> poses_of(test::SocketClient& client, std::size_t wanted) {
    std::map<int, json> poses;
    for (std::string line = client.line(); !line.empty() && poses.size() < wanted; line = client.line()) {
      const json told = json::parse(line);
      if (told["type"] == "pose") poses[told["scan"]] = told;
    }
    return poses;
  }
  /// x, by scan, as localization.csv of the run has it.
  [[nodiscard]] std::map<int, double> logged_x() const {
    std::map<int, double> found;
    std::istringstream text{test::content_of(folder_.path() / "live/localization.csv")};
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) {
      int number = 0;
      double x = 0.0;
      if (std::sscanf(line.c_str(), "%*[^,],%d,%*[^,],%lf", &number, &x) == 2) found[number] = x;
    }
    return found;
  }
};

TEST_F(PoseStreamTest, TellsTheVeryPosesThatTheRunWritesScanByScan) {
  constexpr std::size_t kWanted = 50;
  std::map<int, json> told;
  std::string hello;
  const RunReport report = run_live(std::chrono::microseconds(6000), [&](const Pipeline&) {
    test::SocketClient stalls{settings_.poses.socket};
    test::SocketClient client{settings_.poses.socket};
    hello = client.line();
    told = poses_of(client, kWanted);
  });
  EXPECT_EQ(json::parse(hello)["type"], "hello");
  EXPECT_EQ(json::parse(hello)["protocol"], 1);
  ASSERT_EQ(told.size(), kWanted);
  const auto left_out = static_cast<std::uint64_t>(told.rbegin()->first - told.begin()->first) + 1 - kWanted;
  EXPECT_LE(left_out, report.scans.lost + report.scans.dropped) << "no scan that has a pose is left out";
  const auto logged = logged_x();
  for (const auto& [scan, pose] : told) {
    ASSERT_TRUE(logged.contains(scan)) << scan;
    EXPECT_NEAR(pose["x_m"].get<double>(), logged.at(scan), 1e-8);  // the log has nine digits
    EXPECT_EQ(pose["state"], "tracking");
    EXPECT_TRUE(pose["gate"].contains("open"));
  }
  EXPECT_FALSE(std::filesystem::exists(settings_.poses.socket));
}

TEST_F(PoseStreamTest, WhoAsksForThingsAndBaysIsToldTheLinesOfTheirFilesAndNobodyElseIs) {
  settings_.bays.file =
      folder_.write("bays.yaml", "bays:\n  - {id: B1, polygon: [[4.6, 4.6], [6, 4.6], [6, 5.8], [4.6, 5.8]]}\n")
          .string();
  std::vector<std::string> told;
  std::vector<std::string> types;
  std::thread reader;
  (void)run_live(std::chrono::microseconds(3000), [&](const Pipeline&) {
    auto events = std::make_shared<test::SocketClient>(settings_.poses.socket);
    auto silent = std::make_shared<test::SocketClient>(settings_.poses.socket);
    EXPECT_EQ(json::parse(events->line())["type"], "hello");
    EXPECT_EQ(json::parse(events->asked(R"({"want":["things","bays"]})")),
              json::parse(R"({"type":"wanted","want":["things","bays"]})"));
    reader = std::thread{[events, silent, &told, &types] {
      for (std::string line = events->line(); !line.empty(); line = events->line()) told.push_back(line);
      for (std::string line = silent->line(); !line.empty(); line = silent->line()) {
        const json told_to_all = json::parse(line, nullptr, false);  // cut where it was too slow
        if (told_to_all.is_object()) types.push_back(told_to_all["type"]);
      }
    }};
  });
  reader.join();
  std::string things;
  std::string bays;
  for (const std::string& line : told) {
    const std::string type = json::parse(line)["type"];
    const std::string head = "{\"type\":\"" + type + "\",";
    ASSERT_TRUE(line.starts_with(head)) << line;
    (type == "thing" ? things : bays) += "{" + line.substr(head.size()) + "\n";
  }
  const std::string written = test::content_of(folder_.path() / "live/bays.jsonl");
  EXPECT_FALSE(bays.empty()) << "the drive sees the bay";
  EXPECT_TRUE(written.starts_with(bays)) << "what comes after the last pose is in the file alone";
  EXPECT_TRUE(test::content_of(folder_.path() / "live/things.jsonl").starts_with(things));
  for (const std::string& type : types) EXPECT_TRUE(type == "hello" || type == "pose") << type;
}

TEST_F(PoseStreamTest, WhatIsNoListOfItsKindsIsRefusedWithWhatToSay) {
  (void)run_live(std::chrono::microseconds(2000), [&](const Pipeline&) {
    for (const char* wish : {R"({"want":[]})", R"({"want":["poses","cells"]})", R"({"want":"poses"})", "[]", "x"}) {
      test::SocketClient client{settings_.poses.socket};
      (void)client.line();
      EXPECT_TRUE(client.send(std::string(wish) + "\n"));
      std::string line = client.line();
      while (json::parse(line)["type"] == "pose") line = client.line();
      EXPECT_EQ(json::parse(line)["why"], "ask with {\"want\":[…]}: a list of poses, things, bays") << wish;
      EXPECT_EQ(client.line(), "");
    }
  });
}

TEST_F(PoseStreamTest, WithoutDeltaMappingThereIsNoGate) {
  settings_.mapping.enabled = false;
  std::map<int, json> told;
  (void)run_live(std::chrono::microseconds(2000), [&](const Pipeline&) {
    test::SocketClient client{settings_.poses.socket};
    told = poses_of(client, 1);
  });
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told.begin()->second["gate"], nullptr);
}

TEST_F(PoseStreamTest, ASocketThatCannotBeHadIsAWarningAndTheRunGoesOn) {
  (void)folder_.write("poses.sock", "precious");
  std::vector<std::string> warnings;
  prepare_ = [&](Pipeline::Options& live) { live.warn = [&](const std::string& line) { warnings.push_back(line); }; };
  EXPECT_GT(run_live(std::chrono::microseconds(0)).scans.decoded, 0u);
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings.front(), "no stream of poses in this run: " + settings_.poses.socket +
                                  ": cannot listen: a file that is no socket is in the way");
}

TEST_F(PoseStreamTest, ASecondDaemonOnTheSameSocketEndsBeforeItDoesHarm) {
  Settings other = settings_;
  other.control.socket.clear();
  (void)run_live(std::chrono::microseconds(0), [&](const Pipeline&) {
    EXPECT_THROW((Pipeline{other, options()}), sockets::AlreadyServed);
  });
}

}  // namespace
}  // namespace deltamap::daemon
