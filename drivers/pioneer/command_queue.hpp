// SPDX-License-Identifier: Apache-2.0
// Commands on their way to the robot, at the pace that it can take: it loses commands that follow one another by less
// than 3 to 5 ms (protocols.md A1).
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "drivers/pioneer/command.hpp"

namespace deltamap::drivers::pioneer {

class CommandQueue {
 public:
  void push(const Command& command) { waiting_.push_back(command); }
  void clear() { waiting_.clear(); }
  /// Takes back what was not yet handed out of one kind.
  void drop(CommandNumber number);
  [[nodiscard]] bool is_empty() const { return waiting_.empty(); }

  /// The frame that may be written now, if any.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> take_due(Timestamp now, unsigned baud);
  /// When the next frame may be written; nullopt where none waits.
  [[nodiscard]] std::optional<Timestamp> next_due() const;
  /// When the last frame was handed out.
  [[nodiscard]] std::optional<Timestamp> last_sent() const { return last_sent_; }

 private:
  std::deque<Command> waiting_;
  Timestamp free_at_ = Timestamp::min();
  std::optional<Timestamp> last_sent_;
};

}  // namespace deltamap::drivers::pioneer
