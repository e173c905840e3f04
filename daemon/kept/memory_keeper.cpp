// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept/memory_keeper.hpp"

#include <exception>
#include <utility>

#include "core/files/grid_file.hpp"
#include "core/files/replace_file.hpp"

namespace deltamap::daemon {

MemoryKeeper::MemoryKeeper(MemoryPlaces places, OutputBoard& board, const RetryingOutput::Warn& warn)
    : places_{std::move(places)} {
  if (places_.pose.empty()) return;
  pose_.emplace(Kept{places_.pose, {"pose", places_.pose, board, warn}, {}});
  stability_.emplace(Kept{places_.stability, {"stability", places_.stability, board, warn}, {}});
}

void MemoryKeeper::keep(const KeptPose& pose, Timestamp now) {
  if (pose_) pose_->write(json_text(pose), now);
}

void MemoryKeeper::keep(const KeptStability& stability, Timestamp now) {
  if (stability_) stability_->write(file_text(stability), now);
}

void MemoryKeeper::retry(Timestamp now) {
  if (!pose_) return;
  pose_->retry(now);
  stability_->retry(now);
}

void MemoryKeeper::close(Timestamp now) {
  if (!pose_) return;
  pose_->output.hurry();
  stability_->output.hurry();
  retry(now);
}

void MemoryKeeper::Kept::write(std::string content, Timestamp now) {
  waiting = std::move(content);
  retry(now);
}

void MemoryKeeper::Kept::retry(Timestamp now) {
  if (waiting.empty()) return;
  if (output.attempt(now, [this] { replace_file(file, waiting); })) waiting = {};
}

control::CommandOutcome MemoryKeeper::save(const SaveOrder& order) const {
  if (places_.pose.empty()) return {order.ticket, false, "no place to save to: 'map.store' is empty"};
  try {
    write_grid(*order.map, places_.saved_map);
    replace_file(places_.pose, json_text(order.pose));
  } catch (const std::exception& error) {
    return {order.ticket, false, error.what()};
  }
  const auto whole = [](const std::filesystem::path& path) { return std::filesystem::absolute(path).string(); };
  return {order.ticket, true,
          "map " + std::to_string(order.pose.revision) + " saved as " + whole(places_.saved_map) + ", pose as " +
              whole(places_.pose)};
}

}  // namespace deltamap::daemon
