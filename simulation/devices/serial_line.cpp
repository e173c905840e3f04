// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/serial_line.hpp"

#include <algorithm>

namespace deltamap::simulation::devices {
namespace {

constexpr int kBitsPerByte = 10;

}  // namespace

Duration byte_duration(unsigned baud) { return Duration{std::int64_t{kBitsPerByte} * 1'000'000'000 / baud}; }

std::vector<std::uint8_t> garbled(std::span<const std::uint8_t> bytes, unsigned sent_baud, unsigned received_baud,
                                  Random& random) {
  if (sent_baud == received_baud) return {bytes.begin(), bytes.end()};
  // A slower receiver misses whole bytes; a faster one takes single bits for bytes, at most one for each edge.
  const double ratio = std::min(3.0, static_cast<double>(received_baud) / static_cast<double>(sent_baud));
  std::vector<std::uint8_t> garbage;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    double expected = ratio * random.uniform(0.5, 1.0);
    for (; expected > random.uniform(); expected -= 1.0) garbage.push_back(static_cast<std::uint8_t>(random() & 0xFFu));
  }
  return garbage;
}

std::size_t SerialLine::Burst::complete_at(Timestamp now) const {
  if (now <= begin) return 0;
  return std::min(bytes.size(), static_cast<std::size_t>((now - begin) / byte_duration(baud)));
}

void SerialLine::send(std::span<const std::uint8_t> bytes, Timestamp not_before) {
  if (bytes.empty()) return;
  bursts_.push_back({{bytes.begin(), bytes.end()}, std::max(not_before, idle_at_), baud_});
  idle_at_ = bursts_.back().end();
}

void SerialLine::interrupt(Timestamp now) {
  while (!bursts_.empty() && bursts_.back().begin >= now) bursts_.pop_back();
  if (!bursts_.empty()) {
    Burst& leaving = bursts_.back();
    const std::size_t begun = leaving.complete_at(now + byte_duration(leaving.baud));
    leaving.bytes.resize(std::max(begun, leaving.taken));
  }
  idle_at_ = bursts_.empty() ? now : bursts_.back().end();
}

std::vector<std::uint8_t> SerialLine::arrived(Timestamp now, unsigned host_baud) {
  std::vector<std::uint8_t> received;
  while (!bursts_.empty()) {
    Burst& burst = bursts_.front();
    const std::size_t complete = burst.complete_at(now);
    const auto fresh = std::span{burst.bytes}.subspan(burst.taken, complete - burst.taken);
    const auto heard = garbled(fresh, burst.baud, host_baud, random_);
    received.insert(received.end(), heard.begin(), heard.end());
    burst.taken = complete;
    if (complete < burst.bytes.size()) break;
    bursts_.pop_front();
  }
  return received;
}

std::optional<Timestamp> SerialLine::burst_whole_at() const {
  if (bursts_.empty()) return std::nullopt;
  return bursts_.front().end();
}

}  // namespace deltamap::simulation::devices
