// SPDX-License-Identifier: Apache-2.0
// STOP gets through to the daemon whoever else is at the page, over real sockets: idle, slow, rude, many, and where the
// process can open nothing more.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "daemon/dashboard/server.hpp"
#include "tests/support/daemon/served_page.hpp"
#include "tests/support/daemon/web_client.hpp"
#include "tests/support/files/no_descriptors.hpp"

namespace deltamap::daemon::dashboard {
namespace {

using test::WebClient;

const std::string kTokenHeader = "Authorization: Bearer 0123456789abcdef\r\n";
const std::string kStop = R"({"command":"drive","mode":"off"})";

/// A locked page with few places. What is no STOP waits for its reply until the end.
class StopTest : public test::ServedPage {
 protected:
  StopTest() {
    options_.guard = {.token = "0123456789abcdef", .takes_commands = true};
    options_.answer = [](const Request&) { return Answer{.body = std::string(1'000'000, 'x')}; };
    options_.open = [] { return std::unique_ptr<Stream>{}; };
    options_.converse = [] { return std::unique_ptr<Dialog>{}; };
    options_.is_stop = [](const std::string& body) { return body == kStop; };
    options_.command = [this](const Request& request, Reply reply) {
      if (request.body == kStop) {
        ++stops_;
        return reply({.body = "stands"});
      }
      const std::scoped_lock lock{mutex_};
      waiting_.push_back(std::move(reply));
    };
    options_.command_patience_s = 600.0;
    options_.most_connections = 24;
    options_.most_from_one = 18;
    options_.most_viewers = 8;
  }
  ~StopTest() override { stop(); }

  [[nodiscard]] int stopped(const std::string& headers = "") const {
    return WebClient{port()}.posted("/api/command", kStop, headers).status;
  }

  std::mutex mutex_;
  std::vector<Reply> waiting_;
  std::atomic<int> stops_{0};
};

TEST_F(StopTest, NeedsNoTokenWhereThePageIsReadWithoutOneAndAllElseDoes) {
  start();
  EXPECT_EQ(stopped(), 200);
  EXPECT_EQ(stopped(kTokenHeader), 200);
  EXPECT_EQ(stopped("Authorization: Bearer 0123456789abcdeX\r\n"), 200);
  EXPECT_EQ(stops_, 3);
  EXPECT_EQ(WebClient{port()}.posted("/api/command", R"({"command":"pause"})").status, 401);
  EXPECT_EQ(WebClient{port()}.upgraded("", "/drive").status, 401);
  const auto sent = [this](const std::string& host, const std::string& headers) {
    WebClient client{port()};
    (void)client.send("POST /api/command HTTP/1.1\r\nHost: " + host +
                      "\r\nContent-Length: " + std::to_string(kStop.size()) + "\r\n" + headers + "\r\n" + kStop);
    return client.answer().status;
  };
  const std::string json = "Content-Type: application/json\r\n";
  EXPECT_EQ(sent("192.168.1.7:8484", json), 401) << "where reading needs the token, STOP does";
  EXPECT_EQ(sent("127.0.0.1", "Content-Type: text/plain\r\n"), 401) << "a form of another site";
  EXPECT_EQ(sent("127.0.0.1", json + "Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(sent("evil.example", json), 421);
  EXPECT_EQ(stops_, 3);
}

TEST_F(StopTest, WhereThePageTakesNoCommandsItTakesNoStop) {
  options_.guard.takes_commands = false;
  start();
  EXPECT_EQ(stopped(kTokenHeader), 403);
  EXPECT_EQ(stopped(), 401) << "as whatever else is not done without the token";
}

TEST_F(StopTest, IsNeverOneTooMany) {
  start();
  std::vector<std::unique_ptr<WebClient>> guests;
  const auto add = [&](int count, const std::string& bytes) {
    for (int i = 0; i < count; ++i) {
      guests.push_back(std::make_unique<WebClient>(port()));
      (void)guests.back()->send(bytes);
    }
  };
  const std::string host = " HTTP/1.1\r\nHost: 127.0.0.1:1\r\n";
  const std::string upgrade =
      "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  for (int round = 0; round < 8; ++round) {
    add(30, "");
    EXPECT_EQ(stopped(), 200) << "idle";
    add(30, "GET / HT");
    EXPECT_EQ(stopped(), 200) << "half a request";
    add(30,
        "POST /api/command" + host + kTokenHeader + "Content-Type: application/json\r\nContent-Length: 10\r\n\r\n{");
    EXPECT_EQ(stopped(), 200) << "half a command";
    add(30, "GET /map.png" + host + "\r\n");
    EXPECT_EQ(stopped(), 200) << "does not take its answer";
    add(30, "GET /live" + host + upgrade);
    EXPECT_EQ(stopped(), 200) << "viewers";
    add(6, "GET /drive" + host + kTokenHeader + upgrade);
    EXPECT_EQ(stopped(), 200) << "who drives";
    add(30,
        "POST /api/command" + host + kTokenHeader + "Content-Type: application/json\r\nContent-Length: 2\r\n\r\n{}");
    EXPECT_EQ(stopped(), 200) << "commands that wait";
    EXPECT_EQ(stopped(kTokenHeader), 200);
  }
}

TEST_F(StopTest, IsHeardFromWhoHasJustComeHoweverManyAsk) {
  options_.time_to_speak_s = 600.0;
  start();
  const std::string asks = "GET /map.png HTTP/1.1\r\nHost: 127.0.0.1:1\r\n";
  for (const std::string& headers : {std::string{}, kTokenHeader}) {
    std::vector<std::unique_ptr<WebClient>> guests;
    const auto add = [&](int count) {
      for (int i = 0; i < count; ++i) {
        guests.push_back(std::make_unique<WebClient>(port()));
        for (int j = 0; j < 20; ++j) (void)guests.back()->send(asks + headers + "\r\n");
      }
    };
    for (int round = 0; round < 20; ++round) {
      add(20);
      EXPECT_EQ(stopped(), 200) << "those before it have come in";
      WebClient stops{port()};
      for (int i = 0; i < 3; ++i) {
        add(4);
        EXPECT_EQ(stopped(), 200) << "those before it have come in";
      }
      EXPECT_EQ(stops.posted("/api/command", kStop).status, 200) << round;
    }
  }
}

TEST_F(StopTest, OtherCommandsAreRefusedWhereTooManyWait) {
  start();
  std::vector<std::unique_ptr<WebClient>> waiting;
  for (int i = 0; i < 4; ++i) {
    waiting.push_back(std::make_unique<WebClient>(port()));
    (void)waiting.back()->send("POST /api/command HTTP/1.1\r\nHost: 127.0.0.1:1\r\nContent-Type: application/json\r\n" +
                               kTokenHeader + "Content-Length: 2\r\n\r\n{}");
  }
  const auto are_waiting = [this] {
    const std::scoped_lock lock{mutex_};
    return waiting_.size();
  };
  while (are_waiting() < 4) std::this_thread::yield();
  EXPECT_EQ(WebClient{port()}.posted("/api/command", "{}", kTokenHeader).status, 503);
  EXPECT_EQ(stopped(), 200);
  {
    const std::scoped_lock lock{mutex_};
    for (const Reply& reply : waiting_) reply({.body = "at last"});
  }
  for (const auto& client : waiting) EXPECT_EQ(client->answer().status, 200);
  WebClient next{port()};
  (void)next.send("POST /api/command HTTP/1.1\r\nHost: 127.0.0.1:1\r\nContent-Type: application/json\r\n" +
                  kTokenHeader + "Content-Length: 2\r\n\r\n{}");
  while (are_waiting() < 5) std::this_thread::yield();
}

TEST_F(StopTest, IsTakenWhereTheProcessCanOpenNothingMore) {
  start();
  WebClient guest{port()};
  EXPECT_EQ(guest.got("/", kTokenHeader).status, 200);
  std::vector<std::unique_ptr<WebClient>> idle;
  std::vector<std::unique_ptr<WebClient>> stops;
  for (int i = 0; i < 5; ++i) {
    idle.push_back(std::make_unique<WebClient>());
    stops.push_back(std::make_unique<WebClient>());
  }
  test::NoDescriptors none_left;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    idle[i]->connect(port());
    (void)idle[i]->send("GET / HT");
    (void)none_left.take();
    stops[i]->connect(port());
    EXPECT_EQ(stops[i]->posted("/api/command", kStop).status, 200) << i;
  }
}

}  // namespace
}  // namespace deltamap::daemon::dashboard
