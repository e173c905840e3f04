#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: entries that are given twice are added up when CXSparse compresses a triplet matrix, as CHOLMOD and Eigen do;
#   a pose graph adds one small block to the information matrix for each edge.
# Seen: cs_compress keeps both. The product with a vector (cs_gaxpy) adds them up, but the Cholesky, LU and QR solvers
#   take the last one alone, return 1 for success, and the solution is wrong. cs_dupl has to be called in between.
# Matters: the residual looks right and the pose graph drifts, as each node forgets all its edges but one.
# Version: CXSparse of SuiteSparse 5.12.0 (1:5.12.0+dfsg-2). Source: cs.h declares cs_dupl, and nothing in it asks for it;
#   CHOLMOD's manual says of cholmod_triplet_to_sparse that duplicates are summed.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files libcxsparse3=1:5.12.0+dfsg-2 libsuitesparse-dev=1:5.12.0+dfsg-2
cat > twice.cpp << 'CPP'
#include <suitesparse/cs.h>

#include <cstdio>

// [4 -1; -1 2] x = [1 2], whose solution is 0.571 1.286; 4 and -1 are told in parts.
int main() {
  cs* parts = cs_spalloc(0, 0, 1, 1, 1);
  for (const double part : {1.0, 2.0, 1.0}) cs_entry(parts, 0, 0, part);
  for (const double part : {-0.5, -0.5}) cs_entry(parts, 0, 1, part), cs_entry(parts, 1, 0, part);
  cs_entry(parts, 1, 1, 2.0);
  cs* matrix = cs_compress(parts);
  double ones[] = {1, 1}, product[] = {0, 0}, cholesky[] = {1, 2}, lu[] = {1, 2}, qr[] = {1, 2}, right[] = {1, 2};
  cs_gaxpy(matrix, ones, product);
  const int done = cs_cholsol(0, matrix, cholesky) + cs_lusol(0, matrix, lu, 1.0) + cs_qrsol(0, matrix, qr);
  cs_dupl(matrix);
  cs_cholsol(0, matrix, right);
  std::printf("row sums %g %g, %d of 3 solvers succeed: %.3f %.3f, %.3f %.3f, %.3f %.3f; after cs_dupl %.3f %.3f", product[0],
              product[1], done, cholesky[0], cholesky[1], lu[0], lu[1], qr[0], qr[1], right[0], right[1]);
}
CPP
compiled twice.cpp -l:libcxsparse.so.3
stated 'of a matrix told in parts' \
  'row sums 3 1, 3 of 3 solvers succeed: 1.714 1.429, 1.714 1.429, 1.714 1.429; after cs_dupl 0.571 1.286' "$(with_libraries ./run)"
