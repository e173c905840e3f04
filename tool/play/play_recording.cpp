// SPDX-License-Identifier: Apache-2.0
#include "tool/play/play_recording.hpp"

#include <array>
#include <iostream>
#include <stdexcept>

#include "drivers/port/passed_time.hpp"
#include "tool/live_ports.hpp"
#include "tool/play/heard_frames.hpp"
#include "tool/play/played_port.hpp"

namespace deltamap::tool {
namespace {

using drivers::port::PortId;

constexpr double kLongestSleepS = 0.2;  // a client that opens a port does not wake us
constexpr double kListensAfterS = 2.0;  // a client that has said nothing
constexpr std::size_t kToldDifferences = 50;

/// One port: what is played, and what is heard.
struct Line {
  explicit Line(PortId port) : heard{port} {}
  PlayedPort played;
  HeardFrames heard;
};

class Player {
 public:
  Player(const std::filesystem::path& recording, const drivers::port::ReplayWindow& window) {
    drivers::port::ByteLogReader reader{recording};
    drivers::port::PassedTime passed;
    while (const auto record = reader.next()) {
      const double after_s = passed.after_s(record->stamp);
      if (after_s > window.to_s) break;
      if (after_s < window.from_s) continue;
      Line& line = lines_[static_cast<std::size_t>(record->port)];
      line.played.add(*record, after_s - window.from_s);
      line.heard.expect(*record);
      const bool is_heard = !record->bytes.empty() && record->direction == drivers::port::Direction::kOut;
      if (is_heard && !first_heard_s_) first_heard_s_ = after_s - window.from_s;
    }
    if (!next_s()) throw std::runtime_error(recording.string() + ": no device says anything in this window");
    for (const std::string& line : reader.faults().lines()) std::cerr << "deltamap: warning: " << line << '\n';
  }

  /// When the client first said something; nothing where it never did.
  [[nodiscard]] const std::optional<double>& first_heard_s() const { return first_heard_s_; }

  /// Takes what the client has said, and says what is due.
  void go_on(PortId id, const std::vector<std::uint8_t>& said, simulation::devices::PseudoTerminal& port, Timestamp now,
             double after_s) {
    Line& line = lines_[static_cast<std::size_t>(id)];
    if (!said.empty()) {
      line.played.hear(said.size());
      for (const std::string& difference : line.heard.hear(said, now, port.baud(), after_s)) tell(difference);
    }
    const std::vector<std::uint8_t> bytes = line.played.due(after_s);
    if (!bytes.empty()) port.write(bytes);
  }

  [[nodiscard]] std::optional<double> next_s() const {
    const auto robot = lines_[0].played.next_s();
    const auto laser = lines_[1].played.next_s();
    if (!robot || !laser) return robot ? robot : laser;
    return std::min(*robot, *laser);
  }

  void print_summary() const {
    for (const PortId port : {PortId::kRobot, PortId::kLaser}) {
      const HeardFrames& heard = lines_[static_cast<std::size_t>(port)].heard;
      std::cout << name_of(port) << ": " << heard.same() << " frames as recorded, " << heard.differences()
                << " differences, " << heard.left() << " recorded ones not said\n";
    }
  }

 private:
  void tell(const std::string& difference) {
    if (++told_ <= kToldDifferences) std::cerr << difference << '\n';
    if (told_ == kToldDifferences) std::cerr << "further differences are counted alone\n";
  }

  std::array<Line, 2> lines_{Line{PortId::kRobot}, Line{PortId::kLaser}};
  std::optional<double> first_heard_s_;
  std::size_t told_ = 0;
};

/// The client's first word is that of the recording; one that only listens is played to from when it has opened the
/// ports. Nothing: not yet.
std::optional<Timestamp> start_of_play(const Player& player, Timestamp opened, Timestamp now, bool is_heard) {
  const auto& first_heard_s = player.first_heard_s();
  if (!first_heard_s) return opened;
  if (is_heard) return now - duration_from_seconds(*first_heard_s);
  return seconds(now - opened) > kListensAfterS ? std::optional{opened} : std::nullopt;
}

}  // namespace

void play_recording(const std::filesystem::path& recording, const std::filesystem::path& links,
                    const drivers::port::ReplayWindow& window) {
  Player player{recording, window};
  const StopSignals signals;
  const SteadyClock clock;
  LivePorts ports{links};
  std::cerr << "robot=" << (links / "robot").string() << " laser=" << (links / "laser").string()
            << ": waiting for a client on both\n";
  const auto sleep_s = [&](double from_now_s) {
    ports.sleep_until(clock.now() + duration_from_seconds(std::min(from_now_s, kLongestSleepS)), clock, signals);
  };
  while (!signals.was_asked() && !(ports.robot.is_open_elsewhere() && ports.laser.is_open_elsewhere())) sleep_s(0.01);
  const Timestamp opened = clock.now();
  std::optional<Timestamp> start;
  while (!signals.was_asked() && player.next_s()) {
    const std::vector<std::uint8_t> to_robot = ports.robot.read();
    const std::vector<std::uint8_t> to_laser = ports.laser.read();
    const Timestamp now = clock.now();
    if (!start) start = start_of_play(player, opened, now, !to_robot.empty() || !to_laser.empty());
    if (start) {
      player.go_on(PortId::kRobot, to_robot, ports.robot, now, seconds(now - *start));
      player.go_on(PortId::kLaser, to_laser, ports.laser, now, seconds(now - *start));
    }
    const auto next_s = player.next_s();
    if (next_s) sleep_s(start ? *next_s - seconds(clock.now() - *start) : kLongestSleepS);
  }
  player.print_summary();
}

}  // namespace deltamap::tool
