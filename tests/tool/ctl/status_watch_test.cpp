// SPDX-License-Identifier: Apache-2.0
// `ctl status --watch`, before a daemon that answers, goes and comes back.
#include "tool/ctl/status_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <streambuf>
#include <thread>

#include "daemon/control/request.hpp"
#include "daemon/control/server.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

constexpr std::chrono::seconds kGiveUp{60};

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
  [[nodiscard]] bool has_answered(int times) {
    std::unique_lock lock{mutex_};
    return has_answered_.wait_for(lock, kGiveUp, [&] { return answered_ >= times; });
  }

 private:
  void answer(const std::string& line, const daemon::control::Server::Reply& reply) {
    EXPECT_EQ(line, R"({"command":"status"})");
    const int number = counted();
    reply(nlohmann::json{
        {"ok", true}, {"line", "scans=" + std::to_string(number)}, {"since_start_s", since_start_s_ + number}}
              .dump());
  }
  int counted() {
    const std::lock_guard lock{mutex_};
    has_answered_.notify_all();
    return ++answered_;
  }

  double since_start_s_;
  std::mutex mutex_;
  std::condition_variable has_answered_;
  int answered_ = 0;
  daemon::control::Server server_;
  std::thread thread_;
};

/// What one thread prints and another waits for.
class WatchedText : public std::streambuf {
 public:
  [[nodiscard]] std::string str() {
    const std::lock_guard lock{mutex_};
    return text_;
  }
  [[nodiscard]] bool comes(const std::string& words) {
    std::unique_lock lock{mutex_};
    return has_grown_.wait_for(lock, kGiveUp, [&] { return text_.find(words) != std::string::npos; });
  }

 private:
  std::streamsize xsputn(const char* characters, std::streamsize count) override {
    const std::lock_guard lock{mutex_};
    text_.append(characters, static_cast<std::size_t>(count));
    has_grown_.notify_all();
    return count;
  }
  int_type overflow(int_type character) override {
    const char one = traits_type::to_char_type(character);
    (void)xsputn(&one, 1);
    return character;
  }

  std::mutex mutex_;
  std::condition_variable has_grown_;
  std::string text_;
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
    std::packaged_task<std::string()> watch{[&]() -> std::string {
      try {
        watch_status(options_, out_, err_);
      } catch (const std::runtime_error& why) {
        return why.what();
      }
      return "";
    }};
    ended_ = watch.get_future();
    std::thread watcher{std::move(watch)};
    meanwhile();
    pthread_kill(watcher.native_handle(), SIGINT);
    watcher.join();
    return ended_.get();
  }
  [[nodiscard]] bool ends_by_itself() const { return ended_.wait_for(kGiveUp) == std::future_status::ready; }
  [[nodiscard]] std::vector<std::string> lines() {
    std::vector<std::string> all;
    std::istringstream text(printed_.str());
    for (std::string line; std::getline(text, line);) all.push_back(line);
    return all;
  }

  test::TemporaryFolder folder_;
  WatchOptions options_{.socket = folder_.path() / "ctl.sock", .period_s = 0.01, .patience_s = 60.0};
  WatchedText printed_;
  WatchedText told_;
  std::ostream out_{&printed_};
  std::ostream err_{&told_};
  std::future<std::string> ended_;
  sigset_t before_{};
};

TEST_F(StatusWatchTest, PrintsALineEachPeriodUntilCtrlC) {
  FakeDaemon daemon{options_.socket};
  EXPECT_EQ(watch_while([&] { EXPECT_TRUE(daemon.has_answered(4)); }), "");
  const auto printed = lines();
  ASSERT_GE(printed.size(), 3u);
  for (std::size_t i = 0; i < printed.size(); ++i) EXPECT_EQ(printed[i], "scans=" + std::to_string(i + 1));
  EXPECT_EQ(told_.str(), "");
}

TEST_F(StatusWatchTest, ADaemonThatGoesAndComesBackIsWaitedFor) {
  std::optional<FakeDaemon> daemon{std::in_place, options_.socket, 100.0};
  EXPECT_EQ(watch_while([&] {
              EXPECT_TRUE(daemon->has_answered(2));
              daemon.reset();
              EXPECT_TRUE(told_.comes("; waits for it"));
              daemon.emplace(options_.socket);
              EXPECT_TRUE(daemon->has_answered(2));
            }),
            "");
  const std::string told = told_.str();
  EXPECT_EQ(told.rfind("deltamap: " + options_.socket.string() + ": ", 0), 0u) << told;
  EXPECT_NE(told.find("; waits for it\ndeltamap: the daemon has been started again\n"), std::string::npos) << told;
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 2) << "each is told once: " << told;
}

TEST_F(StatusWatchTest, AsJsonEveryLineIsAnObjectWhateverHappens) {
  options_.as_json = true;
  std::optional<FakeDaemon> daemon{std::in_place, options_.socket, 100.0};
  (void)watch_while([&] {
    EXPECT_TRUE(daemon->has_answered(2));
    daemon.reset();
    EXPECT_TRUE(printed_.comes("; waits for it"));
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
  EXPECT_EQ(told_.str(), "");
}

TEST_F(StatusWatchTest, ADaemonThatDoesNotComeBackEndsIt) {
  options_.patience_s = 0.2;
  std::optional<FakeDaemon> daemon{std::in_place, options_.socket};
  const std::string error = watch_while([&] {
    EXPECT_TRUE(daemon->has_answered(2));
    daemon.reset();
    EXPECT_TRUE(ends_by_itself());
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
