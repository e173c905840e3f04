// SPDX-License-Identifier: Apache-2.0
// Commands on their way to the robot, at the pace that it can take: it loses commands that follow one another by less
// than 3 to 5 ms (protocols.md A1).
#pragma once

#include <deque>
#include <optional>

#include "core/time.hpp"
#include "drivers/pioneer/command.hpp"

namespace deltamap::drivers::pioneer {

class CommandQueue {
 public:
  void push(const Command& command) { waiting_.push_back(command); }
  /// Before all that waits: a stop is not kept waiting by anything.
  void push_first(const Command& command) { waiting_.push_front(command); }
  void clear() { waiting_.clear(); }
  /// Nothing waits any more but ESTOP, VEL 0 and RVEL 0.
  void push_only_stop();
  /// VEL and RVEL before all that waits, in place of those that wait.
  void push_set_points(int mm_per_s, int degrees_per_s);
  /// Takes back what was not yet handed out of one kind.
  void drop(CommandNumber number);
  [[nodiscard]] bool is_empty() const { return waiting_.empty(); }

  /// The command that may be written now, if any.
  [[nodiscard]] std::optional<Command> take_due(Timestamp now, unsigned baud);
  /// Bytes that are no command go out now: what waits comes after them, at the same distance.
  void hold_for(std::size_t size, Timestamp now, unsigned baud);
  /// When the next command may be written; nullopt where none waits.
  [[nodiscard]] std::optional<Timestamp> next_due() const;
  /// When the last command was handed out.
  [[nodiscard]] std::optional<Timestamp> last_sent() const { return last_sent_; }

 private:
  std::deque<Command> waiting_;
  Timestamp free_at_ = Timestamp::min();
  std::optional<Timestamp> last_sent_;
};

}  // namespace deltamap::drivers::pioneer
