// SPDX-License-Identifier: Apache-2.0
// A session and a scripted device at two ends of a line, in virtual time: what the session writes reaches the device
// if both are at the same speed, and what the device sends comes back, garbled if they are not.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "drivers/received_bytes.hpp"
#include "drivers/session.hpp"

namespace deltamap::tests {

/// Bytes with the time at which they have left the device.
struct SentBytes {
  Timestamp at;
  std::vector<std::uint8_t> bytes;
};

struct WrittenBytes {
  Timestamp at;
  unsigned baud = 0;
  std::vector<std::uint8_t> bytes;
};

/// Session: start, on_bytes, on_time. Device: baud(), take(bytes, now), tick(now) and `outgoing`, a list of SentBytes.
template <typename Session, typename Device>
class Conversation {
 public:
  Conversation(Session& session, Device& device) : session_{session}, device_{device} {}

  void start() { carry_out(session_.start(now)); }

  /// Lets virtual time pass in steps of a millisecond.
  void run_for(double duration_s) {
    const Timestamp end = now + duration_from_seconds(duration_s);
    while (now < end && !failed) step();
  }

  template <typename Condition>
  bool run_until(Condition&& condition, double at_most_s) {
    const Timestamp end = now + duration_from_seconds(at_most_s);
    while (now < end && !failed) {
      if (condition()) return true;
      step();
    }
    return condition();
  }

  /// Time passes and the device goes on, but whoever feeds the session stands still: what has come meanwhile is handed
  /// over afterwards, in pieces that are read one right after the other.
  void stand_still_for(double duration_s, std::size_t piece) {
    const Timestamp end = now + duration_from_seconds(duration_s);
    std::vector<std::uint8_t> waiting;
    while (now < end) {
      now += std::chrono::milliseconds{1};
      device_.tick(now);
      while (!device_.outgoing.empty() && device_.outgoing.front().at <= now) {
        const std::vector<std::uint8_t> bytes = next_arrived();
        waiting.insert(waiting.end(), bytes.begin(), bytes.end());
      }
    }
    for (std::size_t begin = 0; begin < waiting.size() && !failed; begin += piece) {
      const auto from = waiting.begin() + static_cast<std::ptrdiff_t>(begin);
      hand_over({from, from + static_cast<std::ptrdiff_t>(std::min(piece, waiting.size() - begin))});
      now += std::chrono::microseconds{20};
    }
  }

  /// Does what the session asks for; for calls that the test makes itself, too.
  template <typename Output>
  void carry_out(Output output) {
    for (const drivers::PortRequest& request : output.output.requests) {
      if (request.kind == drivers::PortRequest::Kind::kSetBaud) {
        line_baud = request.baud;
        written.push_back({now, line_baud, {}});  // an empty entry marks the change
      } else if (request.kind == drivers::PortRequest::Kind::kWrite) {
        written.push_back({now, line_baud, request.bytes});
        if (line_baud == device_.baud()) device_.take(request.bytes, now);
      }
    }
    log.insert(log.end(), output.output.log.begin(), output.output.log.end());
    warnings.insert(warnings.end(), output.output.warnings.begin(), output.output.warnings.end());
    if (output.output.failed) failed = output.output.failed;
    wake_at = output.output.wake_at;
    collect(output);
  }

  [[nodiscard]] bool has_logged(const std::string& part) const {
    return std::any_of(log.begin(), log.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
  }

  Timestamp now = timestamp_from_ns(1'700'000'000'000'000'000);
  unsigned line_baud = 0;
  std::optional<Timestamp> wake_at;
  std::optional<std::string> failed;
  std::vector<std::string> log;
  std::vector<std::string> warnings;
  std::vector<WrittenBytes> written;
  std::vector<SentBytes> received;  ///< as the session saw it: for replays
  typename Session::Messages messages;

 private:
  void step() {
    now += std::chrono::milliseconds{1};
    device_.tick(now);
    while (!device_.outgoing.empty() && device_.outgoing.front().at <= now) {
      hand_over(next_arrived());
      if (failed) return;
    }
    if (wake_at && *wake_at <= now) carry_out(session_.on_time(now));
  }

  std::vector<std::uint8_t> next_arrived() {
    std::vector<std::uint8_t> bytes = std::move(device_.outgoing.front().bytes);
    device_.outgoing.erase(device_.outgoing.begin());
    if (line_baud != device_.baud()) {
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(byte * 7u + 13u);
    }
    return bytes;
  }

  void hand_over(const std::vector<std::uint8_t>& bytes) {
    received.push_back({now, bytes});
    carry_out(session_.on_bytes(bytes, now));
  }

  template <typename Output>
  void collect(const Output& output) {
    const auto& fresh = Session::messages_of(output);
    messages.insert(messages.end(), fresh.begin(), fresh.end());
  }

  Session& session_;
  Device& device_;
};

}  // namespace deltamap::tests
