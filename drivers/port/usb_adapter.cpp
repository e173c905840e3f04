// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/usb_adapter.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace deltamap::drivers::port {
namespace {

namespace fs = std::filesystem;

/// The line that an attribute file holds; empty where there is none.
std::string attribute(const fs::path& folder, const char* name) {
  std::string line;
  std::ifstream file{folder / name};
  std::getline(file, line);
  while (line.ends_with(' ')) line.pop_back();
  return line;
}

/// The adapter of a tty ("/sys/devices/…/1-2/1-2:1.0/ttyUSB0"): the first folder above it with a vendor. The folder
/// between them (1-2:1.0) is one interface of the adapter.
std::optional<UsbAdapter> adapter_above(fs::path device) {
  const std::string port_number = attribute(device, "port_number");
  std::string interface;
  for (; device.has_relative_path(); device = device.parent_path()) {
    const std::string folder = device.filename();
    if (const auto at = folder.find(':'); at != std::string::npos && interface.empty())
      interface = folder.substr(at + 1);
    const std::string vendor = attribute(device, "idVendor");
    if (vendor.empty()) continue;
    UsbAdapter adapter;
    adapter.kind = vendor + ":" + attribute(device, "idProduct") + " " + interface;
    if (!port_number.empty() && port_number != "0") adapter.kind += "." + port_number;
    adapter.serial = attribute(device, "serial");
    adapter.socket = folder;
    adapter.name = attribute(device, "manufacturer");
    if (const std::string product = attribute(device, "product"); !product.empty()) {
      adapter.name += (adapter.name.empty() ? "" : " ") + product;
    }
    return adapter;
  }
  return std::nullopt;
}

std::optional<UsbAdapter> adapter_of_name(const std::string& name, const fs::path& sys) {
  std::error_code error;
  const fs::path device = fs::canonical(sys / "class/tty" / name / "device", error);
  return error ? std::nullopt : adapter_above(device);
}

}  // namespace

std::string UsbPort::told() const {
  std::string text = path + " (" + (adapter.name.empty() ? adapter.kind : adapter.name);
  if (!adapter.serial.empty()) text += ", serial " + adapter.serial;
  return text + ", USB " + adapter.socket + ")";
}

std::optional<UsbAdapter> adapter_of(const fs::path& path, const fs::path& sys) {
  std::error_code error;
  const fs::path device = fs::canonical(path, error);
  return adapter_of_name((error ? path : device).filename(), sys);
}

std::vector<UsbPort> usb_ports(const fs::path& sys) {
  std::vector<UsbPort> ports;
  std::error_code error;
  for (fs::directory_iterator entry{sys / "class/tty", error}, end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (!name.starts_with("ttyUSB") && !name.starts_with("ttyACM")) continue;
    if (auto adapter = adapter_of_name(name, sys)) ports.push_back({"/dev/" + name, *std::move(adapter)});
  }
  std::sort(ports.begin(), ports.end(), [](const UsbPort& a, const UsbPort& b) { return a.path < b.path; });
  return ports;
}

std::optional<UsbPort> port_of(const UsbAdapter& adapter, const std::vector<UsbPort>& ports) {
  const auto only = [&](auto&& is_it) {
    const auto found = std::find_if(ports.begin(), ports.end(), is_it);
    const bool is_one = found != ports.end() && std::find_if(std::next(found), ports.end(), is_it) == ports.end();
    return is_one ? std::optional{*found} : std::nullopt;
  };
  const auto is_kind = [&](const UsbPort& port) { return port.adapter.kind == adapter.kind; };
  if (!adapter.serial.empty()) {
    auto found = only([&](const UsbPort& port) { return is_kind(port) && port.adapter.serial == adapter.serial; });
    if (found) return found;
  }
  return only([&](const UsbPort& port) {
    return is_kind(port) && port.adapter.serial == adapter.serial && port.adapter.socket == adapter.socket;
  });
}

}  // namespace deltamap::drivers::port
