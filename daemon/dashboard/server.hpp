// SPDX-License-Identifier: Apache-2.0
// HTTP and WebSocket for the live page, in a thread of its own. Everything is bounded: connections, viewers, headers,
// incoming messages, what waits for a viewer, and time. A viewer that is slow, malformed or gone does not affect the
// others. Whoever comes is heard, however many are there (places.hpp): it may be somebody who wants to stop the robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "daemon/dashboard/access.hpp"
#include "daemon/dashboard/request.hpp"

namespace deltamap::daemon::dashboard {

class Server {
 public:
  /// All functions are called in the server's thread.
  struct Options {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;  ///< 0: any that is free
    int descriptor = -1;     ///< of a socket that listens already, in place of address and port; -1: none
    Guard guard{};
    std::function<Answer(const Request&)> answer;          ///< to a request that may be answered
    std::function<std::unique_ptr<Stream>()> open;         ///< for a viewer at /live that has come
    std::function<void(const Request&, Reply)> command{};  ///< a POST that may be answered; its body has come
    std::function<std::unique_ptr<Dialog>()> converse{};   ///< for somebody at /drive who has come
    /// Whether a command's body is the STOP: it needs no token where reading needs none, and is never one too many.
    std::function<bool(const std::string& body)> is_stop = [](const std::string&) { return false; };
    Answer busy_answer{.status = 503, .body = "too many commands wait already\n"};  ///< to another command
    Answer late_answer{.status = 504, .body = "not answered yet\n"};                ///< to a command
    double command_patience_s = 3.0;                                                ///< so long
    std::function<void()> refresh = [] {};            ///< every period, before viewers are served
    std::function<void(bool)> watched = [](bool) {};  ///< the first viewer has come, the last one has gone
    double period_s = 0.1;                            ///< nothing runs where nobody views
    double time_to_speak_s = 0.3;                     ///< of who has just come: a lost packet comes again after 0.2 s
    double patience_s = 10.0;                         ///< a viewer takes a message within that time, or is dropped
    std::size_t most_connections = 96;                ///< viewers among them; less where there are few descriptors
    std::size_t most_from_one = 64;                   ///< address
    std::size_t most_viewers = 32;
  };
  /// Listens from now on. Throws std::runtime_error with one line that names address and port: taken, or beyond this
  /// machine without a token.
  explicit Server(Options options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// What it listens on.
  [[nodiscard]] std::uint16_t port() const;
  /// "127.0.0.1:8484", "[::1]:8484"
  [[nodiscard]] std::string place() const;
  /// The thread's work, until stop().
  void run();
  /// Any thread: every connection ends at once.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::daemon::dashboard
