// SPDX-License-Identifier: Apache-2.0
// Compiled with -O3: sixteen cells side by side are compared by one instruction (SSE2).
#include "surveying/slam/correlation_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/geometry/points_in_map.hpp"

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
  std::span<const Cell> cells;
  Cell first;  // of the box around them
  Cell last;
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
    cells_.reserve((2 * static_cast<std::size_t>(steps) + 1) * ends.size());  // rotations look into them
    for (int i = -steps; i <= steps; ++i) rotations_.push_back(rotated(ends, window.centre.theta + i * step_rad));
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
    std::stable_sort(branches.begin(), branches.end(), is_better);
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
  static bool is_better(const Branch& a, const Branch& b) { return a.bound > b.bound; }

  Rotation rotated(std::span<const Point2> ends, double heading_rad) {
    const std::size_t before = cells_.size();
    const PointsInMap in_field{{window_.centre.x, window_.centre.y, heading_rad}};
    for (const Point2& end : ends) cells_.push_back(field_.cell_at(in_field(end)));
    Rotation rotation{heading_rad, std::span{cells_}.subspan(before), cells_[before], cells_[before]};
    for (const Cell& cell : rotation.cells) {
      rotation.first = {std::min(rotation.first.column, cell.column), std::min(rotation.first.row, cell.row)};
      rotation.last = {std::max(rotation.last.column, cell.column), std::max(rotation.last.row, cell.row)};
    }
    return rotation;
  }

  /// 0 where it cannot be above `least`.
  [[nodiscard]] std::uint32_t sum_of(int level, std::size_t rotation, int column, int row, std::uint32_t least) const {
    const Rotation& of = rotations_[rotation];
    const CorrelationField::Level& at = field_.level(level);
    const std::uint8_t* const values = at.values();
    if (at.reaches(of.first.column + column, of.first.row + row) &&
        at.reaches(of.last.column + column, of.last.row + row)) {
      const std::ptrdiff_t middle = at.index_of(column, row);
      const std::ptrdiff_t stride = at.stride();
      return sum_over(of.cells, least,
                      [=](const Cell& cell) { return values[middle + cell.row * stride + cell.column]; });
    }
    return sum_over(of.cells, least, [&](const Cell& cell) {
      const bool is_reached = at.reaches(cell.column + column, cell.row + row);
      return is_reached ? values[at.index_of(cell.column + column, cell.row + row)] : std::uint8_t{0};
    });
  }

  template <typename ValueOf>
  [[nodiscard]] static std::uint32_t sum_over(std::span<const Cell> cells, std::uint32_t least, ValueOf&& value_of) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < cells.size();) {
      for (const std::size_t last = std::min(cells.size(), i + kAtOnce); i < last; ++i) sum += value_of(cells[i]);
      if (sum + kFull * (cells.size() - i) <= least) return 0;
    }
    return sum;
  }

  /// `branches`: the best first.
  void descend(int level, std::span<const Branch> branches, std::uint32_t& least, const Branch* avoided,
               std::optional<Branch>& found) const {
    for (const Branch& branch : branches) {
      if (branch.bound <= least) return;
      if (level == 0) {
        if (avoided != nullptr && is_same_place(branch, *avoided)) continue;
        found = branch;
        least = branch.bound;
        continue;
      }
      const int half = 1 << (level - 1);
      std::array<Branch, 4> parts;
      std::size_t count = 0;
      for (const Cell& part : {Cell{0, 0}, Cell{half, 0}, Cell{0, half}, Cell{half, half}}) {
        const int column = branch.column + part.column;
        const int row = branch.row + part.row;
        if (column > reach_ || row > reach_) continue;
        const Branch below{branch.rotation, column, row, sum_of(level - 1, branch.rotation, column, row, least)};
        if (below.bound <= least) continue;
        const auto place = std::upper_bound(parts.begin(), parts.begin() + count, below, is_better);
        std::move_backward(place, parts.begin() + count, parts.begin() + count + 1);
        *place = below;
        ++count;
      }
      descend(level - 1, std::span{parts}.first(count), least, avoided, found);
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
  std::vector<Cell> cells_;
  std::vector<Rotation> rotations_;
};

constexpr std::size_t kSideBySide = 16;  // cells
using StampRow = std::array<std::uint8_t, kSideBySide>;
static_assert(2 * kStampCells + 1 <= kSideBySide);

/// Values around an end, row by row; 0 beyond.
std::array<StampRow, 2 * kStampCells + 1> stamp_of_an_end() {
  std::array<StampRow, 2 * kStampCells + 1> stamp{};
  int y = -kStampCells;
  for (StampRow& row : stamp) {
    for (int x = -kStampCells; x <= kStampCells; ++x) {
      const double value = kFull * std::exp(-0.5 * (x * x + y * y) / (kDeviationCells * kDeviationCells));
      row.at(static_cast<unsigned>(x + kStampCells)) = static_cast<std::uint8_t>(std::lround(value));
    }
    ++y;
  }
  return stamp;
}

void raise_to(const StampRow& least, std::uint8_t* values) {
  StampRow raised;
  std::memcpy(raised.data(), values, raised.size());
  for (std::size_t i = 0; i < raised.size(); ++i) raised[i] = std::max(raised[i], least[i]);
  std::memcpy(values, raised.data(), raised.size());
}

}  // namespace

CorrelationField::Level::Level(int width, int height, int border)
    : width_{width},
      height_{height},
      border_{border},
      values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + kSideBySide, 0) {}

CorrelationField::CorrelationField(std::span<const Point2> ends, double resolution_m, int levels)
    : resolution_m_{resolution_m} {
  constexpr int kMargin = kStampCells + 1;  // whatever rounding does
  Cell last{-1, -1};
  if (!ends.empty()) {
    Point2 low = ends.front();
    Point2 high = low;
    for (const Point2& end : ends) {
      low = low.cwiseMin(end);
      high = high.cwiseMax(end);
    }
    corner_ = low - Point2::Constant(kMargin * resolution_m);
    last = cell_at(high + Point2::Constant(kMargin * resolution_m));
  }
  levels_.push_back(Level{last.column + 1, last.row + 1, 0});
  for (const Point2& end : ends) levels_.front().lay_around(cell_at(end));
  for (int level = 1; level < levels; ++level) levels_.push_back(levels_.back().coarser(1 << (level - 1)));
}

void CorrelationField::Level::lay_around(Cell end) {
  static const std::array<StampRow, 2 * kStampCells + 1> stamp = stamp_of_an_end();
  if (row(end.row)[end.column] == kFull) return;  // an end lies there already
  int y = end.row - kStampCells;
  for (const StampRow& of : stamp) raise_to(of, row(y++) + end.column - kStampCells);
}

CorrelationField::Level CorrelationField::Level::coarser(int reach) const {
  Level made{width_ + reach, height_ + reach, border_ + reach};
  // The same place of the finer level lies `reach` further in; around it there is nothing.
  const auto width = static_cast<std::size_t>(width_);
  const auto margin = static_cast<std::size_t>(reach);
  const std::vector<std::uint8_t> nothing(width, 0);
  std::vector<std::uint8_t> both_rows(width + 2 * margin, 0);
  const auto row_of = [&](int y) {
    return y < 0 || y >= height_ ? nothing.data() : values_.data() + static_cast<std::size_t>(y) * width;
  };
  const auto larger = [](const std::uint8_t* a, const std::uint8_t* b, std::size_t count, std::uint8_t* of_both) {
    for (std::size_t x = 0; x < count; ++x) of_both[x] = std::max(a[x], b[x]);
  };
  for (int y = 0; y < made.height_; ++y) {
    larger(row_of(y - reach), row_of(y), width, both_rows.data() + margin);
    larger(both_rows.data(), both_rows.data() + margin, width + margin, made.row(y));
  }
  return made;
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
