// SPDX-License-Identifier: Apache-2.0
// What the first drives through a building have shown, as a graph: keyframes are its nodes, measured motions between
// them its links. All that simultaneous localization and mapping (SLAM) knows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/messages.hpp"
#include "localization/motion/packed_scan.hpp"
#include "mapping/alignment/pose_network.hpp"
#include "mapping/registration/surface.hpp"

namespace deltamap::surveying::slam {

/// A scan that takes part in the map, in its robot's frame.
struct Keyframe {
  localization::motion::PackedScan scan;
  std::uint32_t drive = 0;  ///< which of the drives it belongs to
  double driven_m = 0.0;    ///< along that drive, by the wheels
  Pose2 odom_from_robot;
  std::vector<Eigen::Vector2f> normals;  ///< of each of ends(); zero where it lies on no straight surface

  /// As far as the laser sees.
  [[nodiscard]] std::vector<Point2> ends() const { return scan.ends(kLongestM); }
  /// `visit(end, normal)`, both Eigen::Vector2f, for each of ends().
  template <typename Visit>
  void for_each_end(Visit&& visit) const {
    auto normal = normals.begin();
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.ends_within(i, kLongestM)) visit(scan.end(i), *normal++);
    }
  }
  static constexpr double kLongestM = 80.0;
};
/// Its speeds are those of the sweep. `like`: another one of the same laser, or null.
[[nodiscard]] Keyframe keyframe(const TrackedScan& tracked, std::uint32_t drive, double driven_m,
                                const Keyframe* like = nullptr);

/// Keyframes in order of time, drive by drive. Drives that no link joins have frames of their own.
struct Survey {
  std::vector<Keyframe> keyframes;
  std::vector<Pose2> poses;              ///< of each keyframe, in the frame of its component
  std::vector<std::uint32_t> component;  ///< of each drive: drives of one number share a frame; the first has 0
  std::vector<mapping::alignment::PoseLink> links;   ///< between keyframes
  std::vector<std::vector<std::uint32_t>> links_of;  ///< of each keyframe, as places in `links`

  [[nodiscard]] std::uint32_t component_of(std::uint32_t node) const { return component[keyframes[node].drive]; }
  /// Keyframes in the frame of the first drive.
  [[nodiscard]] std::vector<std::uint32_t> joined_nodes() const;
  /// At the origin of its frame.
  void add(Keyframe keyframe);
  void add(const mapping::alignment::PoseLink& link);
  void remove(std::span<const std::uint32_t> places);
  /// Adds a link to a drive of another frame (link.to), whose keyframes move to where it says.
  void join(const mapping::alignment::PoseLink& link);
  /// Moves all poses to where they agree best with all links; false, and nothing moves, where that does not settle.
  [[nodiscard]] bool solve();
};

/// What some keyframes have seen, in the frame of one of them.
struct Submap {
  std::vector<Point2> ends;  ///< thinned: one in each square
  std::vector<mapping::registration::SurfacePoint> surface;
};
/// Squares of `thinned_m`; 0: all ends.
[[nodiscard]] Submap submap(const Survey& survey, std::span<const std::uint32_t> nodes, std::uint32_t frame,
                            double thinned_m);
/// `first` to `last`, both included.
[[nodiscard]] Submap submap(const Survey& survey, std::uint32_t first, std::uint32_t last, std::uint32_t frame,
                            double thinned_m);

/// The keyframe from which the drive has come `metres` up to this one, and the one where it is so much further.
[[nodiscard]] std::uint32_t back_by(const Survey& survey, std::uint32_t node, double metres);
[[nodiscard]] std::uint32_t on_by(const Survey& survey, std::uint32_t node, double metres);

}  // namespace deltamap::surveying::slam
