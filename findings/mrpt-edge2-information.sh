#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: MRPT reads the EDGE2 lines of TORO and HOG-Man graphs in TORO's order of the information matrix (xx xy yy tt xt yt)
#   and the EDGE_SE2 lines of g2o in g2o's (xx xy xt yy yt tt), as the two names tell the formats apart.
# Seen: it reads both in g2o's order. A TORO edge that knows x and y with 500 and the turn with 5000 becomes a matrix with
#   0 for the turn and 500 between x and turn, which is no information matrix: its determinant is negative.
# Matters: the public 2-D benchmark graphs (intel, MIT, Freiburg as EDGE2) load without a word, and the optimizer is given
#   edges that pull the wrong way. A graph of one's own has to go to MRPT as EDGE_SE2.
# Version: MRPT 2.5.8 (1:2.5.8+ds-2). Source: HOG-Man's data/2D/README-fileformat.txt (inf_ff inf_fs inf_ss inf_rr inf_fr
#   inf_sr); MRPT's CNetworkOfPoses_impl.h names that order in one comment and reads another.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libmrpt-graphs2.5=1:2.5.8+ds-2 libmrpt-poses2.5=1:2.5.8+ds-2
debian_files libmrpt-{common,core,containers,system,typemeta,serialization,rtti,math,poses,graphs,bayes,random,io,config}-dev=1:2.5.8+ds-2 \
  libmrpt-{img,opengl,expr}-dev=1:2.5.8+ds-2 libeigen3-dev=3.4.0-4
printf 'VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\nEDGE2 0 1 1 0 0 500 0 500 5000 0 0\n' > toro.graph
printf 'VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 500 0 0 500 0 5000\n' > same.g2o
cat > edges.cpp << 'CPP'
#include <mrpt/graphs/CNetworkOfPoses.h>

#include <iostream>

int main(int, char** files) {
  mrpt::graphs::CNetworkOfPoses2DInf graph;
  graph.loadFromTextFile(files[1]);
  const auto& information = graph.edges.begin()->second.cov_inv;
  for (int row = 0; row < 3; ++row) std::cout << information(row, 0) << ' ' << information(row, 1) << ' ' << information(row, 2) << ", ";
  std::cout << "determinant " << information.det();
}
CPP
includes=$(printf -- '-isystem %s ' "$root"/usr/include/mrpt/*/include "$root/usr/include/eigen3")
# shellcheck disable=SC2086
compiled edges.cpp $includes -lmrpt-graphs -lmrpt-poses -lmrpt-math -lmrpt-serialization -lmrpt-rtti -lmrpt-system \
  -lmrpt-core -lmrpt-io -Wl,--allow-shlib-undefined
stated 'EDGE_SE2 of g2o' '500 0 0, 0 500 0, 0 0 5000, determinant 1.25e+09' "$(with_libraries ./run same.g2o)"
stated 'EDGE2 of TORO' '500 0 500, 0 5000 0, 500 0 0, determinant -1.25e+09' "$(with_libraries ./run toro.graph)"
