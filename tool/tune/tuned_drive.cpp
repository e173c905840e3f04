// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/tuned_drive.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "core/geometry/angle.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "simulation/scenario/truth.hpp"
#include "tool/told_grid.hpp"

namespace deltamap::tool::tune {
namespace {

namespace score = simulation::score;
using Kind = TrueWay::Kind;

/// FNV-1a over its bytes, in pieces: a recording may be large.
std::string fingerprint_of_file(const std::filesystem::path& file) {
  if (file.empty()) return "-";
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::array<char, 65536> piece{};
  std::uint64_t hash = daemon::fingerprint_of("");
  while (in.read(piece.data(), piece.size()) || in.gcount() > 0) {
    hash = daemon::fingerprint_of({piece.data(), static_cast<std::size_t>(in.gcount())}, hash);
  }
  return daemon::hex_of(hash);
}

void add(std::vector<std::pair<std::string, double>>& numbers, const score::ReferenceScore& found) {
  numbers.emplace_back("error_rmse_m", found.rmse_m);
  numbers.emplace_back("error_median_m", found.median_m);
  numbers.emplace_back("error_p95_m", found.p95_m);
  numbers.emplace_back("error_max_m", found.max_m);
  numbers.emplace_back("heading_median_deg", degrees(found.median_heading_rad));
  numbers.emplace_back("lost_share", found.lost_share);
}

}  // namespace

TunedDrive::TunedDrive(DriveFiles files) : files_{std::move(files)} {
  map_ = daemon::first_map(std::make_shared<const OccupancyGrid>(told_grid(files_.map)));
  if (files_.way.kind == Kind::kReference) reference_ = score::read_reference(files_.way.file);
  if (files_.way.kind == Kind::kRelations) relations_ = score::read_relations(files_.way.file);
  if (files_.way.kind == Kind::kSimulation) truth_ = simulation::read_truth(files_.way.file);
}

std::shared_ptr<const daemon::RecordedDrive> TunedDrive::decoded(const daemon::Settings& settings) {
  const std::string how = daemon::decoding_settings(settings);
  const std::lock_guard lock{decoding_};
  std::shared_ptr<const daemon::RecordedDrive>& drive = decoded_[how];
  if (drive) return drive;
  daemon::ReplayJob job;
  job.recording = files_.recording;
  job.settings = settings;
  job.from_s = files_.from_s;
  job.to_s = files_.to_s;
  drive = std::make_shared<const daemon::RecordedDrive>(daemon::recorded_drive(job));
  return drive;
}

void TunedDrive::forget_decoded() {
  const std::lock_guard lock{decoding_};
  decoded_.clear();
}

bool TunedDrive::is_decoded() const {
  const std::lock_guard lock{decoding_};
  return !decoded_.empty();
}

std::vector<std::pair<std::string, double>> TunedDrive::errors_of(const std::vector<StampedPose>& trajectory,
                                                                  const daemon::Settings& settings) const {
  std::vector<std::pair<std::string, double>> numbers;
  const auto refuse = [&](const char* what) {
    throw std::runtime_error(files_.way.file.string() + ": no " + what + " lies within the time of " +
                             files_.recording.string() + "; is it of another recording?");
  };
  if (files_.way.kind == Kind::kRelations) {
    const score::RelationScore found = score::relation_score(trajectory, relations_);
    if (found.relations == 0) refuse("relation");
    numbers.emplace_back("relation_m", found.translation_m.mean);
    numbers.emplace_back("relation_deg", degrees(found.rotation_rad.mean));
    return numbers;
  }
  if (files_.way.kind == Kind::kNone) return numbers;
  const auto& way =
      files_.way.of_laser ? score::laser_poses(trajectory, settings.laser.session.robot_from_laser) : trajectory;
  const bool is_part = files_.from_s > 0.0 || std::isfinite(files_.to_s);
  const auto reference = files_.way.kind == Kind::kSimulation ? score::reference_at(trajectory, truth_)
                         : is_part                            ? score::reference_within(trajectory, reference_)
                                                              : reference_;
  const score::ReferenceScore found = score::reference_score(way, reference);
  if (found.matched == 0) refuse("pose");
  add(numbers, found);
  return numbers;
}

std::string TunedDrive::identity() const {
  return fingerprint_of_file(files_.recording) + " " + daemon::hex_of(map_.hash) + " " +
         fingerprint_of_file(files_.way.file);
}

}  // namespace deltamap::tool::tune
