// SPDX-License-Identifier: Apache-2.0
// Commands and driving over real sockets: what the live page's server takes, and every bound of it.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <random>
#include <vector>

#include "daemon/dashboard/server.hpp"
#include "tests/support/daemon/served_page.hpp"
#include "tests/support/daemon/web_client.hpp"

namespace deltamap::daemon::dashboard {
namespace {

using test::WebAnswer;
using test::WebClient;

const std::string kCommandToken = "0123456789abcdef";
const std::string kBearer = "Authorization: Bearer 0123456789abcdef\r\n";

/// Says back what it hears, and ends at the word "end".
class Echo final : public Dialog {
 public:
  explicit Echo(std::atomic<int>& present) : present_{present} { ++present_; }
  ~Echo() override { --present_; }
  void hear(const std::string& message) override { words_.push_back(message); }
  std::optional<Message> next() override {
    if (said_ == words_.size()) return std::nullopt;
    return Message{.is_binary = false, .bytes = std::make_shared<const std::string>(words_[said_++])};
  }
  [[nodiscard]] bool is_over() const override { return !words_.empty() && words_.back() == "end"; }

 private:
  std::atomic<int>& present_;
  std::vector<std::string> words_;
  std::size_t said_ = 0;
};

class DashboardCommands : public test::ServedPage {
 protected:
  DashboardCommands() {
    options_.guard = {.token = kCommandToken, .takes_commands = true};
    options_.answer = [](const Request&) { return Answer{.body = "read"}; };
    options_.open = [] { return std::unique_ptr<Stream>{}; };
    options_.command = [this](const Request& request, const Reply& reply) {
      {
        const std::scoped_lock lock{mutex_};
        commands_.push_back(request.body);
      }
      reply({.body = "done " + request.body});
    };
    options_.converse = [this] { return std::make_unique<Echo>(present_); };
    options_.period_s = 0.001;
  }
  ~DashboardCommands() override { stop(); }

  [[nodiscard]] WebAnswer posted(const std::string& body) const {
    return WebClient{port()}.posted("/api/command", body, kBearer);
  }
  [[nodiscard]] std::size_t taken() const {
    const std::scoped_lock lock{mutex_};
    return commands_.size();
  }

  mutable std::mutex mutex_;
  std::vector<std::string> commands_;
  std::atomic<int> present_{0};
};

TEST_F(DashboardCommands, ABodyArrivesWholeAndOneConnectionTakesSeveral) {
  start();
  WebClient client{port()};
  for (const std::string& body : {std::string{"{\"command\":\"pause\"}"}, std::string(4096, 'x'), std::string{}}) {
    const WebAnswer answer = client.posted("/api/command", body, kBearer);
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, "done " + body);
  }
  EXPECT_EQ(client.got("/", kBearer).body, "read");
  EXPECT_EQ(taken(), 3u);
}

TEST_F(DashboardCommands, ABodyMayComeInPieces) {
  start();
  WebClient client{port()};
  (void)client.send("POST /api/command HTTP/1.1\r\nHost: 127.0.0.1:1\r\nContent-Type: application/json\r\n" + kBearer +
                    "Content-Length: 6\r\n\r\nabc");
  (void)client.send("def");
  EXPECT_EQ(client.answer().body, "done abcdef");
}

TEST_F(DashboardCommands, BadRequestsAreRefusedAndReachNobody) {
  start();
  const auto status_of = [this](const std::string& head, const std::string& body = "{}") {
    WebClient client{port()};
    (void)client.send(head + "\r\n" + body);
    return client.answer().status;
  };
  const std::string post = "POST /api/command HTTP/1.1\r\nHost: 127.0.0.1:1\r\n";
  const std::string json = "Content-Type: application/json\r\n";
  const std::string two = "Content-Length: 2\r\n";
  EXPECT_EQ(status_of(post + json + kBearer), 411) << "no length";
  EXPECT_EQ(status_of(post + json + kBearer + "Transfer-Encoding: chunked\r\n", "2\r\n{}\r\n0\r\n\r\n"), 411);
  EXPECT_EQ(status_of(post + json + kBearer + "Content-Length: 4097\r\n", ""), 413);
  EXPECT_EQ(status_of(post + json + kBearer + "Content-Length: 99999999999999999999\r\n", ""), 400);
  EXPECT_EQ(status_of(post + json + kBearer + "Content-Length: -1\r\n", ""), 400);
  EXPECT_EQ(status_of(post + json + kBearer + two + "Content-Length: 3\r\n"), 400) << "two lengths";
  EXPECT_EQ(status_of(post + kBearer + two), 415) << "no type";
  EXPECT_EQ(status_of(post + kBearer + two + "Content-Type: text/plain\r\n"), 415);
  EXPECT_EQ(status_of(post + json + two), 401);
  EXPECT_EQ(status_of(post + json + two + "Authorization: Bearer 0123456789abcdeX\r\n"), 401);
  EXPECT_EQ(status_of(post + json + two + kBearer + "Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(status_of("POST /api/command HTTP/1.1\r\nHost: evil.example\r\n" + json + two + kBearer), 421);
  EXPECT_EQ(status_of("POST /api/status HTTP/1.1\r\nHost: 127.0.0.1:1\r\n" + json + two + kBearer), 405);
  EXPECT_EQ(status_of("GET /api/command HTTP/1.1\r\nHost: 127.0.0.1:1\r\n" + kBearer, ""), 405);
  EXPECT_EQ(taken(), 0u);
  EXPECT_EQ(posted("{}").status, 200);
}

TEST_F(DashboardCommands, WhereControlIsOffNothingIsTaken) {
  options_.guard.takes_commands = false;
  start();
  EXPECT_EQ(posted("{}").status, 403);
  EXPECT_EQ(WebClient{port()}.upgraded(kBearer, "/drive").status, 403);
  EXPECT_EQ(taken(), 0u);
}

TEST_F(DashboardCommands, ACommandThatIsNeverAnsweredIsAnsweredLateAndOnce) {
  Reply kept;
  options_.command = [&kept](const Request&, Reply reply) { kept = std::move(reply); };
  options_.command_patience_s = 0.02;
  start();
  WebClient client{port()};
  EXPECT_EQ(client.posted("/api/command", "{}", kBearer).status, 504);
  kept({.body = "too late"});
  EXPECT_TRUE(client.is_hung_up());
  EXPECT_EQ(WebClient{port()}.got("/", kBearer).status, 200);
}

TEST_F(DashboardCommands, AReplyAfterTheClientOrTheServerHasGoneIsNothing) {
  std::vector<Reply> kept;
  options_.command = [&kept](const Request&, Reply reply) { kept.push_back(std::move(reply)); };
  start();
  for (int i = 0; i < 2; ++i) {
    WebClient client{port()};
    (void)client.send("POST /api/command HTTP/1.1\r\nHost: 127.0.0.1:1\r\nContent-Type: application/json\r\n" +
                      kBearer + "Content-Length: 2\r\n\r\n{}");
  }
  EXPECT_EQ(WebClient{port()}.got("/", kBearer).status, 200);
  stop();
  for (const Reply& reply : kept) reply({.body = "nobody hears this"});
}

TEST_F(DashboardCommands, SurvivesDamagedCommands) {
  start();
  const std::string whole = "POST /api/command HTTP/1.1\r\nHost: 127.0.0.1:1\r\nContent-Type: application/json\r\n" +
                            kBearer + "Content-Length: 19\r\n\r\n{\"command\":\"pause\"}";
  std::mt19937 random{11};
  const auto below = [&random](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>{0, end - 1}(random);
  };
  for (int trial = 0; trial < 1000; ++trial) {
    std::string bytes = whole;
    for (std::size_t damages = 1 + below(6); damages > 0; --damages) {
      bytes[below(bytes.size())] = static_cast<char>(below(256));
    }
    WebClient client{port()};
    (void)client.send(bytes.substr(0, trial % 3 == 0 ? below(bytes.size()) : bytes.size()));
    ASSERT_TRUE(client.finishes()) << trial;
  }
  EXPECT_EQ(posted("{}").status, 200);
}

// --- driving ---

TEST_F(DashboardCommands, WhoDrivesIsHeardAndAnswered) {
  start();
  WebClient client{port()};
  ASSERT_EQ(client.upgraded(kBearer, "/drive").status, 101);
  for (const char* word : {"ahead", "left"}) {
    EXPECT_TRUE(client.send_frame(1, word));
    const auto frame = client.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->payload, word);
  }
  EXPECT_TRUE(client.send_frame(1, "end"));
  ASSERT_EQ(client.frame()->payload, "end");
  EXPECT_EQ(client.frame()->opcode, 8u);
}

TEST_F(DashboardCommands, HoweverAConnectionEndsItsDialogEnds) {
  start();
  const std::vector<std::string> ends{std::string("\x88\x80\0\0\0\0", 6),  // a proper close
                                      std::string("\x81\x02hi", 4),        // not masked
                                      std::string("\x82\xFE\x01\x01\0\0\0\0", 8) + std::string(257, 'x'),  // too long
                                      std::string("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\0\0\0", 14), ""};
  for (const std::string& end : ends) {
    {
      WebClient client{port()};
      ASSERT_EQ(client.upgraded(kBearer, "/drive").status, 101);
      EXPECT_TRUE(client.send_frame(1, "here"));
      ASSERT_TRUE(client.frame());
      EXPECT_EQ(present_, 1);
      (void)client.send(end);
      EXPECT_TRUE(end.empty() || client.finishes());
    }
    while (present_ != 0) std::this_thread::yield();
  }
}

TEST_F(DashboardCommands, AFifthDriverIsClosedAndAStopEndsAll) {
  start();
  std::vector<std::unique_ptr<WebClient>> clients;
  for (int i = 0; i < 4; ++i) {
    clients.push_back(std::make_unique<WebClient>(port()));
    ASSERT_EQ(clients.back()->upgraded(kBearer, "/drive").status, 101);
    EXPECT_TRUE(clients.back()->send_frame(1, "here"));
    ASSERT_TRUE(clients.back()->frame());
  }
  EXPECT_EQ(WebClient{port()}.upgraded(kBearer, "/drive").status, 0);
  EXPECT_EQ(present_, 4);
  stop();
  EXPECT_EQ(present_, 0);
}

}  // namespace
}  // namespace deltamap::daemon::dashboard
