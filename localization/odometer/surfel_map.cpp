// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/surfel_map.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::odometer {
namespace {

constexpr double kCellM = 0.25;
constexpr float kRememberedM = 8.0F;
constexpr float kMostSeen = 40.0F;
constexpr float kSameNormal = 0.707F;  // cosine

struct Place {
  std::int32_t column;
  std::int32_t row;
  Eigen::Vector2f in_cell;  // m, from its middle
};

Place place_of(const Point2& at) {
  const double column = std::floor(at.x() / kCellM);
  const double row = std::floor(at.y() / kCellM);
  return {static_cast<std::int32_t>(column),
          static_cast<std::int32_t>(row),
          {static_cast<float>(at.x() - (column + 0.5) * kCellM), static_cast<float>(at.y() - (row + 0.5) * kCellM)}};
}

}  // namespace

SurfelMap::SurfelMap() : surfels_(static_cast<std::size_t>(kSide * kSide * kEach)) {}

void SurfelMap::go_on(double way_m, double time_s) {
  way_m_ = static_cast<float>(way_m);
  time_s_ = static_cast<float>(time_s);
}

bool SurfelMap::is_alive(const Surfel& surfel) const {
  return surfel.seen > 0.0F && way_m_ - surfel.way_m <= kRememberedM;
}

void SurfelMap::insert(std::span<const LinePoint> points, const Pose2& map_from_robot) {
  const auto c = static_cast<float>(std::cos(map_from_robot.theta));
  const auto s = static_cast<float>(std::sin(map_from_robot.theta));
  for (const LinePoint& point : points) {
    if (!point.has_line()) continue;
    const Place place = place_of(map_from_robot * Point2{point.at.cast<double>()});
    const Eigen::Vector2f normal{c * point.normal.x() - s * point.normal.y(),
                                 s * point.normal.x() + c * point.normal.y()};
    Surfel* const slots = &surfels_[slot_of(place.column, place.row)];
    Surfel* chosen = nullptr;
    bool goes_on = false;
    for (int i = 0; i < kEach && !goes_on; ++i) {
      Surfel& surfel = slots[i];
      const bool is_here = is_alive(surfel) && surfel.column == place.column && surfel.row == place.row;
      if (is_here && surfel.normal.dot(normal) > kSameNormal) {
        chosen = &surfel;
        goes_on = true;
      } else if (!is_here) {
        chosen = &surfel;
      } else if (chosen == nullptr || (is_alive(*chosen) && surfel.way_m < chosen->way_m)) {
        chosen = &surfel;
      }
    }
    if (goes_on) {
      const float seen = std::min(kMostSeen, chosen->seen + 1.0F);
      chosen->at += (place.in_cell - chosen->at) / seen;
      chosen->normal = (chosen->normal + (normal - chosen->normal) / seen).normalized();
      chosen->seen = seen;
    } else {
      *chosen = {place.in_cell, normal, place.column, place.row, 1.0F, way_m_, time_s_};
    }
    chosen->way_m = way_m_;
  }
}

NearSurfel SurfelMap::near(const Point2& at, const Eigen::Vector2f& normal, float reach_m) const {
  const Place place = place_of(at);
  const bool has_line = normal.x() != 0.0F || normal.y() != 0.0F;
  // The cell and those beside it towards which the point lies.
  const int side_x = place.in_cell.x() < 0.0F ? -1 : 1;
  const int side_y = place.in_cell.y() < 0.0F ? -1 : 1;
  constexpr auto kCell = static_cast<float>(kCellM);
  NearSurfel nearest;
  float least_m2 = reach_m * reach_m;
  const auto look = [&](int columns, int rows) {
    const std::int32_t column = place.column + columns;
    const std::int32_t row = place.row + rows;
    const Surfel* const slots = &surfels_[slot_of(column, row)];
    for (int i = 0; i < kEach; ++i) {
      const Surfel& surfel = slots[i];
      if (surfel.seen == 0.0F || surfel.column != column || surfel.row != row || !is_alive(surfel)) continue;
      if (has_line && surfel.normal.dot(normal) < kSameNormal) continue;
      const Eigen::Vector2f between =
          place.in_cell - surfel.at -
          Eigen::Vector2f{kCell * static_cast<float>(columns), kCell * static_cast<float>(rows)};
      const float distance_m2 = between.squaredNorm();
      if (distance_m2 >= least_m2) continue;
      least_m2 = distance_m2;
      nearest = {&surfel, surfel.normal.dot(between)};
    }
  };
  look(0, 0);
  look(side_x, 0);
  look(0, side_y);
  look(side_x, side_y);
  if (nearest.surfel != nullptr || reach_m <= 0.5F * kCell) return nearest;
  look(-side_x, 0);
  look(0, -side_y);
  look(-side_x, side_y);
  look(side_x, -side_y);
  look(-side_x, -side_y);
  return nearest;
}

void SurfelMap::forget_since(double time_s) {
  for (Surfel& surfel : surfels_) {
    if (surfel.born_s > static_cast<float>(time_s)) surfel.seen = 0.0F;
  }
}

}  // namespace deltamap::localization::odometer
