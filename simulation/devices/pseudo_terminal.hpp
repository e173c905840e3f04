// SPDX-License-Identifier: Apache-2.0
// A pseudo-terminal that stands for a serial port: the simulator holds one end, a symbolic link leads programs to the
// other.
#pragma once

#include <filesystem>

#include "simulation/devices/device_port.hpp"

namespace deltamap::simulation::devices {

class PseudoTerminal final : public DevicePort {
 public:
  /// Replaces a link of that name that leads nowhere; any other file of that name is an error.
  /// Throws std::runtime_error: one line that names the link.
  explicit PseudoTerminal(std::filesystem::path link);
  /// Removes the link.
  ~PseudoTerminal() override;
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  [[nodiscard]] bool is_open_elsewhere() const override;
  [[nodiscard]] unsigned baud() const override;
  [[nodiscard]] std::vector<std::uint8_t> read() override;
  void write(std::span<const std::uint8_t> bytes) override;
  void watch(std::vector<pollfd>& watched) const override;

 private:
  std::filesystem::path link_;
  int master_ = -1;
};

}  // namespace deltamap::simulation::devices
