// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/command_queue.hpp"

#include <algorithm>
#include <utility>

#include "drivers/received_bytes.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr Duration kGap{5'000'000};

}  // namespace

std::optional<Command> CommandQueue::take_due(Timestamp now, unsigned baud) {
  if (waiting_.empty() || now < free_at_) return std::nullopt;
  Command command = std::move(waiting_.front());
  waiting_.pop_front();
  free_at_ = now + line_time(encoded_command(command).size(), baud) + kGap;
  last_sent_ = now;
  return command;
}

void CommandQueue::push_only_stop() {
  clear();
  push({CommandNumber::kEstop, {}});
  push({CommandNumber::kVel, 0});
  push({CommandNumber::kRvel, 0});
}

void CommandQueue::push_set_points(int mm_per_s, int degrees_per_s) {
  drop(CommandNumber::kVel);
  drop(CommandNumber::kRvel);
  push_first({CommandNumber::kRvel, degrees_per_s});
  push_first({CommandNumber::kVel, mm_per_s});
}

void CommandQueue::hold_for(std::size_t size, Timestamp now, unsigned baud) {
  free_at_ = std::max(free_at_, now) + line_time(size, baud) + kGap;
}

void CommandQueue::drop(CommandNumber number) {
  std::erase_if(waiting_, [number](const Command& command) { return command.number == number; });
}

std::optional<Timestamp> CommandQueue::next_due() const {
  if (waiting_.empty()) return std::nullopt;
  return free_at_;
}

}  // namespace deltamap::drivers::pioneer
