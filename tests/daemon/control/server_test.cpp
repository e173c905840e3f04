// SPDX-License-Identifier: Apache-2.0
// The control socket with real clients: polite ones, rude ones, and some that go away.
#include "daemon/control/server.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <future>
#include <optional>
#include <thread>
#include <vector>

#include "daemon/control/client.hpp"
#include "daemon/control/request.hpp"
#include "tests/support/daemon/socket_client.hpp"
#include "tests/support/files/no_descriptors.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon::control {
namespace {

namespace fs = std::filesystem;
using test::SocketClient;

constexpr std::size_t kMost = 64;  // clients
const std::string kStop = R"({"command":"drive","mode":"off"})";

class ServerTest : public testing::Test {
 protected:
  void TearDown() override { end(); }

  void serve(Server::Handler handle, double patience_s = 60.0) {
    server_.emplace(Server::Options{socket(), std::move(handle), "too late", patience_s});
    thread_ = std::jthread{[this] { server_->run(); }};
  }
  void serve_echo() {
    serve([](const std::string& line, bool, const Server::Reply& reply) { reply("re: " + line); });
  }
  void end() {
    if (!server_) return;
    server_->stop();
    thread_.join();
    server_.reset();
  }
  [[nodiscard]] fs::path socket() const { return folder_.path() / "ctl.sock"; }

  test::TemporaryFolder folder_;
  std::optional<Server> server_;
  std::jthread thread_;
};

TEST_F(ServerTest, EachOfSeveralClientsGetsItsOwnReplies) {
  serve_echo();
  SocketClient one{socket()};
  SocketClient other{socket()};
  EXPECT_TRUE(one.send("a\nb\n"));
  EXPECT_EQ(other.asked("c"), "re: c");
  EXPECT_EQ(one.line(), "re: a");
  EXPECT_EQ(one.line(), "re: b");
  EXPECT_EQ(exchange(socket(), "d"), "re: d");
}

TEST_F(ServerTest, TellsWhetherTheSenderStillWaits) {
  std::promise<void> may_look;
  std::vector<std::pair<std::string, bool>> asked;
  std::promise<void> done;
  serve([&](const std::string& line, bool sender_is_gone, const Server::Reply& reply) {
    if (line == "hold") may_look.get_future().wait();
    asked.emplace_back(line, sender_is_gone);
    reply("");
    if (asked.size() == 3) done.set_value();
  });
  SocketClient holds{socket()};
  SocketClient waits{socket()};
  {
    SocketClient leaves{socket()};
    EXPECT_TRUE(holds.send("hold\n"));
    EXPECT_TRUE(leaves.send("left\n"));
  }
  EXPECT_TRUE(waits.send("last\n"));
  may_look.set_value();
  done.get_future().wait();
  end();
  for (const auto& [line, sender_is_gone] : asked) EXPECT_EQ(sender_is_gone, line == "left") << line;
}

TEST_F(ServerTest, ARequestMayComeInPieces) {
  serve_echo();
  SocketClient client{socket()};
  for (const char* piece : {"sta", "t", "us", "\n"}) EXPECT_TRUE(client.send(piece));
  EXPECT_EQ(client.line(), "re: status");
}

TEST_F(ServerTest, AClientThatVanishesBeforeItsReplyHarmsNobody) {
  std::promise<Server::Reply> asked;
  serve([&](const std::string& line, bool, const Server::Reply& reply) {
    line == "slow" ? asked.set_value(reply) : reply("re: " + line);
  });
  SocketClient gone{socket()};
  EXPECT_TRUE(gone.send("slow\n"));
  const Server::Reply reply = asked.get_future().get();
  gone.vanish();
  reply("nobody hears this");
  SocketClient half{socket()};
  EXPECT_TRUE(half.send("half a requ"));
  half.vanish();
  EXPECT_EQ(exchange(socket(), "still there?"), "re: still there?");
}

TEST_F(ServerTest, AReplyMayComeLaterFromAnotherThreadAndOnlyTheFirstCounts) {
  std::promise<Server::Reply> asked;
  serve([&](const std::string& line, bool, const Server::Reply& reply) {
    line == "slow" ? asked.set_value(reply) : reply("re: " + line);
  });
  SocketClient client{socket()};
  EXPECT_TRUE(client.send("slow\n"));
  const Server::Reply reply = asked.get_future().get();
  reply("first");
  reply("second");
  EXPECT_EQ(client.line(), "first");
  EXPECT_EQ(client.asked("next"), "re: next");
}

TEST_F(ServerTest, WhereNoReplyComesTheClientIsToldSo) {
  std::vector<Server::Reply> kept;
  serve([&](const std::string&, bool, Server::Reply reply) { kept.push_back(std::move(reply)); }, 0.05);
  SocketClient client{socket()};
  EXPECT_EQ(client.asked("slow"), "too late");
}

TEST_F(ServerTest, AnOverlongLineIsAnErrorAndTheEndOfThatClientOnly) {
  serve_echo();
  SocketClient client{socket()};
  (void)client.send(std::string(100'000, 'x'));
  EXPECT_EQ(client.line(), error_line("a request has at most 4096 bytes"));
  EXPECT_EQ(client.line(), "");
  EXPECT_EQ(exchange(socket(), std::string(kLongestLine - 1, 'y')), "re: " + std::string(kLongestLine - 1, 'y'));
}

TEST_F(ServerTest, AClientTooManyIsToldSoAndPlacesComeFree) {
  std::vector<Server::Reply> waiting;
  std::promise<void> all_wait;
  serve([&](const std::string& line, bool, const Server::Reply& reply) {
    if (line == "now") return reply("re: now");
    if (line == kStop) return reply("stands");
    waiting.push_back(reply);
    if (waiting.size() == kMost) all_wait.set_value();
  });
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (std::size_t i = 0; i < kMost; ++i) {
    clients.push_back(std::make_unique<SocketClient>(socket()));
    ASSERT_TRUE(clients.back()->send("hello\n"));
  }
  all_wait.get_future().wait();
  SocketClient late{socket()};
  EXPECT_EQ(late.asked("now"), error_line("too many clients"));
  EXPECT_EQ(late.line(), "");
  for (int i = 0; i < 100; ++i) {
    const SocketClient says_nothing{socket()};
    ASSERT_EQ(exchange(socket(), kStop), "stands") << "an order to stop is never one too many";
  }
  for (const Server::Reply& reply : waiting) reply("at last");
  for (const auto& client : clients) EXPECT_EQ(client->line(), "at last");
  EXPECT_EQ(SocketClient{socket()}.asked("now"), "re: now");
}

TEST_F(ServerTest, ClientsThatSayNothingKeepNobodyOut) {
  serve_echo();
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (std::size_t i = 0; i < kMost; ++i) {
    clients.push_back(std::make_unique<SocketClient>(socket()));
    ASSERT_EQ(clients.back()->asked("hello"), "re: hello");
  }
  ASSERT_EQ(clients.front()->asked("still here"), "re: still here");
  EXPECT_EQ(SocketClient{socket()}.asked("drive off"), "re: drive off");
  EXPECT_EQ(clients[1]->line(), "") << "it had been silent longest";
  EXPECT_EQ(clients.front()->asked("and here"), "re: and here");
}

TEST_F(ServerTest, AnOrderToStopIsDoneBeforeLinesThatWaitAndRepliesKeepTheirOrder) {
  std::promise<Server::Reply> slow;
  std::promise<void> stopped;
  std::vector<std::string> done;
  serve([&](const std::string& line, bool, const Server::Reply& reply) {
    done.push_back(line);
    if (line == "slow") return slow.set_value(reply);
    reply("re: " + line);
    if (line == kStop) stopped.set_value();
  });
  SocketClient client{socket()};
  EXPECT_TRUE(client.send("slow\nnext\n" + kStop + "\nlast\n"));
  stopped.get_future().wait();
  slow.get_future().get()("at last");
  EXPECT_EQ(client.line(), "at last");
  EXPECT_EQ(client.line(), "re: next");
  EXPECT_EQ(client.line(), "re: " + kStop);
  EXPECT_EQ(client.line(), "re: last");
  end();
  EXPECT_EQ(done, (std::vector<std::string>{"slow", kStop, "next", "last"}));
}

TEST_F(ServerTest, WhoSaysNoMoreStillHearsEveryReply) {
  std::promise<Server::Reply> slow;
  serve([&](const std::string& line, bool, const Server::Reply& reply) {
    line == "slow" ? slow.set_value(reply) : reply("re: " + line);
  });
  SocketClient client{socket()};
  EXPECT_TRUE(client.send("slow\nnext\n"));
  client.say_no_more();
  const Server::Reply reply = slow.get_future().get();
  EXPECT_EQ(exchange(socket(), "another"), "re: another");
  reply("at last");
  EXPECT_EQ(client.line(), "at last");
  EXPECT_EQ(client.line(), "re: next");
  EXPECT_EQ(client.line(), "") << "and is let go";
}

TEST_F(ServerTest, WhoHasJustComeIsHeardWhereAllOthersWaitForTheirReplies) {
  std::vector<Server::Reply> waiting;
  std::promise<void> all_wait;
  serve([&](const std::string& line, bool, const Server::Reply& reply) {
    if (line == kStop) return reply("stands");
    waiting.push_back(reply);
    if (waiting.size() == kMost) all_wait.set_value();
  });
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (std::size_t i = 0; i < kMost; ++i) {
    clients.push_back(std::make_unique<SocketClient>(socket()));
    ASSERT_TRUE(clients.back()->send("hello\n"));
  }
  all_wait.get_future().wait();
  for (int round = 0; round < 20; ++round) {
    SocketClient stops{socket()};
    for (int i = 0; i < 10; ++i) clients.push_back(std::make_unique<SocketClient>(socket()));
    ASSERT_EQ(exchange(socket(), kStop), "stands") << "those before it have come in";
    EXPECT_EQ(stops.asked(kStop), "stands") << round;
  }
}

TEST_F(ServerTest, WhoReadsNoRepliesIsNotReadForEver) {
  std::size_t asked = 0;
  serve([&](const std::string& line, bool, const Server::Reply& reply) {
    ++asked;
    reply(line == "count" ? std::to_string(asked) : std::string(100'000, 'x'));
  });
  SocketClient client{socket()};
  std::string lines;
  for (int i = 0; i < 1000; ++i) lines += "status\n";
  EXPECT_TRUE(client.send(lines));
  EXPECT_EQ(exchange(socket(), "hello").size(), 100'000u);
  EXPECT_LT(std::stoul(exchange(socket(), "count")), 500u);
}

TEST_F(ServerTest, AnOrderGetsThroughWhereTheProcessCanOpenNothingMore) {
  serve_echo();
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (int i = 0; i < 10; ++i) clients.push_back(std::make_unique<SocketClient>());
  test::NoDescriptors none_left;
  for (std::size_t i = 0; i + 1 < clients.size(); i += 2) {
    clients[i]->connect(socket());
    ASSERT_EQ(clients[i]->asked("hello"), "re: hello");
    (void)none_left.take();
    clients[i + 1]->connect(socket());
    EXPECT_EQ(clients[i + 1]->asked(kStop), "re: " + kStop) << i;
  }
}

TEST_F(ServerTest, TheSocketOfADaemonThatFollowsIsLeftAlone) {
  serve_echo();
  server_->stop();
  thread_.join();
  ASSERT_FALSE(fs::exists(socket())) << "gone before the server is";
  Server next{Server::Options{socket(), [](const std::string&, bool, const Server::Reply&) {}, "too late", 60.0}};
  server_.reset();
  EXPECT_TRUE(fs::exists(socket()));
}

TEST_F(ServerTest, TheSocketIsForOwnerAndGroupAndGoneAtTheEnd) {
  const mode_t before = ::umask(0077);
  serve_echo();
  ::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat(socket().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0660u);
  end();
  EXPECT_FALSE(fs::exists(socket()));
}

TEST_F(ServerTest, WhatACrashLeftBehindIsReplaced) {
  test::leave_socket_behind(socket());
  ASSERT_TRUE(fs::exists(socket()));
  serve_echo();
  EXPECT_EQ(exchange(socket(), "alive"), "re: alive");
}

TEST_F(ServerTest, ALiveDaemonIsNotReplaced) {
  serve_echo();
  try {
    const Server second{{socket(), [](const std::string&, bool, const Server::Reply&) {}, ""}};
    FAIL() << "must refuse";
  } catch (const sockets::AlreadyServed& error) {
    EXPECT_EQ(error.what(), socket().string() + ": another daemon listens there");
  }
  EXPECT_EQ(exchange(socket(), "mine"), "re: mine");
}

TEST_F(ServerTest, AFileOfSomebodyElseIsLeftAlone) {
  (void)folder_.write("ctl.sock", "precious");
  const auto refusal_at = [](const fs::path& path) -> std::string {
    try {
      const Server server{{path, [](const std::string&, bool, const Server::Reply&) {}, ""}};
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal_at(socket()), socket().string() + ": cannot listen: a file that is no socket is in the way");
  EXPECT_EQ(fs::file_size(socket()), 8u);
  const fs::path nowhere = folder_.path() / "missing/ctl.sock";
  EXPECT_EQ(refusal_at(nowhere), nowhere.string() + ": cannot listen: No such file or directory");
  const fs::path endless = folder_.path() / std::string(200, 'n');
  EXPECT_TRUE(refusal_at(endless).starts_with(endless.string() + ": cannot listen: ")) << refusal_at(endless);
}

TEST_F(ServerTest, AClientWithoutADaemonIsToldInOneLine) {
  try {
    (void)exchange(socket(), "status");
    FAIL() << "nobody listens";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), socket().string() + ": no daemon listens there (No such file or directory)");
  }
}

}  // namespace
}  // namespace deltamap::daemon::control
