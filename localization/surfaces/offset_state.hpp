// SPDX-License-Identifier: Apache-2.0
// One Gaussian over the robot's pose, the systematic errors of its wheels and of the laser's mount and, for each
// surface that is followed, how far it stands from where the map has it: offset along its normal, m, and turn, rad.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "localization/motion/drive_calibration.hpp"
#include "localization/sensor/pose_refinement.hpp"

namespace deltamap::localization::surfaces {

/// Squared deviations beyond which a measurement is of something else than was expected.
inline constexpr double kInnovationGate = 16.0;

/// A row of a measurement's Jacobian: most of it is zero.
struct SparseRow {
  struct Entry {
    Eigen::Index index;
    double value;
  };
  std::array<Entry, 8> entries;
  std::size_t count;

  [[nodiscard]] std::span<const Entry> used() const { return {entries.data(), count}; }
};

/// row · state was found to be greater than expected by `innovation`.
struct RowMeasurement {
  SparseRow row;
  double innovation;
  double variance;
};

class OffsetState {
 public:
  static constexpr Eigen::Index kPose = 3;
  static constexpr Eigen::Index kMount = 3;   ///< three entries from there, after the pose
  static constexpr Eigen::Index kPosed = 6;   ///< pose and mount
  static constexpr Eigen::Index kWheels = 6;  ///< four
  static constexpr Eigen::Index kFixed = 10;  ///< pose, mount and wheels

  OffsetState();
  /// No surface is followed. What was learned of the wheels and the mount is kept.
  void start(const sensor::RefinedPose& at);

  /// What an earlier run has learned of wheels and mount; both may have changed since, as over a kilometre.
  void restore(const motion::DriveCalibration& learned);

  /// Pose, mount and wheels alone.
  [[nodiscard]] OffsetState without_surfaces() const;

  /// The robot's motion, by the wheels and what is known of their errors.
  [[nodiscard]] Pose2 corrected(const motion::WheelStep& step) const;
  /// `added`: covariance of the step's own noise, map frame.
  void predict(const motion::WheelStep& step, const PoseCovariance& added);

  /// The wheels have slipped: the pose is less sure. Surfaces stay where they are.
  void widen(const PoseCovariance& slip) { covariance_.topLeftCorner<kPose, kPose>() += slip; }

  /// Follows one more surface, expected at `offset_m` with these deviations.
  void append(double offset_m, double deviation_m, double deviation_rad);
  /// Ceases to follow surface number `surface`: what it has told of the pose stays.
  void remove(std::size_t surface);

  /// A measurement of the pose, with the mount as it is known. False where that is too far off: nothing has changed.
  bool update(const sensor::RefinedPose& seen);
  /// Independent measurements, all taken at the same state.
  void update(std::span<const RowMeasurement> measurements);
  /// As a factor: precision and precision · mean, over kCount entries from `first` on.
  template <int kCount>
  void multiply(Eigen::Index first, const Eigen::Matrix<double, kCount, kCount>& precision,
                const Eigen::Matrix<double, kCount, 1>& pull) {
    using Square = Eigen::Matrix<double, kCount, kCount>;
    const Eigen::Matrix<double, Eigen::Dynamic, kCount> left = columns<kCount>(first);
    const Square inner = covariance_at<kCount>(first);
    const Square gain = precision * (Square::Identity() + inner * precision).inverse();
    const Eigen::Matrix<double, kCount, 1> here = mean_.segment<kCount>(first);
    mean_ += left * ((Square::Identity() - gain * inner) * pull - gain * here);
    subtract_product<kCount>(left * gain, left);
  }

  [[nodiscard]] const Eigen::VectorXd& mean() const { return mean_; }
  [[nodiscard]] double covariance(Eigen::Index i, Eigen::Index k) const {
    return covariance_(std::max(i, k), std::min(i, k));
  }
  /// Of kCount entries from `first` on.
  template <int kCount>
  [[nodiscard]] Eigen::Matrix<double, kCount, kCount> covariance_at(Eigen::Index first) const {
    return covariance_.block<kCount, kCount>(first, first).template selfadjointView<Eigen::Lower>();
  }
  [[nodiscard]] Eigen::MatrixXd covariance() const { return covariance_.selfadjointView<Eigen::Lower>(); }
  /// Where the offset of a surface stands in mean and covariance; its turn follows.
  [[nodiscard]] static Eigen::Index offset_of(std::size_t surface) {
    return kFixed + 2 * static_cast<Eigen::Index>(surface);
  }
  [[nodiscard]] sensor::RefinedPose pose() const;
  /// How pose and mount move where a scan lies in the map.
  [[nodiscard]] Eigen::Matrix<double, 3, 6> scan_by_pose_and_mount() const;
  [[nodiscard]] motion::DriveCalibration calibration() const;
  [[nodiscard]] bool is_sound() const { return mean_.allFinite() && covariance_.diagonal().minCoeff() >= 0.0; }

 private:
  template <int kCount>
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, kCount> columns(Eigen::Index first) const {
    const Eigen::Index after = covariance_.rows() - first - kCount;
    Eigen::Matrix<double, Eigen::Dynamic, kCount> columns{covariance_.rows(), kCount};
    columns.topRows(first) = covariance_.block(first, 0, kCount, first).transpose();
    columns.template middleRows<kCount>(first) = covariance_at<kCount>(first);
    columns.bottomRows(after) = covariance_.block(first + kCount, first, after, kCount);
    return columns;
  }
  /// a · bᵀ, which is symmetric, from the covariance. Column by column: only half of it is wanted.
  template <int kCount>
  void subtract_product(const Eigen::Matrix<double, Eigen::Dynamic, kCount>& a,
                        const Eigen::Matrix<double, Eigen::Dynamic, kCount>& b) {
    for (Eigen::Index column = 0; column < covariance_.cols(); ++column) {
      auto below = covariance_.col(column).tail(covariance_.rows() - column);
      if constexpr (kCount == Eigen::Dynamic) {
        below.noalias() -= a.bottomRows(below.size()) * b.row(column).transpose();
      } else {  // too thin for a general product to pay
        for (int k = 0; k < kCount; ++k) below -= b(column, k) * a.col(k).tail(below.size());
      }
    }
  }

  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;  // its lower half: nothing of the upper one is read
};

}  // namespace deltamap::localization::surfaces
