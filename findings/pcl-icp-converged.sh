#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: after ICP hasConverged says whether the poses still moved when the iterations ran out; align of the same scan with
#   more of them comes at least as near; getFitnessScore(0.1) is the mean over pairs that are at most 0.1 m apart.
# Seen: running out of iterations is a convergence. The same scan, tried again with 50 iterations after 2, ends after the first,
#   farther off and "converged": its error is compared with the one that the last align left behind, and is the same. And the
#   range is held against the squared distance: 0.1 lets pairs through to 0.32 m, here those of a box 0.25 m from the wall.
# Matters: gates of scan matchers and loop closures, which are made of just these two calls, let wrong poses into the map. Ask
#   getConvergeCriteria() for its state, take a new object for a new try, and give the range squared.
# Version: PCL 1.13.0 (1.13.0+dfsg-3). Source: registration.h calls max_range a distance; registration/impl/registration.hpp
#   compares it with what nearestKSearch gives; hasConverged in impl/default_convergence_criteria.hpp.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

packages=(libeigen3-dev=3.4.0-4 libboost1.74-dev=1.74.0+ds1-21 libflann-dev=1.9.2+dfsg-1+deb12u1 libflann1.9=1.9.2+dfsg-1+deb12u1)
for name in pcl-dev pcl-common1.13 pcl-features1.13 pcl-filters1.13 pcl-kdtree1.13 pcl-octree1.13 pcl-registration1.13 \
  pcl-sample-consensus1.13 pcl-search1.13; do
  packages+=("lib$name=1.13.0+dfsg-3")
done
debian_files "${packages[@]}"
cat > match.cpp << 'CPP'
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include <cmath>
#include <cstdio>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

int main() {
  Cloud::Ptr corner(new Cloud), turned(new Cloud), with_box(new Cloud);
  for (int i = 0; i < 400; ++i) {
    corner->push_back({0.02f * i, 0.0f, 0.0f});
    corner->push_back({0.0f, 0.02f * i, 0.0f});
    with_box->push_back({0.02f * i, 0.0f, 0.0f});
  }
  for (const auto& point : *corner) {
    const float c = std::cos(0.3f), s = std::sin(0.3f);
    turned->push_back({c * point.x - s * point.y + 0.3f, s * point.x + c * point.y - 0.2f, 0.0f});
  }
  for (int i = 100; i < 200; ++i) with_box->push_back({0.02f * i, 0.25f, 0.0f});

  Cloud moved;
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputTarget(corner);
  icp.setInputSource(turned);
  for (const int iterations : {1, 2, 50}) {
    icp.setMaximumIterations(iterations);
    icp.align(moved);
    const auto pose = icp.getFinalTransformation();
    std::printf("%d: %s %.2f rad, ", iterations, icp.hasConverged() ? "converged" : "not", std::atan2(pose(1, 0), pose(0, 0)));
  }
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> anew;
  anew.setInputTarget(corner);
  anew.setInputSource(turned);
  anew.setMaximumIterations(50);
  anew.align(moved);
  const auto pose = anew.getFinalTransformation();
  std::printf("anew 50: %.2f rad\n", std::atan2(pose(1, 0), pose(0, 0)));

  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> wall;
  wall.setInputTarget(corner);
  wall.setInputSource(with_box);
  wall.setMaxCorrespondenceDistance(0.1);
  wall.align(moved);
  for (const double range : {0.05, 0.1}) std::printf("%.2f: %.4f; ", range, wall.getFitnessScore(range));
}
CPP
compiled match.cpp -isystem "$root/usr/include/pcl-1.13" -isystem "$root/usr/include/eigen3" -lpcl_registration -lpcl_search \
  -lpcl_kdtree -lpcl_common -Wl,--allow-shlib-undefined
with_libraries ./run > seen.log
stated 'turned by -0.30 rad' '1: converged -0.26 rad, 2: converged -0.27 rad, 50: converged -0.26 rad, anew 50: -0.29 rad' \
  "$(head -n 1 seen.log)"
stated 'mean of the squares up to a range' '0.05: 0.0000; 0.10: 0.0125; ' "$(tail -n 1 seen.log)"
