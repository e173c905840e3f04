// SPDX-License-Identifier: Apache-2.0
// Why: a sweep at half a degree takes two turns of the mirror, 27 ms. A robot that turns by 1 rad/s turns by 1.5
// degrees meanwhile, which moves a beam's end 10 m away by a quarter of a metre and bends walls.
#include "localization/motion/deskew.hpp"

#include <cmath>

namespace deltamap::localization::motion {

Point2 laser_at(const Pose2& robot_from_laser, const BodyVelocity& velocity, double offset_s) {
  const double turned_rad = velocity.turn_rate_rad_per_s * offset_s;
  const double driven_m = velocity.speed_m_per_s * offset_s;
  // An arc: the chord lies along half the turn, and the whole turn's sine and cosine follow from the half's.
  const double c = std::cos(0.5 * turned_rad);
  const double s = std::sin(0.5 * turned_rad);
  const Point2 turned{1.0 - 2.0 * s * s, 2.0 * s * c};
  return {driven_m * c + turned.x() * robot_from_laser.x - turned.y() * robot_from_laser.y,
          driven_m * s + turned.y() * robot_from_laser.x + turned.x() * robot_from_laser.y};
}

std::vector<RayInRobot> deskewed(const Scan& scan, const BodyVelocity& velocity) {
  std::vector<RayInRobot> rays(scan.beams.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Beam& beam = scan.beams[i];
    const auto offset_s = static_cast<double>(beam.offset_s);
    const Point2 origin = laser_at(scan.robot_from_laser, velocity, offset_s);
    rays[i].origin = origin.cast<float>();
    rays[i].end = rays[i].origin;
    if (beam.kind != BeamKind::kRange) continue;
    const double direction_rad =
        velocity.turn_rate_rad_per_s * offset_s + scan.robot_from_laser.theta + scan.bearing_rad(i);
    const Point2 along{std::cos(direction_rad), std::sin(direction_rad)};
    rays[i].end = (origin + static_cast<double>(beam.range_m) * along).cast<float>();
  }
  return rays;
}

BeamEnds scoring_ends(const Scan& scan, const std::vector<RayInRobot>& rays, int beams, BeamEnds ends) {
  ends.x_m.clear();
  ends.y_m.clear();
  ends.range_deviation_m = scan.range_deviation_m;
  std::size_t valid = 0;
  for (const Beam& beam : scan.beams) valid += beam.kind == BeamKind::kRange ? 1 : 0;
  const std::size_t wanted = beams <= 0 ? valid : static_cast<std::size_t>(beams);
  std::size_t nth = 0;  // among the valid ones
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    if (scan.beams[i].kind != BeamKind::kRange) continue;
    const bool due = wanted >= valid || (nth + 1) * wanted / valid > nth * wanted / valid;
    ++nth;
    if (!due) continue;
    ends.x_m.push_back(rays[i].end.x());
    ends.y_m.push_back(rays[i].end.y());
  }
  return ends;
}

}  // namespace deltamap::localization::motion
