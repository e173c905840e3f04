// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/place_images.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kSame_m = 0.5;
const double kSame_rad = radians(10.0);

}  // namespace

void PlaceImages::note(const Pose2& map_from_believed, const Pose2& map_from_place, double followed_m) {
  const Image seen{.map_from_map = map_from_place * inverse(map_from_believed), .followed_m = followed_m};
  for (Image& image : images_) {
    const Pose2 expected = image.map_from_map * map_from_believed;
    if (distance_between(expected, map_from_place) > kSame_m ||
        std::abs(turn_between(expected.theta, map_from_place.theta)) > kSame_rad) {
      continue;
    }
    image = {.map_from_map = seen.map_from_map, .followed_m = std::max(image.followed_m, followed_m)};
    return;
  }
  if (images_.size() < most_) {
    images_.push_back(seen);
    return;
  }
  const auto least = std::min_element(images_.begin(), images_.end(),
                                      [](const Image& a, const Image& b) { return a.followed_m < b.followed_m; });
  if (least != images_.end() && least->followed_m < followed_m) *least = seen;
}

void PlaceImages::age(double driven_m) {
  for (Image& image : images_) image.driven_since_m += driven_m;
  std::erase_if(images_, [&](const Image& image) { return image.driven_since_m > forgotten_after_m_; });
}

std::optional<Pose2> PlaceImages::next(const Pose2& map_from_believed) {
  if (images_.empty()) return std::nullopt;
  next_ = (next_ + 1) % images_.size();
  return images_[next_].map_from_map * map_from_believed;
}

}  // namespace deltamap::localization::hypotheses
