// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/lattice_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

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

constexpr double kWithinDeviations = 4.0;

/// A pose stands for all in its block and about its heading.
PoseCovariance of_the_lattice(double block_m, std::size_t headings) {
  const double step_rad = 2.0 * std::numbers::pi / static_cast<double>(headings);
  return (Eigen::Vector3d{block_m * block_m, block_m * block_m, step_rad * step_rad} / 12.0).asDiagonal();
}

struct Interval {
  double from_m = 0.0;
  double to_m = 0.0;
};

/// The x, as offsets from the middle, that lie within the deviations with this y and heading; nothing where none does.
std::optional<Interval> within(const Eigen::Matrix3d& information, double y_m, double turned_rad) {
  const double square = information(0, 0);
  const double linear = information(0, 1) * y_m + information(0, 2) * turned_rad;
  const Eigen::Vector2d others{y_m, turned_rad};
  const double constant =
      others.dot(information.bottomRightCorner<2, 2>() * others) - kWithinDeviations * kWithinDeviations;
  const double discriminant = linear * linear - square * constant;
  if (!(discriminant >= 0.0)) return std::nullopt;
  const double half_m = std::sqrt(discriminant) / square;
  return Interval{-linear / square - half_m, -linear / square + half_m};
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

/// Whatever the order they come in, those are kept that fit best.
void LatticeSearch::keep(const Candidate& candidate) {
  if (best_.size() == most_) {
    if (!fits_better(candidate, best_.front())) return;
    std::pop_heap(best_.begin(), best_.end(), fits_better);
    best_.pop_back();
  }
  best_.push_back(candidate);
  std::push_heap(best_.begin(), best_.end(), fits_better);
}

Candidate LatticeSearch::candidate_at(const sensor::CoarseField& field, const sensor::TurnedBeams& beams,
                                      std::size_t nth_heading, std::uint32_t block, std::int32_t misfit) const {
  const Point2 at = field.centre_of(block);
  const std::size_t blocks = static_cast<std::size_t>(field.columns()) * static_cast<std::size_t>(field.rows());
  return {{at.x(), at.y(), heading_rad(nth_heading)},
          misfit,
          static_cast<std::uint32_t>(nth_heading * blocks + block),
          static_cast<std::uint32_t>(beams.count)};
}

void LatticeSearch::judge(const sensor::CoarseField& field, const sensor::TurnedBeams& beams, std::size_t nth_heading,
                          std::size_t from, std::size_t until) {
  const std::span<const std::uint32_t> blocks = field.free_blocks();
  while (from < until) {
    const std::uint32_t first = blocks[from];
    const std::uint32_t beyond = std::min(first + sensor::CoarseField::kAtOnce, next_row(first, field.columns()));
    const sensor::CoarseMisfits misfits = sensor::coarse_misfits(field, beams, first);
    for (; from < until && blocks[from] < beyond; ++from) {
      const std::int32_t misfit = misfits[blocks[from] - first];
      if (may_keep(misfit)) keep(candidate_at(field, beams, nth_heading, blocks[from], misfit));
    }
  }
}

void LatticeSearch::judge_quads(const sensor::CoarseField& field, const sensor::TurnedBeams& beams,
                                std::size_t nth_heading, std::size_t from, std::size_t until) {
  constexpr std::size_t kAtOnce = sensor::CoarseField::kAtOnce / 2;  // quads, whose blocks are looked at together
  static_assert(sensor::QuadBounds::kAtOnce == 2 * kAtOnce);
  const std::span<const sensor::CoarseField::Quad> quads = field.free_quads();
  while (from < until) {
    const sensor::CoarseField::Quad first = quads[from];
    const auto bounds = field.quads().bounds(beams, first.column, first.row);
    std::array<std::uint32_t, 2> open{};  // bits, of the quads that may hold one of the best
    for (; from < until && quads[from].row == first.row; ++from) {
      const auto nth = static_cast<std::size_t>(quads[from].column - first.column);
      if (nth >= bounds.size()) break;
      if (may_keep(bounds[nth])) open[nth / kAtOnce] |= 1U << (nth % kAtOnce);
    }
    Cell block{2 * first.column, 2 * first.row};
    for (const std::uint32_t of_half : open) {
      if (of_half != 0) {
        judge_row(field, beams, nth_heading, block, of_half);
        judge_row(field, beams, nth_heading, {block.column, block.row + 1}, of_half);
      }
      block.column += sensor::CoarseField::kAtOnce;
    }
  }
}

void LatticeSearch::judge_row(const sensor::CoarseField& field, const sensor::TurnedBeams& beams,
                              std::size_t nth_heading, const Cell& first, std::uint32_t quads) {
  if (first.row >= field.rows()) return;
  const auto block = static_cast<std::uint32_t>(first.row * field.columns() + first.column);
  const sensor::CoarseMisfits misfits = sensor::coarse_misfits(field, beams, block);
  for (std::uint32_t nth = 0; nth < misfits.size(); ++nth) {
    const bool is_open = (quads >> (nth / 2) & 1U) != 0;
    if (!is_open || !may_keep(misfits[nth]) || !field.is_free(first.column + static_cast<int>(nth), first.row))
      continue;
    keep(candidate_at(field, beams, nth_heading, block + nth, misfits[nth]));
  }
}

void LatticeSearch::look(const sensor::CoarseField& field, const motion::BeamEnds& ends, std::size_t count) {
  const std::size_t quads = field.free_quads().size();
  if (quads == 0 || ends.size() == 0) return;
  std::size_t left = (count + kInQuad - 1) / kInQuad;
  next_quad_ = std::min(next_quad_, quads - 1);  // the map may have changed
  while (left > 0) {
    const sensor::TurnedBeams beams = sensor::turned_beams(ends, heading_rad(next_heading_), field.block_m());
    const std::size_t until = std::min(quads, next_quad_ + left);
    judge_quads(field, beams, next_heading_, next_quad_, until);
    left -= until - next_quad_;
    next_quad_ = until;
    if (next_quad_ < quads) continue;
    next_quad_ = 0;
    next_heading_ = (next_heading_ + 1) % headings_;
    if (next_heading_ == 0) return;
  }
}

void LatticeSearch::look_within(const sensor::CoarseField& field, const motion::BeamEnds& ends,
                                const sensor::RefinedPose& prior) {
  if (ends.size() == 0) return;
  const Pose2& middle = prior.map_from_robot;
  const PoseCovariance covariance = prior.covariance + of_the_lattice(field.block_m(), headings_);
  const Eigen::Matrix3d information = covariance.inverse();
  for (std::size_t nth = 0; nth < headings_; ++nth) {
    const double turned_rad = turn_between(middle.theta, heading_rad(nth));
    const sensor::TurnedBeams beams = sensor::turned_beams(ends, heading_rad(nth), field.block_m());
    for (int row = 0; row < field.rows(); ++row) {
      const std::optional<Interval> along = within(information, field.middle_of_row(row) - middle.y, turned_rad);
      if (!along) continue;
      const auto blocks = field.free_in_row(row, middle.x + along->from_m, middle.x + along->to_m);
      judge(field, beams, nth, blocks.first, blocks.past);
    }
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
