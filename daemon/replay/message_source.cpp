// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/message_source.hpp"

#include <utility>
#include <vector>

namespace deltamap::daemon {

FileMessages::FileMessages(const std::filesystem::path& recording, const drivers::port::ReplayWindow& window,
                           const Settings& settings)
    : port_{recording, window}, decoder_{settings} {}

std::optional<RecordedMessage> FileMessages::next() {
  while (waiting_.empty()) {
    if (!read_on()) return std::nullopt;
  }
  std::optional<RecordedMessage> message{std::move(waiting_.front())};
  waiting_.pop_front();
  return message;
}

/// Of one record the odometry goes first: a scan is looked at with all that the wheels have told.
bool FileMessages::read_on() {
  const auto replayed = port_.next();
  if (!replayed) return false;
  std::vector<Scan> scans;
  decoder_.feed(replayed->record, {[&](Odometry&& odometry, std::uint32_t number) {
                                     if (replayed->in_window) waiting_.push_back({odometry, number});
                                   },
                                   [&](Scan&& scan) { scans.push_back(std::move(scan)); }});
  if (!replayed->in_window) {
    scans_before_ += scans.size();
    return true;
  }
  for (Scan& scan : scans) {
    const std::uint32_t number = scan.number;
    waiting_.push_back({std::move(scan), number});
  }
  return true;
}

OutsideWindow FileMessages::outside_window() {
  return {.packets_before = port_.packets_before(),
          .scans_before = scans_before_,
          .packets_after = port_.count_packets_after()};
}

double FileMessages::done() const {
  return static_cast<double>(port_.read_bytes()) / static_cast<double>(port_.size_bytes());
}

}  // namespace deltamap::daemon
