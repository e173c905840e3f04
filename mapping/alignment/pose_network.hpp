// SPDX-License-Identifier: Apache-2.0
// The network of poses and spatial relations (paper §3.3; Lu and Milios 1997, §3): finds the poses that agree best with
// all relations at once, each weighed by its covariance. Linearized, solved by sparse Cholesky, and repeated. Relations
// that contradict the others (χ²) are dropped.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace deltamap::mapping::alignment {

/// The pose of `to` as seen from `from`, measured.
struct PoseLink {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  Pose2 from_from_to;
  PoseCovariance covariance = PoseCovariance::Identity();  ///< of its (x, y, θ); positive definite
  bool may_drop = true;                                    ///< false: odometry, which holds the network together
};

/// What is known about a pose in the network's frame. At least one holds the network in place.
struct PoseAnchor {
  std::uint32_t pose = 0;
  Pose2 frame_from_pose;
  PoseCovariance covariance = PoseCovariance::Identity();
};

struct PoseNetworkParams {
  int most_iterations = 10;
  double settled = 1e-6;          ///< a step below this (m and rad) ends the iteration
  int most_dropping_rounds = 20;  ///< of the worst link whose χ² is above kMostChi2; 0: all links hold
  bool wants_covariances = true;  ///< false: left empty; they cost as much as all else in a large network
};

struct PoseNetwork {
  std::vector<Pose2> poses;
  std::vector<PoseCovariance> covariances;  ///< marginal, of each pose's (x, y, θ) in the frame
  std::vector<std::uint32_t> dropped;       ///< indices of links, in the order of dropping
  bool solved = false;  ///< false: not held together, or no convergence; the poses are the initial ones
};

/// `initial` places every pose near enough for linearization.
[[nodiscard]] PoseNetwork solved_network(std::span<const Pose2> initial, std::span<const PoseLink> links,
                                         std::span<const PoseAnchor> anchors, const PoseNetworkParams& params);

/// Predicted less measured relation, and its derivatives by (x, y, θ) of both poses.
struct LinkError {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_from = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_to = Eigen::Matrix3d::Zero();
};
[[nodiscard]] LinkError link_error(const Pose2& from, const Pose2& to, const Pose2& measured_from_from_to);
/// Squared deviations between a link and the poses that it joins; above kMostChi2 it contradicts them.
[[nodiscard]] double link_chi2(const PoseLink& link, std::span<const Pose2> poses);

}  // namespace deltamap::mapping::alignment
