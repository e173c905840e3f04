// SPDX-License-Identifier: Apache-2.0
// A Unix domain stream socket whose clients get lines, in a thread of its own: all the same, or those of the kinds that
// they have asked for. Whoever makes the lines never waits for a client: one that reads too slowly, says what nobody
// understands or is gone is disconnected.
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
  struct Line {
    std::string text;
    unsigned kind = 1;        ///< one bit
    bool is_soon_old = true;  ///< of no use to who is far behind
  };
  /// What comes of something that a client has said.
  struct Wish {
    unsigned kinds = 0;  ///< of all lines from now on; 0: that is the client's last line
    std::string reply;
  };
  struct Options {
    std::filesystem::path socket;  ///< readable and writable by owner and group; what a crash left there is replaced
    std::string greeting;          ///< the first line of each client
    std::string refusal;           ///< the only line of one client too many
    /// In the stream's thread, after wake(): called until it answers nothing.
    std::function<std::optional<Line>()> next;
    std::function<Wish(const std::string&)> hear{};  ///< in the stream's thread; empty: who says something must leave
    unsigned first_kinds = 1;                        ///< of who has said nothing
    std::function<void()> dropped = [] {};           ///< in the stream's thread: a client read too slowly
    std::size_t most_clients = 16;
    std::size_t most_lines = 16;       ///< that are soon old and wait for a client; one more disconnects it
    std::size_t most_others = 512;     ///< other lines: they come in bursts
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
