// SPDX-License-Identifier: Apache-2.0
#include "daemon/system/unit_memory.hpp"

#include <charconv>
#include <cstdio>
#include <memory>

namespace deltamap::daemon {
namespace {

constexpr std::uint64_t kDelivered_bytes = 128 * 1024 * 1024;  // MemoryMax in systemd/deltamap.service
constexpr const char* kAsk = "systemctl show deltamap.service --property=LoadState,MemoryMax 2>/dev/null";

}  // namespace

std::optional<UnitMemory> unit_memory_of(const std::string& properties) {
  const std::string key = "MemoryMax=";
  const auto at = properties.find(key);
  if (at == std::string::npos || properties.find("LoadState=loaded") == std::string::npos) {
    return UnitMemory{kDelivered_bytes, "MemoryMax of the delivered unit"};
  }
  UnitMemory found{0, "MemoryMax of deltamap.service"};
  const char* begin = properties.data() + at + key.size();
  const auto [end, error] = std::from_chars(begin, properties.data() + properties.size(), found.most_bytes);
  const bool is_limited = error == std::errc{} && found.most_bytes != UINT64_MAX;
  return is_limited ? std::optional{found} : std::nullopt;  // else "infinity", in words or as its number
}

std::optional<UnitMemory> unit_memory() {
  std::string text;
  if (const std::unique_ptr<FILE, int (*)(FILE*)> answer{::popen(kAsk, "re"), &::pclose}) {
    char bytes[256];
    while (const std::size_t size = std::fread(bytes, 1, sizeof bytes, answer.get())) text.append(bytes, size);
  }
  return unit_memory_of(text);
}

}  // namespace deltamap::daemon
