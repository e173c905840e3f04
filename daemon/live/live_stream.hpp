// SPDX-License-Identifier: Apache-2.0
// What one viewer of the live page is sent. Poses, scans and states are replaced by newer ones before they are sent; of
// the map, boxes that have changed are marked, and cut out of the newest map when their turn comes. Page thread.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "daemon/dashboard/request.hpp"
#include "daemon/live/live_board.hpp"

namespace deltamap::daemon {

/// A message that all viewers share, and its number: each viewer is sent a number once.
struct SharedMessage {
  std::uint64_t number = 0;  ///< 0: there is none yet
  dashboard::Message message{};
  void set(std::string bytes, bool is_binary = false);
};

/// What changes while there are viewers. The desk refreshes it; it outlives the streams.
struct LiveNews {
  SharedMessage hello, run, pose, scan, particles, stored, transient, status;  // run: of a run that is over
};

class LiveStream final : public dashboard::Stream {
 public:
  LiveStream(const LiveNews& news, const LiveBoard& board) : news_{news}, board_{board} {}
  [[nodiscard]] std::optional<dashboard::Message> next() override;

 private:
  [[nodiscard]] std::optional<dashboard::Message> next_past();
  [[nodiscard]] std::optional<dashboard::Message> next_of_map();
  void mark(const LiveBoard::Map& map);
  void mark_all(const OccupancyGrid& map);

  const LiveNews& news_;
  const LiveBoard& board_;
  // Numbers that were sent,
  std::uint64_t hello_ = 0, run_ = 0, pose_ = 0, scan_ = 0, particles_ = 0, stored_ = 0, transient_ = 0, status_ = 0;
  std::uint64_t samples_ = 0, changes_ = 0, boxes_ = 0;  // and that come next
  std::optional<GridGeometry> frame_;                    // of the map that the viewer knows
  std::deque<CellBox> due_;
};

}  // namespace deltamap::daemon
