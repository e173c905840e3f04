// SPDX-License-Identifier: Apache-2.0
// What every output of the running daemon does when the disk is full, read-only or gone: saving pauses with one
// warning, is tried again with back-off (1 s, 2 s, 4 s, then every 8 s), and goes on with one line. What is to be
// written in the meantime is the owner's affair.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "daemon/telemetry/output_board.hpp"

namespace deltamap::daemon {

class RetryingOutput {
 public:
  using Warn = std::function<void(const std::string&)>;  ///< a short line

  RetryingOutput(std::string name, const std::filesystem::path& file, OutputBoard& board, Warn warn);

  /// Writes where the output works or an attempt is due. False where it was not tried, or `write` threw.
  bool attempt(Timestamp now, const std::function<void()>& write);
  /// The next attempt is due at once: at the end of a run.
  void hurry() { next_attempt_ = Timestamp{}; }
  /// It has failed elsewhere: for instance it could not be opened.
  void fail(Timestamp now, const std::string& why);
  /// Ends, and that is no failure.
  void end(Timestamp now, const std::string& why);
  /// What has ended is wanted again.
  void begin_again();
  /// Something was thrown away while it did not work.
  void count_lost(std::uint64_t count = 1);

  /// Empty where it works.
  [[nodiscard]] const std::string& why() const { return status_.why; }
  [[nodiscard]] bool works() const { return status_.written; }
  [[nodiscard]] std::uint64_t lost() const { return status_.lost; }

 private:
  OutputStatus status_;
  OutputBoard& board_;
  Warn warn_;
  Duration pause_{};
  Timestamp next_attempt_;
  bool ended_ = false;
};

}  // namespace deltamap::daemon
