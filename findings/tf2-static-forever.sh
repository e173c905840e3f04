#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: where a frame was first told as static and later as moving, tf2 takes the later kind; or it refuses the change.
# Seen: the first call decides for good. A moving transform to a frame that was once static is taken (setTransform returns
#   true) and its newest value is the answer for every time, past and future; told the other way round, the same two
#   calls end in an extrapolation error. So it depends on which message came first.
# Matters: a placeholder map -> odom of a static publisher, started before the localizer, turns off all checks of age: a
#   localizer that died an hour ago still answers for now, and scans of a second ago are placed with the pose of now.
# Version: tf2 0.7.6 (libtf2-2d 0.7.6-1+b2). Source: buffer_core.h, is_static: "cannot be changed after the first call";
#   that the answer is then without age, and that the call succeeds, is not said.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libtf2-2d=0.7.6-1+b2
debian_files libtf2-dev=0.7.6-1+b2 libtf2-msgs-dev=0.7.6-1+b2 libroscpp-core-dev=0.7.2-8+b2 \
  libgeometry-msgs-dev=1.13.1-1+b1 libstd-msgs-dev=0.5.13-2 libboost1.74-dev=1.74.0+ds1-21
cat > kinds.cpp << 'CPP'
#include <tf2/buffer_core.h>

#include <tf2/exceptions.h>

#include <iostream>

geometry_msgs::TransformStamped odom_at(double time_s, double x_m) {
  geometry_msgs::TransformStamped told;
  told.header.frame_id = "map";
  told.header.stamp = ros::Time(time_s);
  told.child_frame_id = "odom";
  told.transform.translation.x = x_m;
  told.transform.rotation.w = 1.0;
  return told;
}

void ask(const tf2::BufferCore& buffer, double time_s) {
  try {
    std::cout << buffer.lookupTransform("map", "odom", ros::Time(time_s)).transform.translation.x << " m";
  } catch (const tf2::ExtrapolationException&) {
    std::cout << "extrapolation error";
  }
  std::cout << " at " << time_s << " s, ";
}

int main() {
  for (const bool static_first : {true, false}) {
    tf2::BufferCore buffer;
    bool taken = !static_first || buffer.setTransform(odom_at(1, 0), "placeholder", true);
    for (int time_s = 1; time_s <= 9; ++time_s) taken &= buffer.setTransform(odom_at(time_s, time_s), "localizer", false);
    if (!static_first) taken &= buffer.setTransform(odom_at(10, 0), "placeholder", true);
    std::cout << (static_first ? "static first: " : "moving first: ");
    ask(buffer, 3);
    ask(buffer, 4000);
    std::cout << (taken ? "all taken; " : "some refused; ");
  }
}
CPP
compiled kinds.cpp -ltf2 -lrostime
stated 'odom moves 1 m/s' \
  'static first: 9 m at 3 s, 9 m at 4000 s, all taken; moving first: 3 m at 3 s, extrapolation error at 4000 s, all taken; ' \
  "$(with_libraries ./run)"
