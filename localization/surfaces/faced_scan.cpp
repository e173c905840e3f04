// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/faced_scan.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "localization/surfaces/surface.hpp"

namespace deltamap::localization::surfaces {
namespace {

constexpr double kChordM = 0.2;          // between the neighbours that give an end its direction, at least
constexpr std::ptrdiff_t kFarthest = 8;  // beams to either side
constexpr double kOnTheLineM = 0.04;     // an end from the chord of its neighbours

constexpr double kShortestFaceM = 0.4;  // that ends at a corner
constexpr int kMostBeamsOfFace = 12;
constexpr int kPassingBeams = 2;  // beside a corner, next to each other
constexpr double kPassM = 0.3;    // farther than the face would be, at least
constexpr double kWidestM = 0.4;  // between the last beam and where the next would meet the face
constexpr double kLeastDeviationM = 0.02;

/// A scan's beams by their number; there may be none of that number.
class Beams {
 public:
  Beams(const Scan& scan, std::span<const RayInRobot> rays) : scan_{scan}, rays_{rays} {}

  [[nodiscard]] std::ptrdiff_t count() const { return std::ssize(rays_); }
  [[nodiscard]] bool is_range(std::ptrdiff_t beam) const {
    return exists(beam) && (*this)[beam].kind == BeamKind::kRange;
  }
  [[nodiscard]] bool exists(std::ptrdiff_t beam) const { return beam >= 0 && beam < count(); }
  [[nodiscard]] const Beam& operator[](std::ptrdiff_t beam) const {
    return scan_.beams[static_cast<std::size_t>(beam)];
  }
  [[nodiscard]] Point2 end_of(std::ptrdiff_t beam) const {
    return rays_[static_cast<std::size_t>(beam)].end.cast<double>();
  }
  [[nodiscard]] Point2 laser_of(std::ptrdiff_t beam) const {
    return rays_[static_cast<std::size_t>(beam)].origin.cast<double>();
  }
  [[nodiscard]] double step_rad() const { return scan_.bearing_step_rad; }
  [[nodiscard]] double max_range_m() const { return scan_.max_range_m; }

 private:
  const Scan& scan_;
  std::span<const RayInRobot> rays_;
};

/// Looks along a scan to one side.
class CornerFinder {
 public:
  CornerFinder(const Beams& beams, std::ptrdiff_t side) : beams_{beams}, side_{side} {}

  /// The corner after this beam, if a face ends with it.
  [[nodiscard]] std::optional<Corner> after(std::ptrdiff_t beam) const {
    if (!is_followed_by_a_gap(beam)) return std::nullopt;
    const std::optional<Point2> along = face_up_to(beam);
    if (!along) return std::nullopt;
    const Point2 laser = beams_.laser_of(beam);
    const Point2 last = beams_.end_of(beam) - laser;
    const Point2 normal{-along->y(), along->x()};
    Point2 next = last;  // where the next beam would meet the face
    for (int k = kPassingBeams; k >= 1; --k) {
      const Point2 way =
          Pose2{0.0, 0.0, static_cast<double>(side_ * k) * beams_.step_rad()} * Point2{last.normalized()};
      const double face_m = normal.dot(last) / normal.dot(way);
      if (!passes(beam + side_ * k, face_m)) return std::nullopt;
      next = face_m * way;
    }
    const double gap_m = (next - last).norm();
    if (gap_m > kWidestM) return std::nullopt;
    return Corner{laser + 0.5 * (last + next), *along, std::hypot(kOfAnyPlace * gap_m, kLeastDeviationM)};
  }

 private:
  /// Cheap, for most beams end beside the next one.
  [[nodiscard]] bool is_followed_by_a_gap(std::ptrdiff_t beam) const {
    if (!beams_.is_range(beam)) return false;
    for (int k = 1; k <= kPassingBeams; ++k) {
      const std::ptrdiff_t next = beam + side_ * k;
      if (beams_.is_range(next) && (beams_.end_of(next) - beams_.end_of(beam)).squaredNorm() < 0.25 * kPassM * kPassM)
        return false;
    }
    return true;
  }

  /// Does a beam go on behind a face that it would meet after `face_m`? Beside it where it would never meet it.
  [[nodiscard]] bool passes(std::ptrdiff_t beam, double face_m) const {
    if (!beams_.exists(beam)) return false;
    if (face_m <= 0.0) return true;
    const Beam& of = beams_[beam];
    if (of.kind == BeamKind::kBeyondMaximum) return beams_.max_range_m() > face_m + kPassM;
    return of.kind == BeamKind::kRange && static_cast<double>(of.range_m) > face_m + kPassM;
  }

  /// Direction of the straight face that ends with this beam, towards its end.
  [[nodiscard]] std::optional<Point2> face_up_to(std::ptrdiff_t beam) const {
    for (int k = 1; k <= kMostBeamsOfFace && beams_.is_range(beam - side_ * k); ++k) {
      const Point2 chord = beams_.end_of(beam) - beams_.end_of(beam - side_ * k);
      if (k == 1 || chord.norm() < kShortestFaceM) continue;
      const Point2 along = chord.normalized();
      const Point2 normal{-along.y(), along.x()};
      for (int j = 1; j < k; ++j) {
        if (std::abs(normal.dot(beams_.end_of(beam - side_ * j) - beams_.end_of(beam))) > kOnTheLineM)
          return std::nullopt;
      }
      return along;
    }
    return std::nullopt;
  }

  const Beams& beams_;
  std::ptrdiff_t side_;  // 1: counter-clockwise, -1: clockwise
};

}  // namespace

std::vector<FacedEnd> faced_ends(const Scan& scan, std::span<const RayInRobot> rays, std::vector<FacedEnd> ends) {
  ends.clear();
  const Beams beams{scan, rays};
  for (std::ptrdiff_t i = 0; i < beams.count(); ++i) {
    if (!beams.is_range(i)) continue;
    FacedEnd faced{beams.end_of(i), {0.0, 0.0}};
    for (std::ptrdiff_t k = 1; k <= kFarthest; ++k) {
      if (!beams.is_range(i - k) || !beams.is_range(i + k)) continue;
      const Point2 chord = beams.end_of(i + k) - beams.end_of(i - k);
      const double length_m = chord.norm();
      if (length_m < kChordM) continue;
      Point2 normal{-chord.y() / length_m, chord.x() / length_m};
      if (std::abs(normal.dot(faced.at - beams.end_of(i - k))) > kOnTheLineM) break;
      if (normal.dot(beams.laser_of(i) - faced.at) < 0.0) normal = -normal;
      faced.normal = normal;
      break;
    }
    ends.push_back(faced);
  }
  return ends;
}

std::vector<Corner> corners_of(const Scan& scan, std::span<const RayInRobot> rays, std::vector<Corner> corners) {
  corners.clear();
  const Beams beams{scan, rays};
  for (const std::ptrdiff_t side : {-1, 1}) {
    const CornerFinder finder{beams, side};
    for (std::ptrdiff_t i = 0; i < beams.count(); ++i) {
      if (const std::optional<Corner> corner = finder.after(i)) corners.push_back(*corner);
    }
  }
  return corners;
}

void FaceFinder::begin(const Scan& scan, std::span<const RayInRobot> rays) {
  scan_ = &scan;
  rays_ = rays;
  keeps_ = nullptr;
  found_ = false;
}

FacedScan FaceFinder::faces() {
  if (scan_ != nullptr && !found_) {
    ends_ = faced_ends(*scan_, rays_, std::move(ends_));
    corners_ = corners_of(*scan_, rays_, std::move(corners_));
    if (keeps_) {
      std::erase_if(ends_, [&](const FacedEnd& end) { return !keeps_(end.at); });
      std::erase_if(corners_, [&](const Corner& corner) { return !keeps_(corner.at); });
    }
    found_ = true;
  }
  return {ends_, corners_, scan_ == nullptr ? kRangeDeviationM : scan_->range_deviation_m};
}

}  // namespace deltamap::localization::surfaces
