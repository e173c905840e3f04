// SPDX-License-Identifier: Apache-2.0
// A TCP port on the loopback address that stands for a serial port, for programs that cannot open a pseudo-terminal.
// One program at a time; another is turned away. It has no speed.
#pragma once

#include "simulation/devices/device_port.hpp"

namespace deltamap::simulation::devices {

class TcpPort final : public DevicePort {
 public:
  /// 0: any that is free. Throws std::runtime_error: one line that names the port.
  explicit TcpPort(std::uint16_t number);
  ~TcpPort() override;
  TcpPort(const TcpPort&) = delete;
  TcpPort& operator=(const TcpPort&) = delete;

  [[nodiscard]] std::uint16_t number() const { return number_; }
  [[nodiscard]] bool is_open_elsewhere() const override { return program_ >= 0; }
  [[nodiscard]] unsigned baud() const override;
  [[nodiscard]] std::vector<std::uint8_t> read() override;
  void write(std::span<const std::uint8_t> bytes) override;
  void watch(std::vector<pollfd>& watched) const override;

 private:
  void accept();
  void hang_up();

  std::uint16_t number_;
  int listener_ = -1;
  int program_ = -1;
};

}  // namespace deltamap::simulation::devices
