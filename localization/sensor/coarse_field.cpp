// SPDX-License-Identifier: Apache-2.0
// Compiled with -O3: sixteen blocks side by side are summed up by a few instructions (SSE2).
#include "localization/sensor/coarse_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace deltamap::localization::sensor {
namespace {

constexpr auto kBeforeColumns = static_cast<std::int16_t>(-CoarseField::kAtOnce);
constexpr std::int16_t kBeforeRows = -1;

}  // namespace

CoarseField::CoarseField(const OccupancyGrid& map, const LikelihoodField& field, double block_m)
    : lattice_{map.geometry(), std::max(1, static_cast<int>(std::lround(block_m / map.resolution_m())))},
      block_m_{lattice_.blocks().resolution_m},
      window_{field.window()} {
  const CellBox blocks = window_.empty() ? CellBox{} : lattice_.blocks_of(window_);
  first_block_ = blocks.first;
  columns_ = blocks.width();
  rows_ = blocks.height();
  origin_ = lattice_.blocks().origin + block_m_ * Point2{first_block_.column, first_block_.row};
  const auto area = static_cast<std::size_t>(padded_columns()) * static_cast<std::size_t>(rows_ + 2);
  bytes_.assign(area, field.bordered().bytes[0]);
  quads_ = QuadBounds{columns_, rows_, field.bordered().bytes[0]};
  free_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), false);
  update(map, field, window_);
}

void CoarseField::update(const OccupancyGrid& map, const LikelihoodField& field, const CellBox& changed) {
  if (changed.empty()) return;
  if (!(field.window() == window_)) {
    *this = CoarseField{map, field, block_m_};
    return;
  }
  const CellBox blocks = lattice_.blocks_of(changed);
  const auto of_each = [&](auto&& look) {
    for (int row = blocks.first.row - first_block_.row; row < blocks.last.row - first_block_.row; ++row) {
      for (int column = blocks.first.column; column < blocks.last.column; ++column)
        look(column - first_block_.column, row);
    }
  };
  of_each([&](int column, int row) { look_at(map, field, column, row); });
  of_each([&](int column, int row) { quads_.look_at(column, row, [&](int x, int y) { return *from(x, y); }); });
  list_free_blocks();
}

bool CoarseField::is_free(const OccupancyGrid& map, int column, int row) const {
  const Cell first = cells_of(column, row).first;
  const int half = lattice_.cells_per_block() / 2;
  const Cell middle{first.column + half, first.row + half};
  for (int y = middle.row - 1; y <= middle.row; ++y) {
    for (int x = middle.column - 1; x <= middle.column; ++x) {
      if (map.at({x, y}) == CellState::kFree) return true;
    }
  }
  return map.at(middle) == CellState::kFree;
}

void CoarseField::look_at(const OccupancyGrid& map, const LikelihoodField& field, int column, int row) {
  const CellBox cells = cells_of(column, row);
  const CellBox held = common(cells, window_);
  const LikelihoodField::Bordered fine = field.bordered();
  std::uint8_t best = held == cells ? 255 : fine.bytes[0];
  for (int y = held.first.row; y < held.last.row; ++y) {
    const std::uint8_t* const from = fine.bytes + static_cast<std::ptrdiff_t>(y - window_.first.row + 1) * fine.width +
                                     (held.first.column - window_.first.column + 1);
    best = std::min(best, *std::min_element(from, from + held.width()));
  }
  const auto at = static_cast<std::size_t>(row + 1) * static_cast<std::size_t>(padded_columns());
  bytes_[at + static_cast<std::size_t>(column + kAtOnce)] = best;
  free_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)] =
      is_free(map, column, row);
}

void CoarseField::list_free_blocks() {
  free_blocks_.clear();
  free_quads_.clear();
  for (std::size_t i = 0; i < free_.size(); ++i) {
    if (free_[i]) free_blocks_.push_back(static_cast<std::uint32_t>(i));
  }
  for (int row = 0; row < rows_; row += 2) {
    for (int column = 0; column < columns_; column += 2) {
      const bool any =
          is_free(column, row) || is_free(column + 1, row) || is_free(column, row + 1) || is_free(column + 1, row + 1);
      if (any) free_quads_.push_back({static_cast<std::int16_t>(column / 2), static_cast<std::int16_t>(row / 2)});
    }
  }
}

Point2 CoarseField::centre_of(std::uint32_t block) const {
  const auto columns = static_cast<std::uint32_t>(columns_);
  const std::uint32_t column = block % columns;
  const std::uint32_t row = block / columns;
  return {origin_.x() + (column + 0.5) * block_m_, origin_.y() + (row + 0.5) * block_m_};
}

CoarseField::Run CoarseField::free_in_row(int row, double from_m, double to_m) const {
  const auto first_beyond = [&](double x_m) {
    const double columns =
        std::clamp(std::ceil((x_m - origin_.x()) / block_m_ - 0.5), 0.0, static_cast<double>(columns_));
    const auto block = static_cast<std::uint32_t>(row * columns_ + static_cast<int>(columns));
    return static_cast<std::size_t>(std::lower_bound(free_blocks_.begin(), free_blocks_.end(), block) -
                                    free_blocks_.begin());
  };
  return {first_beyond(from_m), first_beyond(to_m)};
}

/// In 16 bits throughout: eight beams an instruction.
CoarseField::Places CoarseField::places_of(const TurnedBeams& beams, int column, int row) const {
  assert(std::max(columns_, rows_) < TurnedBeams::kFarthest && "a beam's block must fit 16 bits");
  const auto own_column = static_cast<std::int16_t>(column);
  const auto own_row = static_cast<std::int16_t>(row);
  const auto beyond_column = static_cast<std::int16_t>(columns_);
  const auto beyond_row = static_cast<std::int16_t>(rows_);
  const auto width = static_cast<std::int16_t>(padded_columns());
  Places places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto x = static_cast<std::int16_t>(own_column + beams.columns[i]);
    const auto y = static_cast<std::int16_t>(own_row + beams.rows[i]);
    const std::int16_t in_column = std::clamp(x, kBeforeColumns, beyond_column);
    const std::int16_t in_row = std::clamp(y, kBeforeRows, beyond_row);
    places[i] = (in_row + 1) * width + in_column + kAtOnce;
  }
  return places;
}

CoarseMisfits coarse_misfits(const CoarseField& field, const TurnedBeams& beams, std::uint32_t block) {
  static_assert(TurnedBeams::kMost * 255 <= std::numeric_limits<std::uint16_t>::max());
  const auto columns = static_cast<std::uint32_t>(field.columns());
  const auto own_column = static_cast<int>(block % columns);
  const auto own_row = static_cast<int>(block / columns);
  const CoarseField::Places places = field.places_of(beams, own_column, own_row);
  CoarseMisfits sums{};
  for (std::size_t beam = 0; beam < beams.count; ++beam) {
    const std::uint8_t* const steps = field.bytes() + places[beam];
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + steps[i]);
  }
  return sums;
}

}  // namespace deltamap::localization::sensor
