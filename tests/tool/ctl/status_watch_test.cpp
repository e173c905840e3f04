// SPDX-License-Identifier: Apache-2.0
// `ctl status --watch`, before a daemon that answers, goes and comes back.
#include "tool/ctl/status_watch.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "daemon/control/request.hpp"
#include "daemon/control/server.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

using namespace std::chrono_literals;

/// Answers each request with a status whose line counts them.
class FakeDaemon {
 public:
  explicit FakeDaemon(const std::filesystem::path& socket, double since_start_s = 0.0)
      : since_start_s_{since_start_s},
        server_{{.socket = socket,
                 .handle = [this](const std::string& line, bool,
                                  daemon::control::Server::Reply reply) { answer(line, reply); },
                 .late_reply = ""}},
        thread_{[this] { server_.run(); }} {}
  ~FakeDaemon() {
    server_.stop();
    thread_.join();
  }
  [[nodiscard]] int answered() const { return answered_; }
  [[nodiscard]] bool has_answered(int times) const {
    for (const auto until = std::chrono::steady_clock::now() + 60s; std::chrono::steady_clock::now() < until;) {
      if (answered_ >= times) return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }

 private:
  void answer(const std::string& line, const daemon::control::Server::Reply& reply) {
    EXPECT_EQ(line, R"({"command":"status"})");
    const int number = ++answered_;
    reply(nlohmann::json{
        {"ok", true}, {"line", "scans=" + std::to_string(number)}, {"since_start_s", since_start_s_ + number}}
              .dump());
  }
  double since_start_s_;
  std::atomic<int> answered_{0};
  daemon::control::Server server_;
  std::thread thread_;
};

class StatusWatchTest : public testing::Test {
 protected:
  StatusWatchTest() {
    sigset_t interrupt;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    pthread_sigmask(SIG_BLOCK, &interrupt, &before_);  // for the threads of this test: none dies of it
  }
  ~StatusWatchTest() override { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  /// Watches while `meanwhile` goes on, then presses Ctrl-C; answers what the watch ended with.
  template <typename Meanwhile>
  std::string watch_while(const Meanwhile& meanwhile) {
    std::string error;
    std::thread watcher{[&] {
      try {
        watch_status(options_, out_, err_);
      } catch (const std::runtime_error& why) {
        error = why.what();
      }
    }};
    meanwhile();
    pthread_kill(watcher.native_handle(), SIGINT);
    watcher.join();
    return error;
  }
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::istringstream text(out_.str());
    for (std::string line; std::getline(text, line);) all.push_back(line);
    return all;
  }

  test::TemporaryFolder folder_;
  WatchOptions options_{.socket = folder_.path() / "ctl.sock", .period_s = 0.01, .patience_s = 60.0};
  std::ostringstream out_;
  std::ostringstream err_;
  sigset_t before_{};
};

TEST_F(StatusWatchTest, PrintsALineEachPeriodUntilCtrlC) {
  const FakeDaemon daemon{options_.socket};
  EXPECT_EQ(watch_while([&] { EXPECT_TRUE(daemon.has_answered(4)); }), "");
  const auto printed = lines();
  ASSERT_GE(printed.size(), 3u);
  for (std::size_t i = 0; i < printed.size(); ++i) EXPECT_EQ(printed[i], "scans=" + std::to_string(i + 1));
  EXPECT_EQ(err_.str(), "");
}

TEST_F(StatusWatchTest, ADaemonThatGoesAndComesBackIsWaitedFor) {
  std::optional<FakeDaemon> daemon{std::in_place, options_.socket, 100.0};
  EXPECT_EQ(watch_while([&] {
              EXPECT_TRUE(daemon->has_answered(2));
              daemon.reset();
              std::this_thread::sleep_for(100ms);
              daemon.emplace(options_.socket);
              EXPECT_TRUE(daemon->has_answered(2));
            }),
            "");
  const std::string told = err_.str();
  EXPECT_NE(told.find(": no daemon listens there"), std::string::npos) << told;
  EXPECT_NE(told.find("; waits for it\ndeltamap: the daemon has been started again\n"), std::string::npos) << told;
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 2) << "each is told once: " << told;
}

TEST_F(StatusWatchTest, AsJsonEveryLineIsAnObjectWhateverHappens) {
  options_.as_json = true;
  std::optional<FakeDaemon> daemon{std::in_place, options_.socket, 100.0};
  (void)watch_while([&] {
    EXPECT_TRUE(daemon->has_answered(2));
    daemon.reset();
    std::this_thread::sleep_for(100ms);
    daemon.emplace(options_.socket);
    EXPECT_TRUE(daemon->has_answered(2));
  });
  int errors = 0;
  for (const std::string& line : lines()) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(json.is_object()) << line;
    errors += json["ok"] == true ? 0 : 1;
  }
  EXPECT_EQ(errors, 2);
  EXPECT_EQ(err_.str(), "");
}

TEST_F(StatusWatchTest, ADaemonThatDoesNotComeBackEndsIt) {
  options_.patience_s = 0.2;
  std::optional<FakeDaemon> daemon{std::in_place, options_.socket};
  const std::string error = watch_while([&] {
    EXPECT_TRUE(daemon->has_answered(2));
    daemon.reset();
    std::this_thread::sleep_for(1s);
  });
  EXPECT_NE(error.find("no daemon listens there"), std::string::npos) << error;
}

TEST_F(StatusWatchTest, AtTheCommandLine) {
  const std::string socket = options_.socket;
  EXPECT_EQ(test::run_deltamap({"ctl", "--socket", socket, "status", "--watch"}).exit_code, 1) << "nobody is there";
  EXPECT_EQ(test::run_deltamap({"ctl", "--socket", socket, "status", "--watch", "0.5", "--json"}).exit_code, 1);
  for (const char* period : {"0", "-1", "abc", "1x", "1e9", "nan"}) {
    EXPECT_EQ(test::run_deltamap({"ctl", "--socket", socket, "status", "--watch", period}).exit_code, 2) << period;
  }
}

}  // namespace
}  // namespace deltamap::tool
