// SPDX-License-Identifier: Apache-2.0
// Why particles: after a slip, or before racks that repeat themselves, the belief has several maxima, which one
// Gaussian cannot hold. One particle in sixteen is moved as if the wheels had slipped, so that some already lie where
// a slip has led to.
#include "localization/particles/particle_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "localization/particles/resampling.hpp"
#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::particles {
namespace {

constexpr std::uint32_t kOneInSlips = 16;  // particles that are drawn as if the wheels had slipped

/// L of L Lᵀ = covariance.
Eigen::Matrix3d root_of(const PoseCovariance& covariance) {
  constexpr double kNearlyNothing = 1e-12;
  Eigen::LLT<Eigen::Matrix3d> factors{covariance};
  // A direction is known exactly.
  if (factors.info() != Eigen::Success) factors.compute(covariance + kNearlyNothing * Eigen::Matrix3d::Identity());
  return factors.matrixL();
}

Pose2 drawn_slip(const motion::MotionModelParams& model, double share, Random& random) {
  return {random.normal(share * model.slip_m), random.normal(share * motion::kSlipSideways * model.slip_m),
          random.normal(share * model.slip_rad)};
}

}  // namespace

ParticleFilter::ParticleFilter(const ParticleFilterParams& params, std::uint64_t seed)
    : params_{params}, random_{seed} {
  params_.min = std::max(1, params_.min);
  params_.max = std::max(params_.min, params_.max);
}

Pose2 ParticleFilter::beside(const Pose2& map_from_robot, const Eigen::Matrix3d& root_of_covariance) {
  const double along = random_.normal(1.0);
  const double across = random_.normal(1.0);
  const double turned = random_.normal(1.0);
  const Eigen::Vector3d off = root_of_covariance * Eigen::Vector3d{along, across, turned};
  return {map_from_robot.x + off.x(), map_from_robot.y + off.y(), wrapped_angle(map_from_robot.theta + off.z())};
}

void ParticleFilter::start_around(const Pose2& map_from_robot, const PoseCovariance& covariance, std::size_t count) {
  first_slip_.reset();
  particles_.resize_uniform(count);
  const Eigen::Matrix3d root = root_of(covariance);
  for (std::size_t i = 0; i < count; ++i) particles_.set_pose(i, beside(map_from_robot, root));
}

void ParticleFilter::propose(std::span<const sensor::ProposedPose> poses) {
  const std::size_t count = std::min(poses.size(), particles_.size());
  for (std::size_t i = 0; i < count; ++i) {
    particles_.set_pose(i, poses[i].map_from_robot);
    particles_.log_weight[i] += poses[i].log_prior;
  }
}

void ParticleFilter::move(const Pose2& motion, double unknown_s, const motion::MotionModelParams& model) {
  const motion::TurnDriveTurn turns = motion::turn_drive_turn(motion);
  const motion::MotionNoise noise = motion::motion_noise(turns, unknown_s, model);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_.set_pose(i, motion::sampled_motion(particles_.pose(i), turns, noise, ziggurat_, random_));
  }
  first_slip_.reset();
  if (model.slip_probability > 0.0) let_some_slip(model);
}

void ParticleFilter::let_some_slip(const motion::MotionModelParams& model) {
  // More of them than slips are likely, each with the less weight: only one that fits far better is believed.
  const double log_weight = std::log(model.slip_probability * kOneInSlips);
  first_slip_ = random_.index_below(kOneInSlips);
  for (std::size_t i = *first_slip_; i < particles_.size(); i += kOneInSlips) {
    particles_.set_pose(i, particles_.pose(i) * drawn_slip(model, 1.0, random_));
    particles_.log_weight[i] += log_weight;
  }
}

void ParticleFilter::propose_slips(std::span<const Pose2> map_from_robot) {
  if (!first_slip_) return;
  std::size_t i = *first_slip_;
  for (const Pose2& pose : map_from_robot) {
    if (i >= particles_.size()) return;
    particles_.set_pose(i, pose);
    i += kOneInSlips;
  }
}

bool ParticleFilter::best_has_slipped() const { return first_slip_ && best() % kOneInSlips == *first_slip_; }

void ParticleFilter::spread_chosen(const motion::MotionModelParams& model, double share) {
  const Pose2 kept = particles_.pose(best());
  draw(particles_.size());
  for (std::size_t i = 1; i < particles_.size(); ++i) {
    particles_.set_pose(i, particles_.pose(i) * drawn_slip(model, share, random_));
  }
  particles_.set_pose(0, kept);
}

std::span<const std::int32_t> ParticleFilter::weigh(const sensor::LikelihoodField& field,
                                                    const motion::BeamEnds& ends) {
  assert(ends.size() > 0 && "a scan without ends weighs nothing");
  const double of_a_beam = std::min(1.0, params_.evidence_beams / static_cast<double>(ends.size()));
  const double of_a_step = of_a_beam * sensor::LikelihoodField::kStep;
  const sensor::SegmentBound bound = sensor::segment_bound(field.params(), field.hit_deviation_m(), of_a_beam);
  segments_ = sensor::segmented(ends, bound.fewest, std::move(segments_));
  misfits_.resize(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const sensor::SegmentedMisfit misfit =
        sensor::segmented_misfit(field, ends, segments_, bound.steps, particles_.pose(i));
    misfits_[i] = misfit.all;
    particles_.log_weight[i] -= of_a_step * misfit.bounded;
  }
  normalize_weights();
  return misfits_;
}

void ParticleFilter::normalize_weights() {
  const double best = *std::max_element(particles_.log_weight.begin(), particles_.log_weight.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_.log_weight[i] -= best;
    particles_.weight[i] = std::exp(particles_.log_weight[i]);
    sum += particles_.weight[i];
  }
  for (double& weight : particles_.weight) weight /= sum;
}

double ParticleFilter::n_eff() const { return effective_sample_size(particles_.weight); }

std::size_t ParticleFilter::best() const {
  return static_cast<std::size_t>(std::max_element(particles_.weight.begin(), particles_.weight.end()) -
                                  particles_.weight.begin());
}

bool ParticleFilter::resample_if_needed(std::size_t occupied_cells) {
  if (n_eff() >= params_.resample_below * static_cast<double>(particles_.size())) return false;
  draw(std::clamp(kld_sample_count(occupied_cells, params_.kld_error, params_.kld_quantile),
                  static_cast<std::size_t>(params_.min), static_cast<std::size_t>(params_.max)));
  return true;
}

void ParticleFilter::draw(std::size_t count) {
  choice_ = low_variance_choice(particles_.weight, count, random_.uniform(), std::move(choice_));
  drawn_.resize_uniform(count);
  for (std::size_t i = 0; i < count; ++i) drawn_.set_pose(i, particles_.pose(choice_[i]));
  std::swap(particles_, drawn_);
}

}  // namespace deltamap::localization::particles
