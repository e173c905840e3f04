// SPDX-License-Identifier: Apache-2.0
// A pseudo-terminal that stands for a serial port: the simulator holds one end, a symbolic link leads programs to the
// other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace deltamap::simulation::devices {

class PseudoTerminal {
 public:
  /// Replaces a link of that name that leads nowhere; any other file of that name is an error.
  /// Throws std::runtime_error: one line that names the link.
  explicit PseudoTerminal(std::filesystem::path link);
  /// Removes the link.
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  [[nodiscard]] int descriptor() const { return master_; }
  /// Whether a program holds the other end open. What is written while none does is lost, as on a wire.
  [[nodiscard]] bool is_open_elsewhere() const;
  /// The speed to which the program has set its end; 0 for one that serial lines do not have.
  [[nodiscard]] unsigned baud() const;

  /// What has come since the last call; never waits.
  [[nodiscard]] std::vector<std::uint8_t> read();
  /// Never waits: what the program does not fetch in time is lost, as on a wire.
  void write(std::span<const std::uint8_t> bytes);

 private:
  std::filesystem::path link_;
  int master_ = -1;
};

}  // namespace deltamap::simulation::devices
