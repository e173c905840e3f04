// SPDX-License-Identifier: Apache-2.0
// Writes what outlives the run beside the store, in the recorder thread: the pose every few seconds, what has proven
// stable every minute, pose and map when the operator asks for it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/grid/occupancy_grid.hpp"
#include "daemon/control/command.hpp"
#include "daemon/kept/kept_pose.hpp"
#include "daemon/kept/kept_stability.hpp"
#include "daemon/outputs/retrying_output.hpp"
#include "daemon/settings/memory_places.hpp"

namespace deltamap::daemon {

/// `ctl save`.
struct SaveOrder {
  std::uint64_t ticket = 0;
  KeptPose pose;
  std::shared_ptr<const OccupancyGrid> map;  ///< that the pose was computed on
};

class MemoryKeeper {
 public:
  MemoryKeeper(MemoryPlaces places, OutputBoard& board, const RetryingOutput::Warn& warn);

  void keep(const KeptPose& pose, Timestamp now);
  void keep(const KeptStability& stability, Timestamp now);
  /// Now and then: what could not be written is tried again, always the newest.
  void retry(Timestamp now);
  /// The last attempt.
  void close(Timestamp now);
  [[nodiscard]] control::CommandOutcome save(const SaveOrder& order) const;

 private:
  /// One file; its content waits here while it cannot be written.
  struct Kept {
    std::filesystem::path file;
    RetryingOutput output;
    std::string waiting;
    void write(std::string content, Timestamp now);
    void retry(Timestamp now);
  };

  MemoryPlaces places_;
  std::optional<Kept> pose_, stability_;  // nothing where there is no place for them
};

}  // namespace deltamap::daemon
