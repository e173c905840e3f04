#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: FCL's continuousCollide, asked as it comes (a request without options), finds every contact on the way between two poses:
#   of a robot of 0.5 m that drives 10 m through a thin wall, and of one of 2 m that turns in place beside a post.
# Seen: it looks at ten poses, 1.11 m apart, and finds the wall at 1.0 m and not the one at 1.7 m or half way. And it looks at the
#   way alone: the turning robot keeps its first heading and is free. With ccd_motion_type = CCDM_LINEAR the post is hit at 0.444
#   of the turn; with num_max_iterations = 1000 each wall is found.
# Matters: "continuous" is taken for a promise, and steps between collision checks are made longer for it; the answer is "free" with
#   a time of contact of 1. Set the motion type, and as many iterations as the shortest obstacle asks for on that way.
# Version: FCL 0.7.0 (libfcl0.7 0.7.0-3+b1). Source: ContinuousCollisionRequest's defaults in continuous_collision_request.h (10,
#   CCDM_TRANS, CCDC_NAIVE), of which it says "maximum num of iterations" and "ccd motion type".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libfcl0.7=0.7.0-3+b1
debian_files libfcl-dev=0.7.0-3+b1 libccd-dev=2.1-2+b1 libccd2=2.1-2+b1 libeigen3-dev=3.4.0-4 liboctomap-dev=1.9.7+dfsg-3+b1
cat > ways.cpp << 'CPP'
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <cstdio>

using Pose = fcl::Transform3d;
using Request = fcl::ContinuousCollisionRequestd;

Pose at(double x, double y, double heading) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, 0.0;
  pose.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

void print(const char* way, const fcl::Boxd& robot, const Pose& end, const fcl::Boxd& thing, const Pose& place,
           const Request& request) {
  fcl::ContinuousCollisionResultd result;
  fcl::continuousCollide(&robot, at(0, 0, 0), end, &thing, place, place, request, result);
  result.is_collide ? std::printf("%s %.3f; ", way, result.time_of_contact) : std::printf("%s free; ", way);
}

int main() {
  const fcl::Boxd robot(0.5, 0.5, 0.5), wall(0.05, 4, 1), longer(2, 0.4, 0.5), post(0.1, 0.1, 1);
  const Pose far = at(10, 0, 0), round = at(0, 0, 0.9 * M_PI), beside = at(0, 0.85, 0);
  for (const double x : {1.0, 1.7, 5.0}) print("wall", robot, far, wall, at(x, 0, 0), Request());
  print("turn", longer, round, post, beside, Request());
  print("turn, CCDM_LINEAR", longer, round, post, beside, Request(10, 0.0001, fcl::CCDM_LINEAR));
  for (const double x : {1.7, 5.0}) print("1000", robot, far, wall, at(x, 0, 0), Request(1000));
}
CPP
compiled ways.cpp -isystem "$root/usr/include/eigen3" -lfcl -lccd
expected='wall 0.111; wall free; wall free; turn free; turn, CCDM_LINEAR 0.444; 1000 0.143; 1000 0.473; '
stated 'first contact, of the way' "$expected" "$(with_libraries ./run)"
