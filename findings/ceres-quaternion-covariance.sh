#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: an attitude that was measured to 0.1 rad, estimated by Ceres as a quaternion on its QuaternionManifold or
#   EigenQuaternionManifold, has a covariance of 0.01 rad^2 in the tangent space: three numbers for three turns.
# Seen: it has 0.0025. The tangent space is that of half the angle: a step of 0.1 turns by 0.2 rad. The covariance is a quarter of
#   what the words promise, and its cross terms with the position are half, while those of the position itself are right.
# Matters: the standard weight of a pose edge (twice the vector part, over sigma) goes in as radians, and what comes out for a gate,
#   a fusion or a g2o file is in half radians: the heading looks twice as sure as it is, and right headings are refused.
#   Multiply by 4 (and cross terms by 2), but look at the version: the newest source is said to step by the whole angle (1190).
# Version: Ceres 2.1.0 (libceres3 2.1.0+really2.1.0+dfsg-1). Source: the formula of Plus in manifold.h says cos(|delta|), not half
#   of it; nnls_covariance.rst, on the tangent space, has no word of it; ceres-solver's issues 311 and 1190.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libceres3=2.1.0+really2.1.0+dfsg-1
debian_files libceres-dev=2.1.0+really2.1.0+dfsg-1 libeigen3-dev=3.4.0-4 libgoogle-glog-dev=0.6.0-2 libgflags-dev=2.2.2-2
cat > attitude.cpp << 'CPP'
#include <ceres/covariance.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>

#include <cmath>
#include <cstdio>

// The usual residual: twice the vector part of the rotation that is left (here from a measured 0), over 0.1 rad.
struct Measured : ceres::SizedCostFunction<3, 4> {
  explicit Measured(int first) : first_(first) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    for (int row = 0; row < 3; ++row) {
      residuals[row] = 2.0 * parameters[0][first_ + row] / 0.1;
      for (int column = 0; jacobians != nullptr && jacobians[0] != nullptr && column < 4; ++column)
        jacobians[0][4 * row + column] = column == first_ + row ? 2.0 / 0.1 : 0.0;
    }
    return true;
  }
  int first_;
};

void print(const char* name, ceres::Manifold* manifold, int scalar) {
  const double step[] = {0.1, 0.0, 0.0};
  const int first = scalar == 0 ? 1 : 0;
  double attitude[4] = {}, turned[4], variance[9] = {};
  attitude[scalar] = 1.0;
  manifold->Plus(attitude, step, turned);
  ceres::Problem problem;
  problem.AddParameterBlock(attitude, 4, manifold);
  problem.AddResidualBlock(new Measured(first), nullptr, attitude);
  ceres::Covariance covariance{ceres::Covariance::Options()};
  if (!covariance.Compute(std::vector<const double*>{attitude}, &problem)) return;
  covariance.GetCovarianceBlockInTangentSpace(attitude, attitude, variance);
  std::printf("%s %.4f %.4f %.4f, a step of 0.1 turns by %.3f; ", name, variance[0], variance[4], variance[8],
              2.0 * std::atan2(turned[first], turned[scalar]));
}

int main() {
  print("wxyz", new ceres::QuaternionManifold, 0);
  print("xyzw", new ceres::EigenQuaternionManifold, 3);
}
CPP
compiled attitude.cpp -isystem "$root/usr/include/eigen3" -lceres -lglog -Wl,--allow-shlib-undefined
expected='wxyz 0.0025 0.0025 0.0025, a step of 0.1 turns by 0.200; '
stated 'measured to 0.1 rad' "${expected}xyzw ${expected#wxyz }" "$(with_libraries ./run)"
