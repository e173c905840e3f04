// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/live_stream.hpp"

#include <array>
#include <utility>

#include "daemon/dashboard/cells.hpp"
#include "daemon/live/live_messages.hpp"

namespace deltamap::daemon {
namespace {

using dashboard::Message;

constexpr std::size_t kSamplesAtOnce = 400;
constexpr std::size_t kChangesAtOnce = 50;
constexpr std::size_t kMostDue = 1024;  // changed pieces of the map that wait; with more, the whole map is sent

Message message_of(std::string bytes, bool is_binary) {
  return {.is_binary = is_binary, .bytes = std::make_shared<const std::string>(std::move(bytes))};
}

}  // namespace

void SharedMessage::set(std::string bytes, bool is_binary) {
  ++number;
  message = message_of(std::move(bytes), is_binary);
}

std::optional<Message> LiveStream::next() {
  const std::array<std::pair<const SharedMessage*, std::uint64_t*>, 8> shared{{{&news_.hello, &hello_},
                                                                               {&news_.run, &run_},
                                                                               {&news_.pose, &pose_},
                                                                               {&news_.scan, &scan_},
                                                                               {&news_.particles, &particles_},
                                                                               {&news_.stored, &stored_},
                                                                               {&news_.status, &status_},
                                                                               {&news_.transient, &transient_}}};
  for (const auto& [newest, sent] : shared) {
    if (newest->number == *sent) continue;
    *sent = newest->number;
    return newest->message;
  }
  if (auto message = next_of_map()) return message;
  return next_past();
}

std::optional<Message> LiveStream::next_past() {
  if (const auto past = board_.changes_from(changes_, kChangesAtOnce); !past.items.empty()) {
    changes_ = past.next();
    return message_of(changes_message(past, board_.change_counts()), false);
  }
  if (const auto past = board_.samples_from(samples_, kSamplesAtOnce); !past.items.empty()) {
    samples_ = past.next();
    return message_of(samples_message(past), true);
  }
  return std::nullopt;
}

std::optional<Message> LiveStream::next_of_map() {
  const LiveBoard::Map map = board_.map(boxes_);
  if (!frame_ || !(*frame_ == map.grid->geometry())) {
    frame_ = map.grid->geometry();
    boxes_ = map.changed.next();
    mark_all(*map.grid);
    return message_of(map_message(*frame_, map.revision), false);
  }
  mark(map);
  if (due_.empty()) return std::nullopt;
  const CellBox box = due_.front();
  due_.pop_front();
  return message_of(dashboard::cells_message(*map.grid, box, map.revision), true);
}

void LiveStream::mark(const LiveBoard::Map& map) {
  bool has_missed = map.changed.first > boxes_;
  boxes_ = map.changed.next();
  for (const CellBox& box : map.changed.items) {
    const auto pieces = dashboard::pieces_of(box);
    due_.insert(due_.end(), pieces.begin(), pieces.end());
    has_missed = has_missed || due_.size() > kMostDue;
  }
  if (has_missed) mark_all(*map.grid);
}

void LiveStream::mark_all(const OccupancyGrid& map) {
  const auto pieces = dashboard::pieces_of(known_box(map));
  due_.assign(pieces.begin(), pieces.end());
}

}  // namespace deltamap::daemon
