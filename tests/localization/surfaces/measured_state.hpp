// SPDX-License-Identifier: Apache-2.0
// A state at rest and what is measured of it, row by row.
#pragma once

#include "localization/surfaces/offset_state.hpp"

namespace deltamap::localization::surfaces {

inline sensor::RefinedPose at_rest(double x, double y, double theta) {
  return {{x, y, theta}, Eigen::Vector3d{1e-4, 1e-4, 1e-5}.asDiagonal().toDenseMatrix()};
}

inline void measure(OffsetState& state, const SparseRow& row, double innovation, double variance) {
  const RowMeasurement measured{row, innovation, variance};
  state.update({&measured, 1});
}

/// Of the first surface that is followed.
inline constexpr Eigen::Index kOffset = OffsetState::kFixed;

}  // namespace deltamap::localization::surfaces
