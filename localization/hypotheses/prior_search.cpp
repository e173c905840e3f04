// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/prior_search.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "localization/hypotheses/hypothesis_bank.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr std::size_t kSlid = 200;         // to their best fit: as many as in a scan of a global search
constexpr std::size_t kMostProposed = 64;  // each takes the place of a particle

}  // namespace

std::vector<sensor::ProposedPose> poses_within(const sensor::RefinedPose& prior, const sensor::CoarseField& coarse,
                                               const sensor::LikelihoodField& field, const GlobalSearch::Ends& ends,
                                               int headings) {
  LatticeSearch lattice{headings, LatticeSearch::kKeptForEach * kSlid};
  lattice.look_within(coarse, ends.near, prior);
  const Eigen::Matrix3d information = prior.covariance.inverse();
  struct Found {
    sensor::ProposedPose proposed;
    double log_posterior;
  };
  std::vector<Found> found;
  for (const Candidate& candidate : lattice.best_apart(kSlid)) {
    const Pose2 pose = settled(field, ends.all, candidate.map_from_robot);
    const Eigen::Vector3d off = difference(prior.map_from_robot, pose);
    const double log_prior = -0.5 * off.dot(information * off);
    const double evidence = HypothesisBank::kEvidenceOfABeam * static_cast<double>(ends.all.size()) *
                            mean_log_likelihood(field, ends.all, pose);
    found.push_back({{pose, log_prior}, log_prior + evidence});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.log_posterior > b.log_posterior; });
  std::vector<sensor::ProposedPose> proposed;
  for (std::size_t i = 0; i < std::min(found.size(), kMostProposed); ++i) proposed.push_back(found[i].proposed);
  return proposed;
}

}  // namespace deltamap::localization::hypotheses
