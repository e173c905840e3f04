// SPDX-License-Identifier: Apache-2.0
// A Unix domain stream socket whose clients all get the same lines, in a thread of its own. Whoever makes the lines
// never waits for a client: one that reads too slowly, says something or is gone is disconnected.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/sockets/already_served.hpp"

namespace deltamap::daemon::sockets {

class LineStream {
 public:
  /// Lines come and go without their line end.
  struct Options {
    std::filesystem::path socket;  ///< readable and writable by owner and group; what a crash left there is replaced
    std::string greeting;          ///< the first line of each client
    std::string refusal;           ///< the only line of one client too many
    /// In the stream's thread, after wake(): called until it answers nothing.
    std::function<std::optional<std::string>()> next;
    std::size_t most_clients = 16;
    std::size_t most_lines = 16;       ///< that wait for a client; one more disconnects it
    int send_buffer_bytes = 8 * 1024;  ///< of the kernel, for each client: what is old is of no use
  };
  /// Listens from now on. Throws AlreadyServed, or std::runtime_error with one line that names the path.
  explicit LineStream(Options options);
  /// The socket's file is gone then.
  ~LineStream();
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;

  /// Any thread, never waits: whether a line would reach anybody.
  [[nodiscard]] bool has_clients() const;
  /// Any thread, never waits: there are lines.
  void wake();

  /// The thread's work, until stop().
  void run();
  /// Any thread.
  void stop();
  /// Any thread: done in the stream's thread.
  void post(std::function<void()> work);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::daemon::sockets
