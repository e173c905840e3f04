// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/packed_scan.hpp"

#include <algorithm>

#include "localization/motion/deskew.hpp"

namespace deltamap::localization::motion {
namespace {

constexpr float kNoRange = -1.0F;

}  // namespace

PackedScan::PackedScan(const Scan& scan, const BodyVelocity& velocity, const PackedScan* like)
    : time_{scan.time}, range_deviation_m_{scan.range_deviation_m}, velocity_{velocity} {
  Sweep sweep{scan.robot_from_laser, {}};
  sweep.offsets_s.reserve(scan.beams.size());
  ranges_m_.reserve(scan.beams.size());
  ends_.reserve(scan.beams.size());
  for (const Beam& beam : scan.beams) {
    sweep.offsets_s.push_back(beam.offset_s);
    ranges_m_.push_back(beam.kind == BeamKind::kRange ? std::max(0.0F, beam.range_m) : kNoRange);
  }
  for (const RayInRobot& ray : deskewed(scan, velocity)) ends_.push_back(ray.end);
  const bool is_alike = like != nullptr && like->sweep_ && *like->sweep_ == sweep;
  sweep_ = is_alike ? like->sweep_ : std::make_shared<const Sweep>(std::move(sweep));
}

std::vector<Point2> PackedScan::ends(double longest_m) const {
  std::vector<Point2> ends;
  ends.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) {
    if (ends_within(i, longest_m)) ends.emplace_back(ends_[i].cast<double>());
  }
  return ends;
}

TrackedScan PackedScan::tracked() const {
  TrackedScan tracked;
  tracked.scan.time = time_;
  tracked.scan.range_deviation_m = range_deviation_m_;
  tracked.scan.beams.resize(size());
  tracked.rays.resize(size());
  for (std::size_t i = 0; i < size(); ++i) {
    const float offset_s = sweep_->offsets_s[i];
    if (ranges_m_[i] >= 0.0F) tracked.scan.beams[i] = {ranges_m_[i], offset_s, BeamKind::kRange};
    const Point2 origin = laser_at(sweep_->robot_from_laser, velocity_, static_cast<double>(offset_s));
    tracked.rays[i] = {origin.cast<float>(), ends_[i]};
  }
  return tracked;
}

}  // namespace deltamap::localization::motion
