#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: a k-d tree over headings with nanoflann's SO2_Adaptor finds the nearest heading round the circle; that is what
#   the adaptor is for, and its distance is the angle between two headings.
# Seen: the distance keeps its sign, so the smallest one wins: asked for 0.05 rad among headings with a 0.0, the search
#   names -3.0, "-3.05 away". Results are sorted by that number too.
# Matters: whoever looks up particles, key frames or scans by heading gets the ones that look the other way.
# Version: nanoflann 1.4.3 (libnanoflann-dev 1.4.3+ds-2). Source: nanoflann.hpp calls SO2_Adaptor a distance of
#   orientations in [-pi, pi] and says nothing of a sign; its accum_dist returns the wrapped difference as it is.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files libnanoflann-dev=1.4.3+ds-2
cat > headings.cpp << 'CPP'
#include <iostream>
#include <nanoflann.hpp>
#include <vector>

struct Headings {
  std::vector<double> rad{-3.0, -1.0, 0.0, 0.2, 1.0, 3.0};
  std::size_t kdtree_get_point_count() const { return rad.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t) const { return rad[i]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const { return false; }
};

int main() {
  const Headings headings;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::SO2_Adaptor<double, Headings>, Headings, 1> tree(1, headings);
  tree.buildIndex();
  for (const double wanted : {0.05, 0.15, 3.1}) {
    unsigned nearest = 0;
    double distance = 0.0;
    tree.knnSearch(&wanted, 1, &nearest, &distance);
    std::cout << wanted << ": " << headings.rad[nearest] << " at " << distance << "; ";
  }
}
CPP
compiled headings.cpp
stated 'wanted: nearest heading at distance' '0.05: -3 at -3.05; 0.15: -1 at -1.15; 3.1: 0 at -3.1; ' "$(./run)"
