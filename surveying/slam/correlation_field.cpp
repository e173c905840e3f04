// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/correlation_field.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::surveying::slam {
namespace {

constexpr double kDeviationCells = 1.5;
constexpr std::uint8_t kFull = 255;    // where an end lies itself
constexpr int kStampCells = 4;         // beyond, an end is as good as none
constexpr double kLeastArmM = 3.0;     // ends nearer than that do not ask for coarser steps of heading
constexpr std::size_t kAtOnce = 32;    // ends, before it is asked whether the others can make up for them
constexpr double kElsewhereM = 0.6;    // farther from the best pose is another place
constexpr double kElsewhereRad = 0.2;  // and so is this turn

/// The scan's ends at one heading, as cells with the robot in the middle of the window.
struct Rotation {
  double heading_rad = 0.0;
  std::vector<Cell> cells;
};

/// A square of 2^level × 2^level shifts of one rotation, by its lowest corner.
struct Branch {
  std::size_t rotation = 0;
  int column = 0;
  int row = 0;
  std::uint32_t bound = 0;
};

class BranchAndBound {
 public:
  BranchAndBound(const CorrelationField& field, std::span<const Point2> ends, const SearchWindow& window)
      : field_{field}, window_{window}, reach_{static_cast<int>(std::ceil(window.position_m / field.resolution_m()))} {
    double squares = 0.0;
    for (const Point2& end : ends) squares += end.squaredNorm();
    const double arm_m = std::max(kLeastArmM, std::sqrt(squares / static_cast<double>(ends.size())));
    const double step_rad = field.resolution_m() / arm_m;
    const int steps = static_cast<int>(std::ceil(window.heading_rad / step_rad));
    for (int i = -steps; i <= steps; ++i) {
      Rotation rotation{window.centre.theta + i * step_rad, {}};
      rotation.cells.reserve(ends.size());
      const Pose2 at{window.centre.x, window.centre.y, rotation.heading_rad};
      for (const Point2& end : ends) rotation.cells.push_back(field.cell_at(at * end));
      rotations_.push_back(std::move(rotation));
    }
  }

  /// The best shift of a rotation whose sum is above `least`; `avoided`: not the same place as that.
  [[nodiscard]] std::optional<Branch> best(std::uint32_t least, const Branch* avoided) const {
    int level = 0;
    while (level + 1 < field_.levels() && (1 << (level + 1)) <= 2 * reach_ + 1) ++level;
    std::vector<Branch> branches;
    for (std::size_t i = 0; i < rotations_.size(); ++i) {
      for (int row = -reach_; row <= reach_; row += 1 << level) {
        for (int column = -reach_; column <= reach_; column += 1 << level) {
          const Branch branch{i, column, row, sum_of(level, i, column, row, least)};
          if (branch.bound > least) branches.push_back(branch);
        }
      }
    }
    std::optional<Branch> found;
    descend(level, branches, least, avoided, found);
    return found;
  }

  [[nodiscard]] Pose2 pose_of(const Branch& leaf) const {
    return {window_.centre.x + leaf.column * field_.resolution_m(), window_.centre.y + leaf.row * field_.resolution_m(),
            wrapped_angle(rotations_[leaf.rotation].heading_rad)};
  }

  [[nodiscard]] bool is_at_rim(const Branch& leaf) const {
    return std::abs(leaf.column) == reach_ || std::abs(leaf.row) == reach_ || leaf.rotation == 0 ||
           leaf.rotation + 1 == rotations_.size();
  }

 private:
  /// 0 where it cannot be above `least`.
  [[nodiscard]] std::uint32_t sum_of(int level, std::size_t rotation, int column, int row, std::uint32_t least) const {
    const std::vector<Cell>& cells = rotations_[rotation].cells;
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < cells.size();) {
      for (const std::size_t last = std::min(cells.size(), i + kAtOnce); i < last; ++i) {
        sum += field_.most_from(level, cells[i].column + column, cells[i].row + row);
      }
      if (sum + kFull * (cells.size() - i) <= least) return 0;
    }
    return sum;
  }

  void descend(int level, std::vector<Branch>& branches, std::uint32_t& least, const Branch* avoided,
               std::optional<Branch>& found) const {
    std::stable_sort(branches.begin(), branches.end(),
                     [](const Branch& a, const Branch& b) { return a.bound > b.bound; });
    for (const Branch& branch : branches) {
      if (branch.bound <= least) return;
      if (level == 0) {
        if (avoided != nullptr && is_same_place(branch, *avoided)) continue;
        found = branch;
        least = branch.bound;
        continue;
      }
      const int half = 1 << (level - 1);
      std::vector<Branch> parts;
      for (const Cell& part : {Cell{0, 0}, Cell{half, 0}, Cell{0, half}, Cell{half, half}}) {
        const int column = branch.column + part.column;
        const int row = branch.row + part.row;
        if (column > reach_ || row > reach_) continue;
        const Branch below{branch.rotation, column, row, sum_of(level - 1, branch.rotation, column, row, least)};
        if (below.bound > least) parts.push_back(below);
      }
      descend(level - 1, parts, least, avoided, found);
    }
  }

  [[nodiscard]] bool is_same_place(const Branch& a, const Branch& b) const {
    const double away_m = field_.resolution_m() * std::hypot(a.column - b.column, a.row - b.row);
    const double turn = turn_between(rotations_[a.rotation].heading_rad, rotations_[b.rotation].heading_rad);
    return away_m <= kElsewhereM && std::abs(turn) <= kElsewhereRad;
  }

  const CorrelationField& field_;
  const SearchWindow& window_;
  int reach_;  // cells to each side
  std::vector<Rotation> rotations_;
};

/// Values around an end, row by row.
std::vector<std::uint8_t> stamp_of_an_end() {
  std::vector<std::uint8_t> stamp;
  for (int y = -kStampCells; y <= kStampCells; ++y) {
    for (int x = -kStampCells; x <= kStampCells; ++x) {
      const double value = kFull * std::exp(-0.5 * (x * x + y * y) / (kDeviationCells * kDeviationCells));
      stamp.push_back(static_cast<std::uint8_t>(std::lround(value)));
    }
  }
  return stamp;
}

}  // namespace

CorrelationField::CorrelationField(std::span<const Point2> ends, double resolution_m, int levels)
    : resolution_m_{resolution_m} {
  Level finest;
  if (!ends.empty()) {
    Point2 low = ends.front();
    Point2 high = low;
    for (const Point2& end : ends) {
      low = low.cwiseMin(end);
      high = high.cwiseMax(end);
    }
    corner_ = low - Point2::Constant(kStampCells * resolution_m);
    const Cell last = cell_at(high + Point2::Constant(kStampCells * resolution_m));
    finest.width = last.column + 1;
    finest.height = last.row + 1;
  }
  finest.values.assign(static_cast<std::size_t>(finest.width) * static_cast<std::size_t>(finest.height), 0);
  const std::vector<std::uint8_t> stamp = stamp_of_an_end();
  for (const Point2& end : ends) {
    const Cell cell = cell_at(end);
    if (finest.values[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(finest.width) +
                      static_cast<std::size_t>(cell.column)] == kFull)
      continue;  // an end lies there already
    const std::uint8_t* from = stamp.data();
    for (int y = cell.row - kStampCells; y <= cell.row + kStampCells; ++y) {
      for (int x = cell.column - kStampCells; x <= cell.column + kStampCells; ++x, ++from) {
        if (x < 0 || y < 0 || x >= finest.width || y >= finest.height) continue;
        std::uint8_t& value = finest.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(finest.width) +
                                            static_cast<std::size_t>(x)];
        value = std::max(value, *from);
      }
    }
  }
  levels_.push_back(std::move(finest));
  for (int level = 1; level < levels; ++level) levels_.push_back(coarser(levels_.back(), 1 << (level - 1)));
}

Cell CorrelationField::cell_at(const Point2& place) const {
  const Point2 cells = (place - corner_) / resolution_m_;
  return {static_cast<int>(std::floor(cells.x())), static_cast<int>(std::floor(cells.y()))};
}

CorrelationField::Level CorrelationField::coarser(const Level& of, int reach) {
  Level level{of.width + reach, of.height + reach, of.border + reach, {}};
  level.values.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
  // The same place of the finer level lies `reach` further in; around it there is nothing.
  const auto width = static_cast<std::size_t>(of.width);
  const auto margin = static_cast<std::size_t>(reach);
  std::vector<std::uint8_t> both_rows(width + 2 * margin, 0);
  const auto row_of = [&](int y) {
    return y < 0 || y >= of.height ? nullptr : of.values.data() + static_cast<std::size_t>(y) * width;
  };
  for (int y = 0; y < level.height; ++y) {
    const std::uint8_t* const here = row_of(y - reach);
    const std::uint8_t* const above = row_of(y);
    for (std::size_t x = 0; x < width; ++x) {
      both_rows[margin + x] = std::max<std::uint8_t>(here == nullptr ? 0 : here[x], above == nullptr ? 0 : above[x]);
    }
    std::uint8_t* const made =
        level.values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width);
    for (std::size_t x = 0; x < width + margin; ++x) made[x] = std::max(both_rows[x], both_rows[x + margin]);
  }
  return level;
}

std::optional<CorrelativeMatch> best_match(const CorrelationField& field, std::span<const Point2> ends,
                                           const SearchWindow& window, double least_score, double near_share) {
  if (ends.empty()) return std::nullopt;
  const double full = kFull * static_cast<double>(ends.size());
  const BranchAndBound search{field, ends, window};
  const std::optional<Branch> best = search.best(static_cast<std::uint32_t>(least_score * full), nullptr);
  if (!best) return std::nullopt;
  CorrelativeMatch match{search.pose_of(*best), best->bound / full, search.is_at_rim(*best), 0.0};
  if (near_share >= 1.0) return match;
  if (const auto other = search.best(static_cast<std::uint32_t>(near_share * best->bound), &*best)) {
    match.elsewhere = other->bound / full;
  }
  return match;
}

}  // namespace deltamap::surveying::slam
