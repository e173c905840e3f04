// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/port_finder.hpp"

#include <algorithm>
#include <system_error>

namespace deltamap::drivers::port {
namespace {

namespace fs = std::filesystem;

PortId other_of(PortId device) { return device == PortId::kRobot ? PortId::kLaser : PortId::kRobot; }

/// The device itself, where the path is a link and the device is there.
std::string device_behind(const std::string& path) {
  std::error_code error;
  const fs::path device = fs::canonical(path, error);
  return error ? path : device.string();
}

}  // namespace

std::vector<UsbPort> PortFinder::candidates(PortId device) const {
  std::vector<UsbPort> ports = usb_ports(sys_);
  const auto& others = known(other_of(device));
  const std::string others_path = device_behind(configured(other_of(device)));
  std::erase_if(ports,
                [&](const UsbPort& port) { return others ? port.adapter == *others : port.path == others_path; });
  return ports;
}

PortFinder::Place PortFinder::place_of(PortId device) const {
  const std::string& configured = this->configured(device);
  if (const auto& mine = known(device)) {
    const auto port = port_of(*mine, candidates(device));
    if (port && port->path == device_behind(configured)) return {configured, "", ""};
    if (port) return {port->path, "", "its adapter is " + port->told() + " now, no longer " + configured};
  }
  const auto here = adapter_of(configured, sys_);
  if (here && here == known(other_of(device))) {
    return {"",
            configured + " is now the adapter of the " + std::string(name_of(other_of(device))) + ", and that of the " +
                std::string(name_of(device)) + " is missing: not plugged in?",
            ""};
  }
  return {configured, "", ""};
}

std::string PortFinder::others_here(PortId device) const {
  std::string text;
  for (const UsbPort& port : candidates(device)) {
    if (port.path == device_behind(configured(device))) continue;
    text += (text.empty() ? "; here is " : ", ") + port.told();
  }
  return text.empty() ? text : text + ": is it that one? Set '" + std::string(name_of(device)) + ".port'";
}

}  // namespace deltamap::drivers::port
