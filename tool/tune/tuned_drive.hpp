// SPDX-License-Identifier: Apache-2.0
// A recording to tune by: its map, what is known of the true way, and its messages, read and decoded once for all runs.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/replay/recorded_drive.hpp"
#include "simulation/score/reference_score.hpp"
#include "simulation/score/relation_score.hpp"

namespace deltamap::tool::tune {

/// What a trajectory is held against.
struct TrueWay {
  enum class Kind : std::uint8_t { kNone, kReference, kRelations, kSimulation } kind = Kind::kNone;
  std::filesystem::path file{};
  bool of_laser = false;  ///< the reference tells poses of the laser
};

struct DriveFiles {
  std::string name;  ///< unique among the drives
  std::filesystem::path recording;
  std::filesystem::path map{};
  TrueWay way{};
  std::vector<std::string> overrides{};  ///< "key=value", of this drive alone
  double from_s = 0.0;
  double to_s = std::numeric_limits<double>::infinity();
};

class TunedDrive {
 public:
  using StampedPose = simulation::score::StampedPose;

  /// Reads map and true way. Throws std::runtime_error that names the file.
  explicit TunedDrive(DriveFiles files);

  [[nodiscard]] const DriveFiles& files() const { return files_; }
  [[nodiscard]] const daemon::FirstMap& map() const { return map_; }

  /// The recording as these settings of robot and laser decode it. Any thread. Throws as daemon::recorded_drive() does.
  [[nodiscard]] std::shared_ptr<const daemon::RecordedDrive> decoded(const daemon::Settings& settings);
  /// What was decoded is no longer kept.
  void forget_decoded();
  [[nodiscard]] bool is_decoded() const;
  /// True once: the run that asks first says for all of this drive what a replay would warn of. Any thread.
  [[nodiscard]] bool is_first_run() { return !has_run_.test_and_set(); }

  /// Adds what the way of a run is worth to numbers. `settings`: those of the run. Throws std::runtime_error where the
  /// times of the reference do not meet those of the recording.
  [[nodiscard]] std::vector<std::pair<std::string, double>> errors_of(const std::vector<StampedPose>& trajectory,
                                                                      const daemon::Settings& settings) const;

  /// What the files hold, in hexadecimal: equal texts, equal recordings, maps and true ways.
  [[nodiscard]] std::string identity() const;

 private:
  DriveFiles files_;
  daemon::FirstMap map_;
  std::vector<StampedPose> reference_;
  std::vector<simulation::score::Relation> relations_;
  simulation::Truth truth_;
  std::atomic_flag has_run_;
  mutable std::mutex decoding_;
  std::map<std::string, std::shared_ptr<const daemon::RecordedDrive>> decoded_;  // by decoding_settings()
};

}  // namespace deltamap::tool::tune
