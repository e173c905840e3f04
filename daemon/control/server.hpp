// SPDX-License-Identifier: Apache-2.0
// The control socket: a Unix domain stream socket that takes lines and sends a line back for each, in a thread of its
// own. A client that is silent, slow, rude or gone troubles nobody else, and however many there are, `drive off` is
// heard.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "daemon/sockets/already_served.hpp"

namespace deltamap::daemon::control {

class Server {
 public:
  /// Any thread, now or later; the first one counts.
  using Reply = std::function<void(std::string)>;
  /// In the server's thread. `line` comes and goes without its line end. `sender_is_gone`: nobody waits for the reply
  /// any more, the request may be old.
  using Handler = std::function<void(const std::string& line, bool sender_is_gone, Reply reply)>;

  struct Options {
    std::filesystem::path socket;  ///< readable and writable by owner and group; what a crash left there is replaced
    Handler handle;
    std::string late_reply;   ///< what a client hears where no reply has come after
    double patience_s = 2.0;  ///< so long
  };
  /// Listens from now on. Throws AlreadyServed, or std::runtime_error with one line that names the path.
  explicit Server(Options options);
  /// The socket's file is gone then.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// The thread's work, until stop().
  void run();
  /// Any thread.
  void stop();
  /// Any thread: done in the server's thread.
  void post(std::function<void()> work);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::daemon::control
