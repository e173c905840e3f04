// SPDX-License-Identifier: Apache-2.0
// Where the two devices are now. A USB adapter that is pulled out and comes back may have another number, and the
// number of one may now be the other's. Once a device has answered through an adapter, it is looked for behind that
// adapter; before, at the port of the settings alone. No other port is ever proposed.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/port/byte_record.hpp"
#include "drivers/port/usb_adapter.hpp"

namespace deltamap::drivers::port {

class PortFinder {
 public:
  /// `sys`: the kernel's view of devices.
  PortFinder(std::string robot, std::string laser, std::filesystem::path sys = "/sys")
      : configured_{std::move(robot), std::move(laser)}, sys_{std::move(sys)} {}

  struct Place {
    std::string path;     ///< to be opened; empty: nothing is
    std::string refused;  ///< why nothing is
    std::string note;     ///< where it is another port than that of the settings: which, and why
  };
  [[nodiscard]] Place place_of(PortId device) const;

  /// The device has answered at this path: its adapter is known from now on.
  void answered(PortId device, const std::string& path) {
    known_[static_cast<std::size_t>(device)] = adapter_of(path, sys_);
  }

  /// "; here is /dev/ttyUSB1 (…)": the USB ports that are neither the other device's nor this one's, to be told where
  /// the device is missing; empty where there are none.
  [[nodiscard]] std::string others_here(PortId device) const;

 private:
  [[nodiscard]] const std::string& configured(PortId device) const {
    return configured_[static_cast<std::size_t>(device)];
  }
  [[nodiscard]] const std::optional<UsbAdapter>& known(PortId device) const {
    return known_[static_cast<std::size_t>(device)];
  }

  /// Ports that are not the other device's, as far as is known.
  [[nodiscard]] std::vector<UsbPort> candidates(PortId device) const;

  std::array<std::string, 2> configured_;  // by PortId
  std::filesystem::path sys_;
  std::array<std::optional<UsbAdapter>, 2> known_;  // by PortId
};

}  // namespace deltamap::drivers::port
