// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/serial_line.hpp"

#include <algorithm>

namespace deltamap::simulation::devices {
namespace {

constexpr int kBitsPerByte = 10;
constexpr std::uint32_t kMostNoise = 40;  // bytes before a frame

}  // namespace

Duration byte_duration(unsigned baud) { return Duration{std::int64_t{kBitsPerByte} * 1'000'000'000 / baud}; }

std::vector<std::uint8_t> garbled(std::span<const std::uint8_t> bytes, unsigned sent_baud, unsigned received_baud,
                                  Random& random) {
  if (sent_baud == received_baud || sent_baud == kAnyBaud || received_baud == kAnyBaud)
    return {bytes.begin(), bytes.end()};
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
  if (witness_) witness_(bytes, not_before);
  const std::vector<std::uint8_t> frame = damaged(bytes);
  if (faults_.pause_s == 0.0 || frame.size() < 2) return queue(frame, not_before);
  const auto cut = 1 + random_.index_below(static_cast<std::uint32_t>(frame.size() - 1));
  queue(std::span{frame}.first(cut), not_before);
  queue(std::span{frame}.subspan(cut), idle_at_ + duration_from_seconds(faults_.pause_s));
}

std::vector<std::uint8_t> SerialLine::damaged(std::span<const std::uint8_t> frame) {
  std::vector<std::uint8_t> sent;
  const auto happens = [&](double share) { return share > 0.0 && random_.uniform() < share; };
  if (happens(faults_.noisy_share)) {
    sent.resize(1 + random_.index_below(kMostNoise));
    for (std::uint8_t& byte : sent) byte = static_cast<std::uint8_t>(random_() & 0xFFu);
  }
  const std::size_t begin = sent.size();
  sent.insert(sent.end(), frame.begin(), frame.end());
  const auto length = static_cast<std::uint32_t>(frame.size());
  if (happens(faults_.flipped_share))
    sent[begin + random_.index_below(length)] ^= static_cast<std::uint8_t>(1u << random_.index_below(8));
  if (happens(faults_.truncated_share)) sent.resize(begin + random_.index_below(length));
  return sent;
}

void SerialLine::queue(std::span<const std::uint8_t> bytes, Timestamp not_before) {
  if (bytes.empty()) return;
  bursts_.push_back({{bytes.begin(), bytes.end()}, std::max(not_before, idle_at_), baud()});
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
