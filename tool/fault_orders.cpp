// SPDX-License-Identifier: Apache-2.0
#include "tool/fault_orders.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <string_view>

#include "core/trimmed.hpp"

namespace deltamap::tool {
namespace {

constexpr std::size_t kLongestOrder = 1000;

std::string told(const simulation::FaultOrder& order) {
  return "fault " + simulation::described(order) + ": " + std::string(order.fault->meaning) + '\n';
}

std::string ended(const std::string& name, simulation::Simulation& simulation) {
  const std::size_t count = simulation.end_faults(name);
  if (count == 0)
    return "no fault" + (name.empty() ? "" : " \"" + name + "\"") + " was ordered; list tells which are\n";
  return "ended faults=" + std::to_string(count) + '\n';
}

std::string help() {
  return "orders, one a line:\n"
         "  NAME[:NUMBER][:SECONDS]  a fault, now, for ever or for so long; T:NAME... in T seconds\n"
         "  end [NAME]               ends all ordered faults, or those of that name\n"
         "  list                     what was ordered and is not over\n"
         "  help                     this\n"
         "faults:\n" +
         simulation::fault_help();
}

}  // namespace

std::string obeyed(const std::string& line, simulation::Simulation& simulation) {
  const std::string order = trimmed(line);
  if (order.empty()) return {};
  if (order == "help") return help();
  if (order == "end") return ended({}, simulation);
  if (order.starts_with("end ")) return ended(trimmed(order.substr(4)), simulation);
  if (order == "list") {
    std::string lines;
    for (const simulation::FaultOrder& fault : simulation.fault_schedule().orders()) lines += told(fault);
    return lines.empty() ? "no faults\n" : lines;
  }
  try {
    return told(simulation.order(simulation::fault_order(order)));
  } catch (const std::invalid_argument& error) {
    return std::string(error.what()) + "; or help, list, end\n";
  }
}

bool OrderLines::may_be_read() const {
  return !is_over_ && (::isatty(descriptor_) == 0 || ::tcgetpgrp(descriptor_) == ::getpgrp());
}

void OrderLines::watch(std::vector<pollfd>& watched) const {
  if (may_be_read()) watched.push_back({descriptor_, POLLIN, 0});
}

std::vector<std::string> OrderLines::read() {
  std::vector<std::string> lines;
  pollfd state{descriptor_, POLLIN, 0};
  while (may_be_read() && ::poll(&state, 1, 0) > 0) {
    std::array<char, 512> chunk;
    const ssize_t count = ::read(descriptor_, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      is_over_ = true;
      break;
    }
    for (const char letter : std::string_view{chunk.data(), static_cast<std::size_t>(count)}) {
      if (letter != '\n') {
        if (begun_.size() < kLongestOrder) begun_ += letter;
        continue;
      }
      lines.push_back(std::move(begun_));
      begun_.clear();
    }
  }
  return lines;
}

}  // namespace deltamap::tool
