// SPDX-License-Identifier: Apache-2.0
// Why a network: matches that are chained one to the next add up their errors, so that the last scan of a set
// disagrees with the first. Least squares over all relations spread the contradiction by covariance. The worst
// relation is dropped alone and the rest solved again, because one wrong match makes others look wrong.
#include "mapping/alignment/pose_network.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/geometry/pose_spread.hpp"
#include "mapping/alignment/sparse_cholesky.hpp"

namespace deltamap::mapping::alignment {
namespace {

struct NetworkSums {
  std::vector<SymmetricBlock> blocks;
  Eigen::VectorXd right_side;
};

/// Σ JᵀC⁻¹J δ = -Σ JᵀC⁻¹e over links and anchors (Lu and Milios' Eq. 6 to 9).
NetworkSums sums_over_network(const std::vector<Pose2>& poses, std::span<const PoseLink> links,
                              const std::vector<char>& is_kept, std::span<const PoseAnchor> anchors) {
  NetworkSums sums;
  sums.blocks.reserve(3 * links.size() + anchors.size());
  sums.right_side = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * poses.size()));
  const auto right_side_of = [&](std::uint32_t pose) {
    return sums.right_side.segment<3>(3 * static_cast<Eigen::Index>(pose));
  };
  for (const PoseAnchor& anchor : anchors) {
    const Eigen::Matrix3d information = anchor.covariance.inverse();
    const Eigen::Vector3d error = difference(anchor.frame_from_pose, poses[anchor.pose]);
    sums.blocks.push_back({anchor.pose, anchor.pose, information});
    right_side_of(anchor.pose) -= information * error;
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (is_kept[i] == 0) continue;
    const PoseLink& link = links[i];
    const LinkError at = link_error(poses[link.from], poses[link.to], link.from_from_to);
    const Eigen::Matrix3d information = link.covariance.inverse();
    const Eigen::Matrix3d from_weighted = at.by_from.transpose() * information;
    const Eigen::Matrix3d to_weighted = at.by_to.transpose() * information;
    sums.blocks.push_back({link.from, link.from, from_weighted * at.by_from});
    sums.blocks.push_back({link.to, link.to, to_weighted * at.by_to});
    if (link.to > link.from) {
      sums.blocks.push_back({link.to, link.from, to_weighted * at.by_from});
    } else {
      sums.blocks.push_back({link.from, link.to, from_weighted * at.by_to});
    }
    right_side_of(link.from) -= from_weighted * at.error;
    right_side_of(link.to) -= to_weighted * at.error;
  }
  return sums;
}

/// Gauss–Newton from where the poses are; false where it does not settle.
bool settle(std::vector<Pose2>& poses, std::span<const PoseLink> links, const std::vector<char>& is_kept,
            std::span<const PoseAnchor> anchors, const PoseNetworkParams& params, SparseCholesky& cholesky) {
  for (int i = 0; i < params.most_iterations; ++i) {
    const NetworkSums sums = sums_over_network(poses, links, is_kept, anchors);
    if (!cholesky.factorize(poses.size(), sums.blocks)) return false;
    const Eigen::VectorXd step = cholesky.solve(sums.right_side);
    if (!step.allFinite()) return false;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const auto delta = step.segment<3>(3 * static_cast<Eigen::Index>(k));
      poses[k] = {poses[k].x + delta.x(), poses[k].y + delta.y(), wrapped_angle(poses[k].theta + delta.z())};
    }
    if (step.cwiseAbs().maxCoeff() < params.settled) return true;
  }
  return false;
}

/// The link that contradicts the solution most, or links.size() where all are within bounds.
std::size_t worst_link(const std::vector<Pose2>& poses, std::span<const PoseLink> links,
                       const std::vector<char>& is_kept) {
  std::size_t worst = links.size();
  double worst_chi2 = kMostChi2;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (is_kept[i] == 0 || !links[i].may_drop) continue;
    const double chi2 = link_chi2(links[i], poses);
    if (chi2 > worst_chi2) {
      worst = i;
      worst_chi2 = chi2;
    }
  }
  return worst;
}

std::vector<PoseCovariance> marginal_covariances(std::size_t count, const SparseCholesky& cholesky) {
  std::vector<PoseCovariance> covariances;
  covariances.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto at = 3 * static_cast<Eigen::Index>(k);
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(count), 3);
    unit.block<3, 3>(at, 0).setIdentity();
    const Eigen::Matrix3d covariance = cholesky.solve(unit).block<3, 3>(at, 0);
    covariances.emplace_back(0.5 * (covariance + covariance.transpose()));
  }
  return covariances;
}

}  // namespace

LinkError link_error(const Pose2& from, const Pose2& to, const Pose2& measured_from_from_to) {
  const double c = std::cos(from.theta);
  const double s = std::sin(from.theta);
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  LinkError at;
  at.error = {c * dx + s * dy - measured_from_from_to.x, -s * dx + c * dy - measured_from_from_to.y,
              turn_between(measured_from_from_to.theta, to.theta - from.theta)};
  at.by_from << -c, -s, -s * dx + c * dy,  //
      s, -c, -c * dx - s * dy,             //
      0.0, 0.0, -1.0;
  at.by_to << c, s, 0.0,  //
      -s, c, 0.0,         //
      0.0, 0.0, 1.0;
  return at;
}

double link_chi2(const PoseLink& link, std::span<const Pose2> poses) {
  return squared_deviations(link_error(poses[link.from], poses[link.to], link.from_from_to).error, link.covariance);
}

PoseNetwork solved_network(std::span<const Pose2> initial, std::span<const PoseLink> links,
                           std::span<const PoseAnchor> anchors, const PoseNetworkParams& params) {
  PoseNetwork network;
  network.poses.assign(initial.begin(), initial.end());
  if (initial.empty()) return network;
  std::vector<char> is_kept(links.size(), 1);
  SparseCholesky cholesky;
  std::vector<Pose2> poses = network.poses;
  for (int round = 0;; ++round) {
    if (!settle(poses, links, is_kept, anchors, params, cholesky)) return network;
    const std::size_t worst = params.most_dropping_rounds == 0 ? links.size() : worst_link(poses, links, is_kept);
    if (worst == links.size()) break;
    if (round == params.most_dropping_rounds) return network;
    is_kept[worst] = 0;
    network.dropped.push_back(static_cast<std::uint32_t>(worst));
  }
  network.poses = std::move(poses);
  if (params.wants_covariances) network.covariances = marginal_covariances(network.poses.size(), cholesky);
  network.solved = true;
  return network;
}

}  // namespace deltamap::mapping::alignment
