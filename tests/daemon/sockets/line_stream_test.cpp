// SPDX-License-Identifier: Apache-2.0
// One stream of lines and its clients: some read, some stall, some say something, some go away.
#include "daemon/sockets/line_stream.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/support/daemon/socket_client.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon::sockets {
namespace {

namespace fs = std::filesystem;
using test::SocketClient;

class LineStreamTest : public testing::Test {
 protected:
  void TearDown() override { end(); }

  [[nodiscard]] LineStream::Options options() {
    return {.socket = socket(), .greeting = "hello", .refusal = "no", .next = [this] { return taken(); }};
  }
  void begin() { begin(options()); }
  void begin(LineStream::Options options) {
    stream_.emplace(std::move(options));
    thread_ = std::jthread{[this] { stream_->run(); }};
  }
  void end() {
    if (!stream_) return;
    stream_->stop();
    thread_.join();
    stream_.reset();
  }
  void say(const std::string& text) { say(LineStream::Line{.text = text}); }
  void say(const LineStream::Line& line) {
    {
      const std::scoped_lock lock{mutex_};
      lines_.push_back(line);
    }
    stream_->wake();
  }
  [[nodiscard]] std::string refusal_at(const fs::path& path) {
    LineStream::Options elsewhere = options();
    elsewhere.socket = path;
    try {
      const LineStream stream{std::move(elsewhere)};
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] fs::path socket() const { return folder_.path() / "poses.sock"; }

  test::TemporaryFolder folder_;
  std::optional<LineStream> stream_;

 private:
  std::optional<LineStream::Line> taken() {
    const std::scoped_lock lock{mutex_};
    if (lines_.empty()) return std::nullopt;
    LineStream::Line line = lines_.front();
    lines_.pop_front();
    return line;
  }

  std::mutex mutex_;
  std::deque<LineStream::Line> lines_;
  std::jthread thread_;
};

TEST_F(LineStreamTest, EachClientIsGreetedAndGetsEveryLineFromThenOn) {
  begin();
  EXPECT_FALSE(stream_->has_clients());
  SocketClient one{socket()};
  EXPECT_EQ(one.line(), "hello");
  EXPECT_TRUE(stream_->has_clients());
  say("a");
  EXPECT_EQ(one.line(), "a");
  SocketClient other{socket()};
  EXPECT_EQ(other.line(), "hello");
  say("b");
  say("c");
  for (SocketClient* client : {&one, &other}) {
    EXPECT_EQ(client->line(), "b");
    EXPECT_EQ(client->line(), "c");
  }
}

TEST_F(LineStreamTest, AClientThatDoesNotReadIsDisconnectedAndTheOthersMissNothing) {
  constexpr int kLines = 1000;
  constexpr int kMostBehind = 100;  // what queue and kernel hold of such lines, with room to spare
  begin();
  SocketClient stalls{socket()};
  SocketClient reads{socket()};
  EXPECT_EQ(reads.line(), "hello");
  const std::string line(600, 'x');
  for (int i = 0; i < kLines; ++i) {
    say(line + std::to_string(i));
    ASSERT_EQ(reads.line(), line + std::to_string(i));
  }
  EXPECT_EQ(stalls.line(), "hello");
  int behind = 0;
  for (std::string got = stalls.line(); got.size() > line.size(); got = stalls.line()) {
    EXPECT_EQ(got, line + std::to_string(behind++)) << "what does come has no gap";
  }
  EXPECT_GT(behind, 0);
  EXPECT_LT(behind, kMostBehind);
  EXPECT_FALSE(stalls.send("still there?"));
}

TEST_F(LineStreamTest, AClientThatSaysSomethingIsDisconnected) {
  begin();
  SocketClient chatty{socket()};
  EXPECT_EQ(chatty.line(), "hello");
  EXPECT_TRUE(chatty.send("{\"command\":\"status\"}\n"));
  EXPECT_EQ(chatty.line(), "");
}

TEST_F(LineStreamTest, AClientGetsTheKindsThatItAsksForAndOthersGetWhatTheyAlwaysGot) {
  LineStream::Options asked = options();
  asked.hear = [](const std::string& line) -> LineStream::Wish {
    return line == "second" ? LineStream::Wish{2, "yes"} : LineStream::Wish{0, "what?"};
  };
  begin(std::move(asked));
  SocketClient silent{socket()};
  SocketClient asks{socket()};
  SocketClient mumbles{socket()};
  for (SocketClient* client : {&silent, &asks, &mumbles}) EXPECT_EQ(client->line(), "hello");
  EXPECT_EQ(mumbles.asked("hm"), "what?");
  EXPECT_EQ(mumbles.line(), "") << "that was its last line";
  EXPECT_TRUE(asks.send("sec"));
  EXPECT_EQ(asks.asked("ond"), "yes") << "a line may come in pieces";
  say(LineStream::Line{.text = "a", .kind = 1});
  say(LineStream::Line{.text = "b", .kind = 2});
  say(LineStream::Line{.text = "c", .kind = 1});
  EXPECT_EQ(silent.line(), "a");
  EXPECT_EQ(silent.line(), "c");
  EXPECT_EQ(asks.line(), "b");
  SocketClient endless{socket()};
  EXPECT_EQ(endless.line(), "hello");
  EXPECT_TRUE(endless.send(std::string(2000, 'x')));
  EXPECT_EQ(endless.line(), "") << "a line that never ends";
}

TEST_F(LineStreamTest, ABurstOfWhatIsNotSoonOldWaitsForASlowClientAndThenItIsDroppedAndTold) {
  std::atomic<int> dropped = 0;
  LineStream::Options asked = options();
  asked.first_kinds = 3;
  asked.dropped = [&] { ++dropped; };
  begin(std::move(asked));
  SocketClient stalls{socket()};
  EXPECT_EQ(stalls.line(), "hello");
  const std::string line(600, 'x');
  for (int i = 0; i < 400; ++i)
    say(LineStream::Line{.text = line + std::to_string(i), .kind = 2, .is_soon_old = false});
  for (int i = 0; i < 400; ++i) ASSERT_EQ(stalls.line(), line + std::to_string(i));
  EXPECT_EQ(dropped, 0);
  for (int i = 0; i < 2000; ++i) say(LineStream::Line{.text = line, .kind = 2, .is_soon_old = false});
  while (dropped == 0) std::this_thread::yield();
  int got = 0;
  while (stalls.line() == line) ++got;
  EXPECT_LT(got, 2000);
}

TEST_F(LineStreamTest, AClientThatOnlyHasNothingToSayStillListens) {
  begin();
  SocketClient silent{socket()};
  silent.say_no_more();
  EXPECT_EQ(silent.line(), "hello");
  say("a");
  EXPECT_EQ(silent.line(), "a");
}

TEST_F(LineStreamTest, AClientTooManyIsToldSoAndThePlacesOfThoseWhoLeftComeFree) {
  begin();
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (int i = 0; i < 16; ++i) {
    clients.push_back(std::make_unique<SocketClient>(socket()));
    if (i % 2 == 0) clients.back()->say_no_more();
    ASSERT_EQ(clients.back()->line(), "hello");
  }
  SocketClient late{socket()};
  EXPECT_EQ(late.line(), "no");
  EXPECT_EQ(late.line(), "");
  clients.clear();
  EXPECT_EQ(SocketClient{socket()}.line(), "hello") << "nothing was said in between";
}

TEST_F(LineStreamTest, TheLastClientThatLeavesIsNoticedWithoutALine) {
  begin();
  SocketClient leaves{socket()};
  EXPECT_EQ(leaves.line(), "hello");
  leaves.vanish();
  const auto give_up_at = std::chrono::steady_clock::now() + std::chrono::seconds{120};
  while (stream_->has_clients() && std::chrono::steady_clock::now() < give_up_at) std::this_thread::yield();
  EXPECT_FALSE(stream_->has_clients());
}

TEST_F(LineStreamTest, TheSocketIsForOwnerAndGroupAndGoneAtTheEnd) {
  const mode_t before = ::umask(0077);
  begin();
  ::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat(socket().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0660u);
  SocketClient client{socket()};
  EXPECT_EQ(client.line(), "hello");
  end();
  EXPECT_EQ(client.line(), "");
  EXPECT_FALSE(fs::exists(socket()));
}

TEST_F(LineStreamTest, WhatACrashLeftIsReplacedAndNothingElse) {
  test::leave_socket_behind(socket());
  begin();
  EXPECT_EQ(SocketClient{socket()}.line(), "hello");
  LineStream::Options same = options();
  EXPECT_THROW(LineStream{std::move(same)}, AlreadyServed);
  const fs::path file = folder_.write("precious", "precious");
  EXPECT_EQ(refusal_at(file), file.string() + ": cannot listen: a file that is no socket is in the way");
  EXPECT_EQ(fs::file_size(file), 8u);
  const fs::path nowhere = folder_.path() / "missing/poses.sock";
  EXPECT_EQ(refusal_at(nowhere), nowhere.string() + ": cannot listen: No such file or directory");
}

}  // namespace
}  // namespace deltamap::daemon::sockets
