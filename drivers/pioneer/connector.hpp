// SPDX-License-Identifier: Apache-2.0
// The way to a connection (protocols.md A4): at each baud first quiet, then SYNC0, SYNC1, SYNC2, OPEN. A state machine,
// fed with what was received and the time. A robot that answers with SIPs is still connected to a client that has gone:
// it is stopped, looked at, closed, and then waits at its idle baud.
//
// Safety: SYNC0 has the bytes of PULSE, and any packet lets a robot that its watchdog stopped resume its old set points
// (A9). So every SYNC0 is preceded by its own ESTOP, VEL 0 and RVEL 0: the ones before may have been lost.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "drivers/pioneer/baud_search.hpp"
#include "drivers/pioneer/transmitter.hpp"

namespace deltamap::drivers::pioneer {

class Connector {
 public:
  /// `idle_baud`: where the robot waits for a connection; `connected_baud`: where one of ours may have been left, and
  /// to which each is switched.
  Connector(unsigned idle_baud, unsigned connected_baud)
      : home_baud_{idle_baud}, idle_baud_{idle_baud}, connected_baud_{connected_baud}, wanted_baud_{connected_baud} {}

  void start(Transmitter& line);
  /// A packet that the receiver has taken.
  void hear(const Packet& packet, Transmitter& line);
  /// Called whenever it may be late: the way also depends on the queue.
  void time_out(Transmitter& line);
  /// Bytes that are no packets: a robot that sends SIPs at another speed. Not worth the whole wait for an echo.
  void notice_another_speed(const Receiver& receiver, Timestamp now);
  /// A connection goes on at another baud.
  void remember_connection(unsigned baud) { connected_baud_ = baud; }

  [[nodiscard]] Timestamp deadline() const { return deadline_; }
  /// The deadline counts from when the queue is empty.
  [[nodiscard]] bool waits_for_queue() const;
  /// OPEN was sent; SIPs are of our own connection.
  [[nodiscard]] bool has_opened() const { return state_ == State::kOpening; }

  enum class Result {
    kPending,
    kConnected,
    kNobodyAnswers,  // at any baud
    kStaysConnected  // to a client that has gone
  };
  [[nodiscard]] Result result() const { return result_; }
  /// "9600, 38400, 115200, 19200, 57600": of this search, each once.
  [[nodiscard]] std::string tried_bauds() const;

 private:
  enum class State {
    kQuieting,   // whatever the robot was doing is being stopped; a SIP tells that it is still connected
    kObserving,  // a connection that was left over: a SIP younger than the stop is awaited, then it is closed
    kClosing,    // a connection that was left over is being closed
    kSyncing,    // SYNC0, SYNC1, SYNC2, each awaiting its echo
    kOpening     // OPEN sent, awaiting the first SIP
  };

  void probe(Transmitter& line);
  void probe_next(Transmitter& line);
  void begin_quieting(Transmitter& line);
  void end_quiet(Transmitter& line);
  void stop_left_over(Transmitter& line);
  void close_left_over(const Packet& sip, Transmitter& line);
  void send_sync(std::uint8_t step, Transmitter& line);
  void take_echo(const Packet& packet, Transmitter& line);

  unsigned home_baud_;  // where it should wait
  unsigned idle_baud_;  // where it was found waiting
  unsigned connected_baud_;
  unsigned wanted_baud_;
  State state_ = State::kQuieting;
  Result result_ = Result::kPending;
  std::vector<BaudProbe> probes_;
  std::size_t probe_ = 0;
  int tries_ = 0;     // of this probe
  int closings_ = 0;  // in this search
  std::uint8_t sync_step_ = 0;
  bool was_in_vain_ = false;          // the last search found no robot: a laser is asked for, too
  std::uint64_t garbage_before_ = 0;  // bytes, before SYNC0 went out
  Timestamp deadline_;                // of the present step
};

}  // namespace deltamap::drivers::pioneer
