// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/lattice_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/geometry/angle.hpp"

namespace deltamap::localization::hypotheses {
namespace {

bool fits_better(const Candidate& a, const Candidate& b) {
  return a.misfit != b.misfit ? a.misfit < b.misfit : a.number < b.number;
}

/// About a golden section of the circle: headings looked at in turn lie far apart.
std::size_t spreading_stride(std::size_t headings) {
  auto stride = static_cast<std::size_t>(std::lround(0.382 * static_cast<double>(headings)));
  while (stride > 1 && std::gcd(stride, headings) != 1) --stride;
  return std::max<std::size_t>(1, stride);
}

/// The first block of the row after the block's.
std::uint32_t next_row(std::uint32_t block, int columns) {
  const auto width = static_cast<std::uint32_t>(columns);
  return (block / width + 1) * width;
}

}  // namespace

bool may_reach(const Candidate& candidate, double fit) {
  constexpr double kBetterThanItsBlock = 0.35;  // by headings and blocks that the lattice leaves out
  return -sensor::LikelihoodField::kStep * candidate.misfit / std::max(1U, candidate.beams) >=
         fit - kBetterThanItsBlock;
}

LatticeSearch::LatticeSearch(int headings, std::size_t most)
    : headings_{static_cast<std::size_t>(std::max(1, headings))}, stride_{spreading_stride(headings_)}, most_{most} {
  best_.reserve(most_);
}

void LatticeSearch::clear() { best_.clear(); }

double LatticeSearch::heading_rad(std::size_t nth) const {
  const std::size_t turned = nth * stride_ % headings_;
  return wrapped_angle(2.0 * std::numbers::pi * static_cast<double>(turned) / static_cast<double>(headings_));
}

void LatticeSearch::keep(const Candidate& candidate) {
  if (best_.size() == most_) {
    std::pop_heap(best_.begin(), best_.end(), fits_better);
    best_.pop_back();
  }
  best_.push_back(candidate);
  std::push_heap(best_.begin(), best_.end(), fits_better);
}

void LatticeSearch::look(const sensor::CoarseField& field, const motion::BeamEnds& ends, std::size_t count) {
  const std::span<const std::uint32_t> blocks = field.free_blocks();
  if (blocks.empty() || ends.size() == 0) return;
  next_block_ = std::min(next_block_, blocks.size() - 1);  // the map may have changed
  while (count > 0) {
    const double heading = heading_rad(next_heading_);
    const sensor::TurnedBeams beams = sensor::turned_beams(ends, heading, field.block_m());
    const std::size_t until = std::min(blocks.size(), next_block_ + count);
    count -= until - next_block_;
    while (next_block_ < until) {
      const std::uint32_t first = blocks[next_block_];
      const std::uint32_t beyond = std::min(first + sensor::CoarseField::kAtOnce, next_row(first, field.columns()));
      const sensor::CoarseMisfits misfits = sensor::coarse_misfits(field, beams, first);
      for (; next_block_ < until && blocks[next_block_] < beyond; ++next_block_) {
        const std::int32_t misfit = misfits[blocks[next_block_] - first];
        if (best_.size() == most_ && misfit >= best_.front().misfit) continue;
        const Point2 at = field.centre_of(blocks[next_block_]);
        keep({{at.x(), at.y(), heading},
              misfit,
              static_cast<std::uint32_t>(next_heading_ * blocks.size() + next_block_),
              static_cast<std::uint32_t>(beams.count)});
      }
    }
    if (next_block_ < blocks.size()) continue;
    next_block_ = 0;
    next_heading_ = (next_heading_ + 1) % headings_;
    if (next_heading_ == 0) return;
  }
}

std::vector<Candidate> LatticeSearch::best_apart(std::size_t count) {
  constexpr double kApartM = 0.5;
  const double apart_rad = radians(15.0);
  std::sort(best_.begin(), best_.end(), fits_better);
  std::vector<Candidate> apart;
  for (const Candidate& candidate : best_) {
    if (apart.size() == count) break;
    const Pose2& pose = candidate.map_from_robot;
    const bool known = std::any_of(apart.begin(), apart.end(), [&](const Candidate& other) {
      const double x_m = pose.x - other.map_from_robot.x;
      const double y_m = pose.y - other.map_from_robot.y;
      return x_m * x_m + y_m * y_m < kApartM * kApartM &&
             std::abs(turn_between(pose.theta, other.map_from_robot.theta)) < apart_rad;
    });
    if (!known) apart.push_back(candidate);
  }
  best_.clear();
  return apart;
}

}  // namespace deltamap::localization::hypotheses
