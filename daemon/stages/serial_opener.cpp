// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/serial_opener.hpp"

#include <filesystem>
#include <system_error>

namespace deltamap::daemon {

PortOpener serial_opener(const drivers::port::PortFinder& finder) {
  return [&finder](boost::asio::io_context& loop, drivers::port::PortId id, unsigned baud) {
    const auto place = finder.place_of(id);
    if (place.path.empty()) return drivers::port::SerialPortAnswer{nullptr, place.refused};
    auto answer = drivers::port::open_serial_port(loop, place.path, baud);
    std::error_code error;
    if (!answer.port && !std::filesystem::exists(place.path, error)) answer.refused += finder.others_here(id);
    answer.note = place.note;
    return answer;
  };
}

}  // namespace deltamap::daemon
