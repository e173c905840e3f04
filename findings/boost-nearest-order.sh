#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: a query of Boost.Geometry's rtree for the k nearest gives them nearest first, as nanoflann, FLANN, PCL and the tree's own
#   iterators do, so that the first of three is the one nearest bay.
# Seen: the first is the FARTHEST of the k: of two the second, of five the fifth. The others stand in the order of a heap.
#   qbegin(nearest(place, k)) of the same tree gives them nearest first.
# Matters: "take the first, look at the others if it is taken" sends a robot to the farthest of the near bays, and a particle to the
#   worst of its matches; tests with k = 1 pass. Sort them, or use the iterators.
# Version: Boost 1.74.0 (libboost1.74-dev 1.74.0+ds1-21). Source: index/rtree.hpp, query(): "will result in returning k values to the output
#   iterator", and no word of an order.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files libboost1.74-dev=1.74.0+ds1-21
cat > nearest.cpp << 'CPP'
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cstdio>
#include <iterator>
#include <vector>

namespace bgi = boost::geometry::index;
using Point = boost::geometry::model::d2::point_xy<double>;

int main() {
  bgi::rtree<Point, bgi::rstar<16>> bays;
  for (int bay = 1; bay <= 40; ++bay) bays.insert(Point(bay, 0));  // bay n is n metres away
  for (const unsigned wanted : {1U, 2U, 5U}) {
    std::vector<Point> found;
    bays.query(bgi::nearest(Point(0, 0), wanted), std::back_inserter(found));
    std::printf("first of %u: %.0f; ", wanted, found.front().x());
  }
  std::printf("iterators:");
  for (auto bay = bays.qbegin(bgi::nearest(Point(0, 0), 5)); bay != bays.qend(); ++bay) std::printf(" %.0f", bay->x());
}
CPP
compiled nearest.cpp -DBOOST_ALLOW_DEPRECATED_HEADERS
stated 'bays, by their distance' 'first of 1: 1; first of 2: 2; first of 5: 5; iterators: 1 2 3 4 5' "$(./run)"
