// SPDX-License-Identifier: Apache-2.0
// Solves symmetric positive definite sparse systems by CHOLMOD, block by block of 3 × 3.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace deltamap::mapping::alignment {

/// A block of the symmetric matrix, at block row >= block column; several at one place are added.
struct SymmetricBlock {
  std::uint32_t row = 0;
  std::uint32_t column = 0;
  Eigen::Matrix3d values = Eigen::Matrix3d::Zero();
};

class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /// False where the matrix is not positive definite. The order of elimination is kept while the blocks keep their
  /// places.
  [[nodiscard]] bool factorize(std::size_t block_count, const std::vector<SymmetricBlock>& blocks);
  /// After factorize() answered true.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right_sides) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::mapping::alignment
