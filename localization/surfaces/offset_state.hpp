// SPDX-License-Identifier: Apache-2.0
// One Gaussian over the robot's pose, the systematic errors of its wheels and of the laser's mount and, for each
// surface that is followed, how far it stands from where the map has it: offset along its normal, m, and turn, rad.
#pragma once

#include <Eigen/Core>
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
    const Eigen::Matrix<double, Eigen::Dynamic, kCount> left = covariance_.middleCols<kCount>(first);
    const Square inner = covariance_.block<kCount, kCount>(first, first);
    const Square gain = precision * (Square::Identity() + inner * precision).inverse();
    const Eigen::Matrix<double, kCount, 1> here = mean_.segment<kCount>(first);
    mean_ += left * ((Square::Identity() - gain * inner) * pull - gain * here);
    const Eigen::Matrix<double, Eigen::Dynamic, kCount> weighed = left * gain;
    for (Eigen::Index column = 0; column < covariance_.cols(); ++column) {  // too thin for a general product to pay
      const Eigen::Index below = covariance_.rows() - column;
      for (int k = 0; k < kCount; ++k)
        covariance_.col(column).tail(below) -= left(column, k) * weighed.col(k).tail(below);
    }
    mirror_lower_half();
  }

  [[nodiscard]] const Eigen::VectorXd& mean() const { return mean_; }
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }
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
  void mirror_lower_half();

  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

}  // namespace deltamap::localization::surfaces
