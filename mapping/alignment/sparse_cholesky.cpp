// SPDX-License-Identifier: Apache-2.0
// Why sparse: each pose is linked to few others, so nearly all blocks are zero, and a dense solution costs the cube of
// the number of poses. The order of elimination depends on the blocks' places alone and serves all iterations.
#include "mapping/alignment/sparse_cholesky.hpp"

#include <cholmod.h>

#include <cassert>
#include <cstring>
#include <stdexcept>

namespace deltamap::mapping::alignment {

struct SparseCholesky::State {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;  // what the order of elimination was found for

  State() {
    cholmod_start(&common);
    common.print = 0;  // a matrix that is not positive definite is an answer, not a message
    common.final_ll = 1;
  }
  ~State() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

namespace {

/// Lower triangle, duplicates summed by CHOLMOD.
cholmod_sparse* sparse_of(std::size_t block_count, const std::vector<SymmetricBlock>& blocks, cholmod_common* common) {
  const std::size_t size = 3 * block_count;
  cholmod_triplet* triplet = cholmod_allocate_triplet(size, size, 9 * blocks.size(), -1, CHOLMOD_REAL, common);
  if (triplet == nullptr) throw std::bad_alloc{};
  auto* rows = static_cast<int*>(triplet->i);
  auto* columns = static_cast<int*>(triplet->j);
  auto* values = static_cast<double*>(triplet->x);
  std::size_t count = 0;
  for (const SymmetricBlock& block : blocks) {
    assert(block.row >= block.column && block.row < block_count && "blocks lie in the lower triangle");
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const int row = static_cast<int>(3 * block.row) + i;
        const int column = static_cast<int>(3 * block.column) + j;
        if (row < column) continue;
        rows[count] = row;
        columns[count] = column;
        values[count] = block.values(i, j);
        ++count;
      }
    }
  }
  triplet->nnz = count;
  cholmod_sparse* sparse = cholmod_triplet_to_sparse(triplet, count, common);
  cholmod_free_triplet(&triplet, common);
  if (sparse == nullptr) throw std::bad_alloc{};
  return sparse;
}

}  // namespace

SparseCholesky::SparseCholesky() : state_{std::make_unique<State>()} {}
SparseCholesky::~SparseCholesky() = default;

bool SparseCholesky::factorize(std::size_t block_count, const std::vector<SymmetricBlock>& blocks) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
  places.reserve(blocks.size());
  for (const SymmetricBlock& block : blocks) places.emplace_back(block.row, block.column);

  cholmod_sparse* matrix = sparse_of(block_count, blocks, &state_->common);
  if (state_->factor == nullptr || places != state_->places) {
    cholmod_free_factor(&state_->factor, &state_->common);
    state_->factor = cholmod_analyze(matrix, &state_->common);
    state_->places = std::move(places);
  }
  const bool done = state_->factor != nullptr && cholmod_factorize(matrix, state_->factor, &state_->common) != 0 &&
                    state_->common.status == CHOLMOD_OK && state_->factor->minor == state_->factor->n;
  cholmod_free_sparse(&matrix, &state_->common);
  return done;
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& right_sides) const {
  assert(state_->factor != nullptr && static_cast<std::size_t>(right_sides.rows()) == state_->factor->n);
  cholmod_dense dense{};
  dense.nrow = dense.d = static_cast<std::size_t>(right_sides.rows());
  dense.ncol = static_cast<std::size_t>(right_sides.cols());
  dense.nzmax = dense.nrow * dense.ncol;
  dense.x = const_cast<double*>(right_sides.data());  // CHOLMOD reads it
  dense.xtype = CHOLMOD_REAL;
  dense.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, state_->factor, &dense, &state_->common);
  if (solution == nullptr) throw std::bad_alloc{};
  Eigen::MatrixXd result(right_sides.rows(), right_sides.cols());
  std::memcpy(result.data(), solution->x, sizeof(double) * dense.nzmax);
  cholmod_free_dense(&solution, &state_->common);
  return result;
}

}  // namespace deltamap::mapping::alignment
