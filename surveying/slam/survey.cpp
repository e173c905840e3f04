// SPDX-License-Identifier: Apache-2.0
// Why a graph: a loop that closes moves all poses, while the motions that were measured between two keyframes stay as
// they were. So these are kept, and the poses are solved from them again.
#include "surveying/slam/survey.hpp"

#include <cmath>
#include <numeric>
#include <unordered_set>
#include <utility>

#include "core/geometry/points_in_map.hpp"

namespace deltamap::surveying::slam {
namespace {

constexpr double kAnchorVariance = 1e-6;  // of the first keyframe of a component: it gives the frame
/// Which links are wrong is not for the solver to say.
constexpr mapping::alignment::PoseNetworkParams kSolving{
    .most_iterations = 30, .settled = 1e-4, .most_dropping_rounds = 0, .wants_covariances = false};

}  // namespace

Keyframe keyframe(const TrackedScan& tracked, std::uint32_t drive, double driven_m, const Keyframe* like) {
  const localization::motion::BodyVelocity velocity{tracked.speed_m_per_s, tracked.turn_rate_rad_per_s};
  Keyframe made{
      {tracked.scan, velocity, like == nullptr ? nullptr : &like->scan}, drive, driven_m, tracked.odom_from_robot, {}};
  made.normals = mapping::registration::normals_of(made.ends());
  return made;
}

std::vector<std::uint32_t> Survey::joined_nodes() const {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t node = 0; node < keyframes.size(); ++node) {
    if (component_of(node) == 0) nodes.push_back(node);
  }
  return nodes;
}

void Survey::add(Keyframe keyframe) {
  keyframes.push_back(std::move(keyframe));
  poses.emplace_back();
  links_of.emplace_back();
}

void Survey::add(const mapping::alignment::PoseLink& link) {
  const auto place = static_cast<std::uint32_t>(links.size());
  links.push_back(link);
  links_of[link.from].push_back(place);
  links_of[link.to].push_back(place);
}

void Survey::remove(std::span<const std::uint32_t> places) {
  std::vector<mapping::alignment::PoseLink> kept;
  const std::unordered_set<std::uint32_t> removed{places.begin(), places.end()};
  for (std::uint32_t place = 0; place < links.size(); ++place) {
    if (!removed.contains(place)) kept.push_back(links[place]);
  }
  links.clear();
  for (auto& of : links_of) of.clear();
  for (const mapping::alignment::PoseLink& link : kept) add(link);
}

void Survey::join(const mapping::alignment::PoseLink& link) {
  const std::uint32_t drive = keyframes[link.to].drive;
  const Pose2 from_drive = poses[link.from] * link.from_from_to * inverse(poses[link.to]);
  for (std::uint32_t node = 0; node < keyframes.size(); ++node) {
    if (keyframes[node].drive == drive) poses[node] = from_drive * poses[node];
  }
  component[drive] = component_of(link.from);
  add(link);
}

bool Survey::solve() {
  std::vector<mapping::alignment::PoseAnchor> anchors;
  std::unordered_set<std::uint32_t> held;  // components
  for (std::uint32_t node = 0; node < keyframes.size(); ++node) {
    if (!held.insert(component_of(node)).second) continue;
    anchors.push_back({node, poses[node], kAnchorVariance * PoseCovariance::Identity()});
  }
  mapping::alignment::PoseNetwork network = mapping::alignment::solved_network(poses, links, anchors, kSolving);
  if (network.solved) poses = std::move(network.poses);
  return network.solved;
}

Submap submap(const Survey& survey, std::uint32_t first, std::uint32_t last, std::uint32_t frame, double thinned_m) {
  std::vector<std::uint32_t> nodes(last - first + 1);
  std::iota(nodes.begin(), nodes.end(), first);
  return submap(survey, nodes, frame, thinned_m);
}

Submap submap(const Survey& survey, std::span<const std::uint32_t> nodes, std::uint32_t frame, double thinned_m) {
  Submap made;
  std::size_t most = 0;
  for (const std::uint32_t node : nodes) most += survey.keyframes[node].normals.size();
  made.ends.reserve(thinned_m > 0.0 ? 0 : most);
  made.surface.reserve(most);
  std::unordered_set<std::uint64_t> taken;
  const auto is_new = [&](const Point2& end) {
    if (thinned_m <= 0.0) return true;
    const auto square = [&](double metres) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(metres / thinned_m)));
    };
    return taken.insert((std::uint64_t{square(end.x())} << 32U) | square(end.y())).second;
  };
  for (const std::uint32_t node : nodes) {
    const Pose2 frame_from_node = motion_between(survey.poses[frame], survey.poses[node]);
    const PointsInMap in_frame{frame_from_node};
    const PointsInMap turned{{0.0, 0.0, frame_from_node.theta}};
    survey.keyframes[node].for_each_end([&](const Eigen::Vector2f& end, const Eigen::Vector2f& normal) {
      const Point2 place = in_frame(end);
      if (is_new(place)) made.ends.push_back(place);
      if (!normal.isZero(0.0F)) made.surface.push_back({place, turned(normal)});
    });
  }
  return made;
}

std::uint32_t back_by(const Survey& survey, std::uint32_t node, double metres) {
  const Keyframe& end = survey.keyframes[node];
  while (node > 0 && survey.keyframes[node - 1].drive == end.drive &&
         end.driven_m - survey.keyframes[node - 1].driven_m <= metres) {
    --node;
  }
  return node;
}

std::uint32_t on_by(const Survey& survey, std::uint32_t node, double metres) {
  const Keyframe& begin = survey.keyframes[node];
  while (node + 1 < survey.keyframes.size() && survey.keyframes[node + 1].drive == begin.drive &&
         survey.keyframes[node + 1].driven_m - begin.driven_m <= metres) {
    ++node;
  }
  return node;
}

}  // namespace deltamap::surveying::slam
