// SPDX-License-Identifier: Apache-2.0
#include "daemon/memory_keeper.hpp"

#include <exception>

#include "core/grid_file.hpp"

namespace deltamap::daemon {

void MemoryKeeper::keep(const KeptPose& pose) { replace(places_.pose, json_text(pose)); }

void MemoryKeeper::keep(const KeptStability& stability) { replace(places_.stability, file_text(stability)); }

void MemoryKeeper::replace(const std::filesystem::path& file, const std::string& content) {
  if (file.empty()) return;
  try {
    replace_file(file, content);
    if (fails_) warn_("pose and stability are kept again: " + file.string());
    fails_ = false;
  } catch (const std::exception& error) {
    if (!fails_) warn_(std::string("pose and stability are not kept: ") + error.what());
    fails_ = true;
  }
}

CommandOutcome MemoryKeeper::save(const SaveOrder& order) {
  if (places_.pose.empty()) return {order.ticket, false, "no place to save to: 'map.store' is empty"};
  try {
    write_grid(*order.map, places_.saved_map);
    replace_file(places_.pose, json_text(order.pose));
  } catch (const std::exception& error) {
    return {order.ticket, false, error.what()};
  }
  return {order.ticket, true,
          "map " + std::to_string(order.pose.revision) + " saved as " + places_.saved_map.string() + ", pose as " +
              places_.pose.string()};
}

}  // namespace deltamap::daemon
