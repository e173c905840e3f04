// SPDX-License-Identifier: Apache-2.0
// The live page with a whole daemon behind it.
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/dashboard/server.hpp"
#include "tests/support/bytes/live_decoding.hpp"
#include "tests/support/daemon/pipeline_fixture.hpp"
#include "tests/support/daemon/web_client.hpp"

namespace deltamap::daemon {
namespace {

using test::WebClient;

/// Nobody listens there a moment later.
std::uint16_t free_port() {
  const dashboard::Server server{{.answer = {}, .open = {}}};
  return server.port();
}

class DashboardPipelineTest : public test::PipelineFixture {
 protected:
  DashboardPipelineTest() {
    settings_.dashboard.port = free_port();
    prepare_ = [this](Pipeline::Options& live) {
      live.warn = [this](const std::string& line) {
        const std::scoped_lock lock{mutex_};
        warnings_.push_back(line);
      };
    };
  }
  std::mutex mutex_;
  std::vector<std::string> warnings_;
};

TEST_F(DashboardPipelineTest, AChangeOfTheMapArrivesAsABoxAndTheReplayIsTheSame) {
  bool has_seen_box = false;
  int poses = 0;
  const RunReport live = run_live(std::chrono::microseconds(2000), [&](const Pipeline&) {
    WebClient viewer{settings_.dashboard.port};
    ASSERT_EQ(viewer.upgraded().status, 101);
    while (!has_seen_box) {
      const auto frame = viewer.frame();
      ASSERT_TRUE(frame);
      if (frame->opcode == 1 && frame->payload.find(R"("type":"pose")") != std::string::npos) ++poses;
      if (frame->opcode != 2 || test::u32_at(frame->payload, 0) != 1) continue;
      has_seen_box = test::decoded_cells(frame->payload).revision > 0;
    }
  });
  EXPECT_GE(poses, 3);
  EXPECT_GE(live.changes.accepted(), 1u);
  (void)replay("live.pcapng", "replayed");
  expect_same_files("live", "replayed");
}

TEST_F(DashboardPipelineTest, StopsAtOnceWhileAViewerDoesNotRead) {
  std::optional<WebClient> viewer;
  (void)run_live(std::chrono::microseconds(200), [&](const Pipeline&) {
    viewer.emplace(settings_.dashboard.port, 4096);
    EXPECT_EQ(viewer->upgraded().status, 101);
  });
  EXPECT_TRUE(viewer->is_hung_up());
}

TEST_F(DashboardPipelineTest, APortInUseIsOneWarningAndTheRobotGoesOn) {
  const dashboard::Server other{{.answer = {}, .open = {}}};
  settings_.dashboard.port = other.port();
  const RunReport live = run_live(std::chrono::microseconds(200));
  EXPECT_GT(live.scans.localized, 50u);
  const std::string place = "127.0.0.1:" + std::to_string(other.port());
  EXPECT_EQ(std::count(warnings_.begin(), warnings_.end(),
                       "no live page in this run: " + place + ": cannot listen: Address already in use"),
            1);
}

TEST_F(DashboardPipelineTest, AMissingTokenIsOneWarningAndNoPage) {
  settings_.dashboard.token_file = folder_.path() / "missing";
  (void)run_live(std::chrono::microseconds(100),
                 [&](const Pipeline&) { EXPECT_FALSE(WebClient{settings_.dashboard.port}.is_connected()); });
  EXPECT_EQ(
      std::count_if(warnings_.begin(), warnings_.end(),
                    [](const std::string& line) { return line.find("missing: no token: ") != std::string::npos; }),
      1);
}

TEST_F(DashboardPipelineTest, BeyondThisMachineEverybodyIsAskedForTheToken) {
  const auto token = folder_.write("token", "0123456789abcdef\n");
  std::filesystem::permissions(token, std::filesystem::perms::owner_read);
  settings_.dashboard.token_file = token;
  settings_.dashboard.address = "0.0.0.0";
  (void)run_live(std::chrono::microseconds(100), [&](const Pipeline&) {
    for (const char* path :
         {"/", "/page/main.js", "/api/status", "/api/map.png", "/api/history", "/metrics", "/live"}) {
      WebClient client{settings_.dashboard.port};
      (void)client.send("GET " + std::string(path) + " HTTP/1.1\r\nHost: 192.168.1.7:8484\r\n\r\n");
      EXPECT_EQ(client.answer().status, 401) << path;
    }
    WebClient client{settings_.dashboard.port};
    EXPECT_EQ(client.got("/api/status", "Authorization: Bearer 0123456789abcdef\r\n").status, 200);
  });
}

}  // namespace
}  // namespace deltamap::daemon
