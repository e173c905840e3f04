// SPDX-License-Identifier: Apache-2.0
#include "surveying/calibration/motion_calibration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace deltamap::surveying::calibration {
namespace {

constexpr double kSlipShare = 0.05;      // of the segments, before any is seen
constexpr double kSlipVariance = 100.0;  // ten times the deviation
constexpr int kMostRounds = 3000;
constexpr double kSettled = 1e-5;         // relative change of every deviation in a round
constexpr double kLeastVariance = 1e-14;  // below it a deviation counts as none

using Variances = Eigen::Matrix<double, kMotionSources, 1>;
using SourceMatrix = Eigen::Matrix<double, kMotionSources, kMotionSources>;

/// What is believed in one round.
struct Guess {
  Variances variances;
  Eigen::Vector3d scales = Eigen::Vector3d::Zero();
};

/// A segment under a guess.
struct Judged {
  Eigen::Matrix3d information;  ///< inverse of the covariance
  Eigen::Vector3d residual;
  double weight = 1.0;  ///< 1 where the model explains it, 1 / kSlipVariance where it is a slip
  bool is_slip = false;
};

Judged judged(const MotionSegment& segment, const Guess& guess) {
  Eigen::Matrix3d covariance = 1e-12 * Eigen::Matrix3d::Identity();
  for (std::size_t j = 0; j < kMotionSources; ++j) {
    covariance += guess.variances[static_cast<Eigen::Index>(j)] * segment.covariance[j];
  }
  Judged now{covariance.inverse(), segment.disagreement - segment.by_scale * guess.scales};
  const double distance2 = now.residual.dot(now.information * now.residual);
  const double as_model = (1.0 - kSlipShare) * std::exp(-0.5 * distance2);
  const double as_slip = kSlipShare * std::exp(-0.5 * distance2 / kSlipVariance) / std::pow(kSlipVariance, 1.5);
  const double slip = as_slip / (as_model + as_slip);
  now.is_slip = slip > 0.5;
  now.weight = (1.0 - slip) + slip / kSlipVariance;
  return now;
}

/// One round: the scales by weighted least squares, the variances by one step of minorization-maximization.
Guess improved(std::span<const MotionSegment> segments, const Guess& guess, Systematic systematic) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  Variances seen = Variances::Zero();
  Variances expected = Variances::Zero();
  for (const MotionSegment& segment : segments) {
    const Judged now = judged(segment, guess);
    const Eigen::Matrix3d weighted = now.weight * segment.by_scale.transpose() * now.information;
    normal += weighted * segment.by_scale;
    pull += weighted * segment.disagreement;
    const Eigen::Vector3d explained = now.information * now.residual;
    for (std::size_t j = 0; j < kMotionSources; ++j) {
      const auto row = static_cast<Eigen::Index>(j);
      seen[row] += now.weight * explained.dot(segment.covariance[j] * explained);
      expected[row] += (now.information * segment.covariance[j]).trace();
    }
  }
  Guess better = guess;
  if (systematic == Systematic::kTakenOut) better.scales = normal.ldlt().solve(pull);
  for (Eigen::Index j = 0; j < better.variances.size(); ++j) {
    if (expected[j] > 0.0) better.variances[j] *= std::sqrt(seen[j] / expected[j]);
  }
  return better;
}

bool settled(const Guess& before, const Guess& after) {
  for (Eigen::Index j = 0; j < before.variances.size(); ++j) {
    if (after.variances[j] < kLeastVariance) continue;
    if (std::abs(after.variances[j] - before.variances[j]) > 2.0 * kSettled * after.variances[j]) return false;
  }
  return (after.scales - before.scales).norm() < kSettled;
}

struct Information {
  Eigen::Matrix3d scales = Eigen::Matrix3d::Zero();
  SourceMatrix variances = SourceMatrix::Zero();
  double slips = 0.0;
};

/// Fisher's, at the answer.
Information information_at(std::span<const MotionSegment> segments, const Guess& guess) {
  Information sum;
  for (const MotionSegment& segment : segments) {
    const Judged now = judged(segment, guess);
    sum.slips += now.is_slip ? 1.0 : 0.0;
    sum.scales += now.weight * segment.by_scale.transpose() * now.information * segment.by_scale;
    std::array<Eigen::Matrix3d, kMotionSources> whitened;
    for (std::size_t j = 0; j < kMotionSources; ++j) whitened[j] = now.information * segment.covariance[j];
    for (std::size_t j = 0; j < kMotionSources; ++j) {
      for (std::size_t l = 0; l < kMotionSources; ++l) {
        sum.variances(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(l)) +=
            0.5 * now.weight * (whitened[j] * whitened[l]).trace();
      }
    }
  }
  return sum;
}

Fitted fitted(double value, const Eigen::Matrix3d& inverse, Eigen::Index at) {
  return {value, std::sqrt(std::max(0.0, inverse(at, at)))};
}

}  // namespace

MotionCalibration fitted_motion(std::span<const MotionSegment> segments, Systematic systematic) {
  assert(!segments.empty() && "nothing can be fitted to nothing");
  Guess guess;
  guess.variances << 0.01, 0.01, 0.005, 0.0005, 0.0004, 0.0001;
  for (int round = 0; round < kMostRounds; ++round) {
    const Guess better = improved(segments, guess, systematic);
    const bool done = settled(guess, better);
    guess = better;
    if (done) break;
  }
  const Information information = information_at(segments, guess);
  const SourceMatrix spread = information.variances.completeOrthogonalDecomposition().pseudoInverse();
  MotionCalibration calibration;
  for (std::size_t j = 0; j < kMotionSources; ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    const double deviation = guess.variances[row] < kLeastVariance ? 0.0 : std::sqrt(guess.variances[row]);
    // d sqrt(v) = dv / (2 sqrt(v)); near zero the deviation is known to the root of what the variance is known to.
    const double variance_error = information.variances(row, row) > 0.0 ? std::sqrt(std::max(0.0, spread(row, row)))
                                                                        : std::numeric_limits<double>::infinity();
    const double error = std::min(variance_error / (2.0 * std::max(deviation, 1e-9)), std::sqrt(variance_error));
    calibration.deviation[j] = {deviation, error};
  }
  const Eigen::Matrix3d of_scales = information.scales.inverse();
  calibration.wheel_scale = fitted(guess.scales[0], of_scales, 0);
  calibration.turn_scale = fitted(guess.scales[1], of_scales, 1);
  calibration.drift_rad_per_m = fitted(guess.scales[2], of_scales, 2);
  calibration.outlier_share = information.slips / static_cast<double>(segments.size());
  return calibration;
}

}  // namespace deltamap::surveying::calibration
