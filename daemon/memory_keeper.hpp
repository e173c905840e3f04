// SPDX-License-Identifier: Apache-2.0
// Writes what outlives the run beside the store, in the recorder thread: the pose every few seconds, what has proven
// stable every minute, pose and map when the operator asks for it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/occupancy_grid.hpp"
#include "daemon/command.hpp"
#include "daemon/kept_pose.hpp"
#include "daemon/kept_stability.hpp"

namespace deltamap::daemon {

/// `ctl save`.
struct SaveOrder {
  std::uint64_t ticket = 0;
  KeptPose pose;
  std::shared_ptr<const OccupancyGrid> map;  ///< that the pose was computed on
};

class MemoryKeeper {
 public:
  /// `warn` is told once when nothing can be written, and once when it can again.
  MemoryKeeper(MemoryPlaces places, std::function<void(const std::string&)> warn)
      : places_{std::move(places)}, warn_{std::move(warn)} {}

  void keep(const KeptPose& pose);
  void keep(const KeptStability& stability);
  [[nodiscard]] CommandOutcome save(const SaveOrder& order);

 private:
  void replace(const std::filesystem::path& file, const std::string& content);

  MemoryPlaces places_;
  std::function<void(const std::string&)> warn_;
  bool fails_ = false;
};

}  // namespace deltamap::daemon
