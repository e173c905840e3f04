#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: a lookup at ros::Time(0) answers with the latest time that all frames on the way have in common, so it may be
#   old, but it cannot fail by extrapolation.
# Seen: when one link (odom -> base) stands still for longer than the cache while the other (map -> odom) goes on, the
#   latest common time is older than all that is left of the living link: "extrapolation into the past", canTransform
#   is false, though each of the two links alone is answered at ros::Time(0).
# Matters: a robot whose odometry stops for 10 s is not shown where it stood: its pose is gone, with a message that
#   blames a request for the past which nobody made.
# Version: tf2 0.7.6 (libtf2-2d 0.7.6-1+b2). Source: buffer_core.h, lookupTransform: "0 will get the latest".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libtf2-2d=0.7.6-1+b2
debian_files libtf2-dev=0.7.6-1+b2 libtf2-msgs-dev=0.7.6-1+b2 libroscpp-core-dev=0.7.2-8+b2 \
  libgeometry-msgs-dev=1.13.1-1+b1 libstd-msgs-dev=0.5.13-2 libboost1.74-dev=1.74.0+ds1-21
cat > latest.cpp << 'CPP'
#include <tf2/buffer_core.h>

#include <tf2/exceptions.h>

#include <iostream>

geometry_msgs::TransformStamped link(const char* parent, const char* child, double time_s) {
  geometry_msgs::TransformStamped told;
  told.header.frame_id = parent;
  told.header.stamp = ros::Time(time_s);
  told.child_frame_id = child;
  told.transform.rotation.w = 1.0;
  return told;
}

void ask(const tf2::BufferCore& buffer, const char* target, const char* source) {
  std::cout << target << " <- " << source << ": ";
  try {
    std::cout << buffer.lookupTransform(target, source, ros::Time(0)).header.stamp.toSec() << " s; ";
  } catch (const tf2::ExtrapolationException&) {
    std::cout << "extrapolation error; ";
  }
}

int main() {
  tf2::BufferCore buffer;  // keeps 10 s
  for (int time_s = 1; time_s <= 100; ++time_s) {
    buffer.setTransform(link("map", "odom", time_s), "localizer");
    if (time_s <= 50) buffer.setTransform(link("odom", "base", time_s), "wheels");
  }
  ask(buffer, "map", "odom");
  ask(buffer, "odom", "base");
  ask(buffer, "map", "base");
  std::cout << "canTransform " << buffer.canTransform("map", "base", ros::Time(0));
}
CPP
compiled latest.cpp -ltf2 -lrostime
stated 'latest, wheels silent since 50 s of 100' \
  'map <- odom: 100 s; odom <- base: 50 s; map <- base: extrapolation error; canTransform 0' "$(with_libraries ./run)"
