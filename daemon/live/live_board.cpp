// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/live_board.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/particles/particle_sample.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kSamplePeriod_s = 1.0;
constexpr std::size_t kParticlesShown = 256;  // more are a blot on the page

std::int16_t centimetres(float length_m) {
  constexpr float kMost_cm = 32000.0F;
  if (!std::isfinite(length_m)) return 0;
  return static_cast<std::int16_t>(std::lround(std::clamp(100.0F * length_m, -kMost_cm, kMost_cm)));
}

}  // namespace

template <typename Item>
void LiveBoard::Ring<Item>::add(const Item& item) {
  const auto place = static_cast<std::size_t>(count_ % capacity_);
  if (place < items_.size()) {
    items_[place] = item;
  } else {
    items_.push_back(item);
  }
  ++count_;
}

template <typename Item>
LiveBoard::Past<Item> LiveBoard::Ring<Item>::from(std::uint64_t number, std::size_t most) const {
  const std::uint64_t oldest = count_ - items_.size();
  Past<Item> past{.first = std::clamp(number, oldest, count_), .items = {}};
  const std::uint64_t end = past.first + std::min<std::uint64_t>(most, count_ - past.first);
  for (std::uint64_t i = past.first; i < end; ++i) {
    past.items.push_back(items_[static_cast<std::size_t>(i % capacity_)]);
  }
  return past;
}

std::vector<LiveBeam> beams_of(const TrackedScan& tracked) {
  std::vector<LiveBeam> beams;
  const std::size_t count = std::min(tracked.rays.size(), tracked.scan.beams.size());
  beams.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (tracked.scan.beams[i].kind != BeamKind::kRange) continue;
    const Eigen::Vector2f& end = tracked.rays[i].end;
    beams.push_back({centimetres(end.x()), centimetres(end.y())});
  }
  return beams;
}

LiveBoard::LiveBoard(std::shared_ptr<const OccupancyGrid> map, std::uint32_t revision, const Kept& kept)
    : map_{std::move(map)}, revision_{revision}, samples_{kept.samples}, changes_{kept.changes} {}

void LiveBoard::show(const TrackedScan& tracked, const LocalizationRow& row, double latency_s,
                     const localization::particles::ParticleSet* particles) {
  ++scans_seen_;
  const bool is_sampled = is_due(last_sample_, row.time, kSamplePeriod_s);
  const bool is_watched = this->is_watched();
  if (!is_sampled && !is_watched) return;
  std::vector<Pose2> sample;
  if (is_watched && particles != nullptr) sample = localization::particles::sampled_poses(*particles, kParticlesShown);
  const std::unique_lock lock{mutex_, std::try_to_lock};
  if (!lock.owns_lock()) return;
  keep_scan(tracked, row, latency_s);
  if (is_sampled) keep_sample(row, latency_s);
  scan_.particles = std::move(sample);
}

void LiveBoard::keep_scan(const TrackedScan& tracked, const LocalizationRow& row, double latency_s) {
  scan_.number = scans_seen_;
  scan_.row = row;
  scan_.latency_s = latency_s;
  scan_.beams = beams_of(tracked);
}

void LiveBoard::keep_sample(const LocalizationRow& row, double latency_s) {
  const double passed_s = seconds(row.time - last_sample_);
  const bool is_first = scans_at_sample_ == 0;
  const auto scans = static_cast<double>(scans_seen_ - scans_at_sample_);
  LiveSample sample{.time = row.time};
  const auto set = [&sample](LiveSample::Column column, double value) {
    sample.values[column] = static_cast<float>(value);
  };
  set(LiveSample::kX, row.map_from_robot.x);
  set(LiveSample::kY, row.map_from_robot.y);
  const bool has_return = !scan_.beams.empty();  // else the weight is an older scan's
  set(LiveSample::kWAvg, has_return ? row.w_avg : LiveFigures::kUnknown);
  set(LiveSample::kWFast, row.w_fast);
  set(LiveSample::kWSlow, row.w_slow);
  set(LiveSample::kRD, row.r_d);
  set(LiveSample::kNEff, row.n_eff);
  set(LiveSample::kPoseRight, row.belief.pose_right);
  set(LiveSample::kMapWrong, row.belief.map_wrong);
  set(LiveSample::kScansPerSecond, passed_s > 0.0 ? scans / passed_s : LiveFigures::kUnknown);
  set(LiveSample::kLatency, 1e3 * latency_s);
  add_figures(sample, passed_s);
  last_sample_ = row.time;
  scans_at_sample_ = scans_seen_;
  if (!is_first) samples_.add(sample);  // rates need a sample before
}

/// Adds CPU shares since the sample before, memory and wheels. Processor time is divided by the time of the scans,
/// which in a live run is real time; where the scans' time has gone back, the shares are unknown.
void LiveBoard::add_figures(LiveSample& sample, double passed_s) {
  constexpr double kBytesPerMiB = 1024.0 * 1024.0;
  const LiveFigures now = figures_();
  for (std::size_t i = 0; i < now.cpu_s.size(); ++i) {
    const double used_s = now.cpu_s[i] - figures_at_sample_.cpu_s[i];
    const double share = passed_s > 0.0 ? used_s / passed_s : LiveFigures::kUnknown;
    sample.values[LiveSample::kCpuIo + i] = static_cast<float>(100.0 * share);
  }
  sample.values[LiveSample::kMemory] = static_cast<float>(now.resident_bytes / kBytesPerMiB);
  sample.values[LiveSample::kWheelDistance] = static_cast<float>(100.0 * now.wheel_distance);
  sample.values[LiveSample::kWheelTurn] = static_cast<float>(100.0 * now.wheel_turn);
  figures_at_sample_ = now;
}

void LiveBoard::set_figures(std::function<LiveFigures()> figures) {
  const std::scoped_lock lock{mutex_};
  figures_ = std::move(figures);
}

void LiveBoard::watch(bool is_watched) {
  const std::scoped_lock lock{mutex_};
  is_watched_.store(is_watched, std::memory_order_relaxed);
  if (!is_watched) stored_ = {};
}

void LiveBoard::show(mapping::StoredScans stored) {
  const std::unique_lock lock{mutex_, std::try_to_lock};
  if (lock.owns_lock() && is_watched()) stored_ = std::move(stored);
}

mapping::StoredScans LiveBoard::stored() const {
  const std::scoped_lock lock{mutex_};
  return stored_;
}

bool LiveBoard::show(const std::shared_ptr<const TransientObstacles>& transients) {
  const std::unique_lock lock{mutex_, std::try_to_lock};
  if (!lock.owns_lock()) return false;
  transients_ = transients;
  return true;
}

void LiveBoard::show(const MapRevision* revision, const ChangeNote& note) {
  const std::scoped_lock lock{mutex_};
  changes_.add(note);
  ++(note.revision ? change_counts_.accepted : change_counts_.refused);
  if (revision == nullptr) return;
  map_ = revision->map;
  revision_ = revision->number;
  if (const CellBox box = bounding_box(revision->changes); !box.empty()) boxes_.add(box);
}

LiveBoard::Map LiveBoard::map(std::uint64_t from) const {
  const std::scoped_lock lock{mutex_};
  return {.grid = map_, .revision = revision_, .changed = boxes_.from(from, kBoxesKept)};
}

bool LiveBoard::fetch(LiveScan& scan) const {
  const std::scoped_lock lock{mutex_};
  if (scan_.number <= scan.number) return false;
  scan = scan_;
  return true;
}

std::shared_ptr<const TransientObstacles> LiveBoard::transients() const {
  const std::scoped_lock lock{mutex_};
  return transients_;
}

LiveBoard::Past<LiveSample> LiveBoard::samples_from(std::uint64_t number, std::size_t most) const {
  const std::scoped_lock lock{mutex_};
  return samples_.from(number, most);
}

LiveBoard::Past<ChangeNote> LiveBoard::changes_from(std::uint64_t number, std::size_t most) const {
  const std::scoped_lock lock{mutex_};
  return changes_.from(number, most);
}

LiveBoard::ChangeCounts LiveBoard::change_counts() const {
  const std::scoped_lock lock{mutex_};
  return change_counts_;
}

}  // namespace deltamap::daemon
