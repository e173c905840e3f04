// SPDX-License-Identifier: Apache-2.0
// Every refusal and every bound of the live page's server, over real sockets.
#include "daemon/dashboard/server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <new>
#include <random>
#include <semaphore>
#include <stdexcept>
#include <vector>

#include "tests/support/daemon/served_page.hpp"
#include "tests/support/daemon/web_client.hpp"

namespace deltamap::daemon::dashboard {
namespace {

using test::WebAnswer;
using test::WebClient;

/// The numbers 1, 2, 3 … as long as `most` lasts.
class Numbers final : public Stream {
 public:
  Numbers(int most, std::size_t size) : most_{most}, size_{size} {}
  std::optional<Message> next() override {
    if (next_ > most_) return std::nullopt;
    std::string text = std::to_string(next_++);
    text.resize(std::max(text.size(), size_), ' ');
    return Message{.is_binary = false, .bytes = std::make_shared<const std::string>(std::move(text))};
  }

 private:
  int next_ = 1;
  int most_;
  std::size_t size_;
};

class DashboardServer : public test::ServedPage {
 protected:
  DashboardServer() {
    options_.answer = [](const Request& request) { return Answer{.body = "you asked for " + request.path + "\n"}; };
    options_.open = [this] { return std::make_unique<Numbers>(messages_, message_size_); };
    options_.watched = [this](bool is_watched) {
      is_watched_ = is_watched;
      watch_changes_.release();
    };
    options_.refresh = [this] { ++refreshes_; };
    options_.period_s = 0.001;
  }
  ~DashboardServer() override { stop(); }

  [[nodiscard]] WebAnswer got(const std::string& path, const std::string& headers = "") const {
    return WebClient{port()}.got(path, headers);
  }

  int messages_ = 3;
  std::size_t message_size_ = 0;
  std::atomic<bool> is_watched_{false};
  std::counting_semaphore<> watch_changes_{0};
  std::atomic<int> refreshes_{0};
};

TEST_F(DashboardServer, AnswersGetAfterGetOnOneConnection) {
  start();
  WebClient client{port()};
  for (const char* path : {"/one", "/two?x=y"}) {
    const WebAnswer answer = client.got(path);
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, "you asked for " + std::string(path).substr(0, 4) + "\n");
  }
}

TEST_F(DashboardServer, AnAnswerThatFailsFailsAlone) {
  options_.answer = [](const Request& request) -> Answer {
    if (request.path == "/large") throw std::bad_alloc{};
    return {.body = "well"};
  };
  start();
  EXPECT_EQ(got("/large").status, 500);
  EXPECT_EQ(got("/small").body, "well");
}

TEST_F(DashboardServer, EveryAnswerForbidsOtherSites) {
  start();
  for (const char* host : {"Host: localhost\r\n", "Host: evil.example\r\n"}) {
    const WebAnswer answer = got("/", host);
    EXPECT_EQ(answer.headers.at("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(answer.headers.at("X-Frame-Options"), "DENY");
    EXPECT_EQ(answer.headers.at("Cross-Origin-Resource-Policy"), "same-origin");
    EXPECT_TRUE(answer.headers.at("Content-Security-Policy").starts_with("default-src 'none'"));
    EXPECT_EQ(answer.headers.count("Access-Control-Allow-Origin"), 0u);
  }
}

TEST_F(DashboardServer, RefusesForeignHostsOriginsAndMethods) {
  start();
  EXPECT_EQ(got("/", "Host: evil.example\r\n").status, 421);
  EXPECT_EQ(got("/", "Origin: http://evil.example\r\n").status, 403);
  for (const char* method : {"POST", "PUT", "DELETE", "HEAD", "OPTIONS"}) {
    WebClient client{port()};
    EXPECT_EQ(client.asked(std::string(method) + " /").status, 405) << method;
  }
  EXPECT_EQ(WebClient{port()}.upgraded("Origin: http://evil.example\r\n").status, 403);
  EXPECT_FALSE(is_watched_);
}

TEST_F(DashboardServer, RefusesBodiesAndWhatIsNoHttp) {
  start();
  EXPECT_EQ(got("/", "Content-Length: 5\r\n").status, 413);
  EXPECT_EQ(got("/", "Transfer-Encoding: chunked\r\n").status, 413);
  for (const char* noise : {"\x16\x03\x01\x02\r\n\r\n", "hello\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n"}) {
    WebClient client{port()};
    (void)client.send(noise);
    EXPECT_EQ(client.answer().status, 400) << noise;
    EXPECT_TRUE(client.is_hung_up());
  }
  EXPECT_EQ(got("/").status, 200);
}

TEST_F(DashboardServer, RefusesLongHeaders) {
  start();
  EXPECT_EQ(got("/", "X: " + std::string(7000, 'x') + "\r\n").status, 200);
  EXPECT_EQ(got("/", "X: " + std::string(9000, 'x') + "\r\n").status, 431);
  EXPECT_EQ(got("/" + std::string(9000, 'x')).status, 431);
}

TEST_F(DashboardServer, ReadingFromThisMachineNeedsNoTokenAndByAnotherAddressItDoes) {
  options_.guard.token = "0123456789abcdef";
  start();
  EXPECT_EQ(got("/").status, 200);
  EXPECT_EQ(WebClient{port()}.upgraded().status, 101);
  const auto by_another_address = [this](const std::string& target, const std::string& headers = "") {
    WebClient client{port()};
    (void)client.send("GET " + target + " HTTP/1.1\r\nHost: 192.168.1.7:8484\r\n" + headers + "\r\n");
    return client.answer().status;
  };
  for (const char* path : {"/", "/page/main.js", "/api/status", "/api/map.png", "/metrics", "/live"}) {
    EXPECT_EQ(by_another_address(path), 401) << path;
  }
  EXPECT_EQ(by_another_address("/api/status", "Authorization: Bearer 0123456789abcdeX\r\n"), 401);
  EXPECT_EQ(by_another_address("/?token=0123456789abcdeX"), 401);
  EXPECT_EQ(by_another_address("/", "Authorization: Bearer 0123456789abcdef\r\n"), 200);
  const WebAnswer entry = got("/?token=0123456789abcdef");
  EXPECT_EQ(entry.status, 303);
  const std::string cookie = entry.headers.at("Set-Cookie").substr(0, entry.headers.at("Set-Cookie").find(';'));
  EXPECT_EQ(got("/", "Cookie: " + cookie + "\r\n").status, 200);
  EXPECT_EQ(WebClient{port()}.upgraded("Cookie: " + cookie + "\r\n").status, 101);
}

TEST_F(DashboardServer, OneConnectionTooManyIsAnsweredAndWhoWasSilentLongestLeaves) {
  options_.most_connections = 3;
  start();
  WebClient first{port()};
  WebClient second{port()};
  WebClient third{port()};
  for (WebClient* client : {&first, &second, &third}) EXPECT_EQ(client->got("/").status, 200);
  EXPECT_EQ(first.got("/").status, 200);
  WebClient fourth{port()};
  EXPECT_EQ(fourth.got("/").status, 200);
  EXPECT_TRUE(second.is_hung_up());
  EXPECT_EQ(first.got("/").status, 200);
  EXPECT_EQ(third.got("/").status, 200);
}

TEST_F(DashboardServer, WhoHasShownTheTokenIsShownThePageInPlaceOfAStranger) {
  options_.guard.token = "0123456789abcdef";
  options_.most_viewers = 2;
  start();
  const std::string token = "Authorization: Bearer 0123456789abcdef\r\n";
  WebClient stranger{port()};
  WebClient known{port()};
  EXPECT_EQ(stranger.upgraded().status, 101);
  EXPECT_EQ(known.upgraded(token).status, 101);
  EXPECT_EQ(WebClient{port()}.upgraded().status, 0) << "a stranger for nobody";
  WebClient another{port()};
  EXPECT_EQ(another.upgraded(token).status, 101);
  EXPECT_TRUE(stranger.is_hung_up());
  EXPECT_EQ(WebClient{port()}.upgraded(token).status, 0) << "nor one that is known for another";
  for (WebClient* viewer : {&known, &another}) EXPECT_TRUE(viewer->frame());
}

TEST_F(DashboardServer, ACommandDoesNotWaitForALineOfRequestsThatRead) {
  constexpr int kReaders = 30;
  std::binary_semaphore is_at_work{0};
  std::binary_semaphore all_have_come{0};
  std::vector<std::string> order;  // of the server's thread, which is joined before it is read
  options_.answer = [&](const Request& request) -> Answer {
    order.push_back(request.path);
    if (request.path == "/first") {
      is_at_work.release();
      all_have_come.acquire();
    }
    return {.body = "well"};
  };
  options_.guard.takes_commands = true;
  options_.command = [&](const Request&, const Reply& reply) {
    order.emplace_back("command");
    reply({.body = "done"});
  };
  start();
  std::vector<std::unique_ptr<WebClient>> readers;
  const auto read = [&](const std::string& path) {
    readers.push_back(std::make_unique<WebClient>(port()));
    (void)readers.back()->send("GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:1\r\n\r\n");
  };
  read("/first");
  is_at_work.acquire();
  for (int i = 0; i < kReaders; ++i) read("/next");
  WebClient client{port()};
  (void)client.send(
      "POST /api/command HTTP/1.1\r\nHost: 127.0.0.1:1\r\nContent-Type: application/json\r\nContent-Length: "
      "2\r\n\r\n{}");
  all_have_come.release();
  EXPECT_EQ(client.answer().status, 200);
  for (const auto& reader : readers) EXPECT_EQ(reader->answer().status, 200);
  stop();
  EXPECT_LT(std::find(order.begin(), order.end(), "command") - order.begin(), kReaders / 2);
}

TEST_F(DashboardServer, OneViewerTooManyIsClosed) {
  options_.most_viewers = 1;
  start();
  WebClient first{port()};
  EXPECT_EQ(first.upgraded().status, 101);
  ASSERT_TRUE(first.frame());
  WebClient second{port()};
  EXPECT_EQ(second.upgraded().status, 0);
}

TEST_F(DashboardServer, AViewerIsSentWhatTheStreamHas) {
  start();
  WebClient client{port()};
  const WebAnswer answer = client.upgraded("Origin: http://127.0.0.1:1\r\n");
  EXPECT_EQ(answer.status, 101);
  EXPECT_EQ(answer.headers.at("Sec-WebSocket-Accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");  // RFC 6455, section 1.3
  for (const char* number : {"1", "2", "3"}) {
    const auto frame = client.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->opcode, 1u);
    EXPECT_EQ(frame->payload, number);
  }
}

TEST_F(DashboardServer, NothingRunsWithoutAViewer) {
  start();
  EXPECT_EQ(got("/").status, 200);
  EXPECT_EQ(refreshes_, 0);
  {
    WebClient client{port()};
    EXPECT_EQ(client.upgraded().status, 101);
    watch_changes_.acquire();
    EXPECT_TRUE(is_watched_);
    EXPECT_GE(refreshes_, 1);
  }
  watch_changes_.acquire();
  EXPECT_FALSE(is_watched_);
  const int at_end = refreshes_;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(got("/").status, 200);
  EXPECT_EQ(refreshes_, at_end);
}

TEST_F(DashboardServer, AViewerThatSendsDataIsClosed) {
  start();
  WebClient client{port()};
  EXPECT_EQ(client.upgraded().status, 101);
  for (int i = 0; i < messages_; ++i) ASSERT_TRUE(client.frame());
  EXPECT_TRUE(client.send_frame(1, "drive"));
  const auto frame = client.frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->opcode, 8u);
  EXPECT_EQ(frame->payload.substr(0, 2), std::string("\x03\xF0", 2));  // 1008: policy violation
}

TEST_F(DashboardServer, MalformedFramesEndTheirConnectionAlone) {
  start();
  WebClient calm{port()};
  EXPECT_EQ(calm.upgraded().status, 101);
  const std::string bad_frames[] = {
      std::string("\x81\x02hi", 4),                                         // not masked
      std::string("\x8F\x80\0\0\0\0", 6),                                   // reserved opcode
      std::string("\xF1\x80\0\0\0\0", 6),                                   // reserved bits
      std::string("\x89\xFE\x01\0\0\0\0\0", 8),                             // a ping of 256 bytes
      std::string("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\0\0\0", 14),  // 2^63 bytes
      std::string("\x82\xFE\x04\x01\0\0\0\0", 8) + std::string(1025, 'x'),  // longer than is taken
      std::string("\x80\x80\0\0\0\0", 6),                                   // goes on with nothing
      std::string("\x81\x81\0\0\0\0\xFF", 7)};                              // no UTF-8
  for (const std::string& bad : bad_frames) {
    WebClient client{port()};
    EXPECT_EQ(client.upgraded().status, 101);
    (void)client.send(bad);
    EXPECT_TRUE(client.is_hung_up());
  }
  EXPECT_TRUE(calm.frame());
  EXPECT_EQ(got("/").status, 200);
}

TEST_F(DashboardServer, SurvivesDamagedRequestsAndFrames) {
  start();
  const std::string upgrade =
      "GET /live HTTP/1.1\r\nHost: 127.0.0.1:1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  std::mt19937 random{7};
  const auto below = [&random](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>{0, end - 1}(random);
  };
  for (int trial = 0; trial < 1000; ++trial) {
    std::string bytes = upgrade;
    for (std::size_t noise = below(40); noise > 0; --noise) bytes.push_back(static_cast<char>(below(256)));
    const std::size_t first = trial % 2 == 0 ? 0 : upgrade.size() - 1;  // half of them leave the request as it is
    for (std::size_t damages = below(6); damages > 0; --damages) {
      bytes[first + below(bytes.size() - first)] = static_cast<char>(below(256));
    }
    WebClient client{port()};
    (void)client.send(bytes.substr(0, trial % 3 == 0 ? below(bytes.size()) : bytes.size()));
    ASSERT_TRUE(client.finishes()) << trial;
  }
  EXPECT_EQ(got("/").status, 200);
}

TEST_F(DashboardServer, ASlowReaderIsDroppedAndAQuickOneIsNot) {
  messages_ = 1'000'000;
  message_size_ = 60'000;
  options_.patience_s = 0.05;
  start();
  WebClient slow{port(), 4096};
  EXPECT_EQ(slow.upgraded().status, 101);
  watch_changes_.acquire();  // it has come
  watch_changes_.acquire();  // and been dropped, although it has not read
  EXPECT_FALSE(is_watched_);
  EXPECT_TRUE(slow.is_hung_up());
  stop();
  messages_ = 200;
  options_.patience_s = 600.0;  // this machine may be busy
  start();
  WebClient quick{port()};
  EXPECT_EQ(quick.upgraded().status, 101);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(quick.frame()) << i;
}

TEST_F(DashboardServer, StopsAtOnceWithViewersAndIdleConnections) {
  messages_ = 1'000'000;
  message_size_ = 60'000;
  start();
  WebClient viewer{port(), 4096};
  EXPECT_EQ(viewer.upgraded().status, 101);
  WebClient idle{port()};
  EXPECT_EQ(idle.got("/").status, 200);
  const auto began = std::chrono::steady_clock::now();
  stop();
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(9)) << "the patience with a viewer is 10 s";
  EXPECT_TRUE(idle.is_hung_up());
}

TEST_F(DashboardServer, TakesASocketThatListensAlready) {
  const int listening = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listening, 8), 0);
  options_.descriptor = listening;
  start();
  EXPECT_EQ(server_->place(), "127.0.0.1:" + std::to_string(port()));
  EXPECT_EQ(got("/").status, 200);
}

TEST_F(DashboardServer, WithoutATokenNothingLeavesThisMachine) {
  options_.address = "0.0.0.0";
  EXPECT_THROW(start(), std::runtime_error);
  options_.descriptor = ::socket(AF_INET, SOCK_STREAM, 0);  // bound to no address: any
  EXPECT_THROW(start(), std::runtime_error);
  int pipe_ends[2];
  ASSERT_EQ(::pipe(pipe_ends), 0);
  options_.descriptor = pipe_ends[0];
  EXPECT_THROW(start(), std::runtime_error);
  ::close(pipe_ends[0]);
  ::close(pipe_ends[1]);
}

TEST_F(DashboardServer, APortInUseIsNamedInOneLine) {
  start();
  Server::Options same = options_;
  same.port = port();
  try {
    const Server another{same};
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "127.0.0.1:" + std::to_string(port()) + ": cannot listen: Address already in use");
  }
  EXPECT_EQ(got("/").status, 200);
}

}  // namespace
}  // namespace deltamap::daemon::dashboard
