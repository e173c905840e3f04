#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: checkMotion of a Dubins space looks at the whole curve, at the distance that setStateValidityCheckingResolution has
#   set; it has a validator of its own for that.
# Seen: it counts steps by the straight line between the two poses. 2 cm to the side are a loop of 6.3 m: one pose of it, the
#   last, is asked for, and the loop is called free though three quarters of it lie in the obstacle. The same pose 1 m off
#   has 36 steps. Reeds-Shepp curves are counted so, too: 2 steps for 63 cm.
# Matters: the planner joins neighbouring poses by such loops, most of all near start, goal and where RRT* rewires, and hands
#   over a "valid" path through a wall. Ask at your own step along interpolate(), or override validSegmentCount.
# Version: OMPL 1.5.2 (libompl16 1.5.2+ds1-1), the one of Debian 12. Source: CompoundStateSpace::validSegmentCount takes the
#   most of x-y and heading alone; ompl pull requests 820 (Reeds-Shepp) and 1001 (Dubins) have mended it for later versions.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files libompl-dev=1.5.2+ds1-1 libompl16=1.5.2+ds1-1 libode8=2:0.16.2-1 libccd2=2.1-2+b1 libeigen3-dev=3.4.0-4 \
  libboost1.74-dev=1.74.0+ds1-21 libboost-serialization1.74.0=1.74.0+ds1-21 libboost-filesystem1.74.0=1.74.0+ds1-21
cat > loop.cpp << 'CPP'
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>

#include <cmath>
#include <iostream>
#include <memory>

namespace ob = ompl::base;
using Pose = ob::ScopedState<ob::SE2StateSpace>;

// Free is a disc of 0.8 m about the start. The goal looks as the start does, to_the_side_m beside it.
template <class Space>
void tell(double to_the_side_m) {
  const auto space = std::make_shared<Space>(1.0);
  ob::RealVectorBounds bounds(2);
  bounds.setLow(-10.0);
  bounds.setHigh(10.0);
  space->setBounds(bounds);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  const auto is_free = [](const ob::State* state) {
    const auto* pose = state->as<ob::SE2StateSpace::StateType>();
    return std::hypot(pose->getX(), pose->getY()) < 0.8;
  };
  information->setStateValidityChecker(is_free);
  information->setStateValidityCheckingResolution(0.001);
  information->setup();

  Pose start(space), goal(space), between(space);
  start->setXY(0.0, 0.0);
  start->setYaw(0.0);
  goal->setXY(0.0, to_the_side_m);
  goal->setYaw(0.0);
  int blocked = 0;
  for (int i = 0; i < 1000; ++i) {
    space->interpolate(start.get(), goal.get(), i / 1000.0, between.get());
    if (!is_free(between.get())) ++blocked;
  }
  std::cout << to_the_side_m << " m aside: " << std::lround(100.0 * space->distance(start.get(), goal.get())) << " cm in "
            << space->validSegmentCount(start.get(), goal.get()) << " steps, "
            << (information->checkMotion(start.get(), goal.get()) ? "free" : "blocked") << ", in truth " << blocked / 10
            << " % blocked; ";
}

int main(int count, char**) {
  for (const double aside : {0.02, 0.05, 1.0})
    count == 1 ? tell<ob::DubinsStateSpace>(aside) : tell<ob::ReedsSheppStateSpace>(aside);
}
CPP
compiled loop.cpp -isystem "$root/usr/include/ompl-1.5" -isystem "$root/usr/include/eigen3" -lompl -Wl,--allow-shlib-undefined
dubins='0.02 m aside: 630 cm in 1 steps, free, in truth 74 % blocked; '
dubins+='0.05 m aside: 633 cm in 2 steps, blocked, in truth 74 % blocked; '
dubins+='1 m aside: 728 cm in 36 steps, blocked, in truth 88 % blocked; '
stated Dubins "$dubins" "$(with_libraries ./run)"
reeds_shepp='0.02 m aside: 40 cm in 1 steps, free, in truth 0 % blocked; '
reeds_shepp+='0.05 m aside: 63 cm in 2 steps, free, in truth 0 % blocked; '
reeds_shepp+='1 m aside: 264 cm in 36 steps, blocked, in truth 37 % blocked; '
stated Reeds-Shepp "$reeds_shepp" "$(with_libraries ./run reeds-shepp)"
