#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: fromROS(LaserScan) of MRPT's ROS bridge copies beam i to beam i; a fan that is not symmetric, which MRPT's own
#   scan cannot express, is turned by its sensor pose or refused.
# Seen: the very fans of an LMS200, -90 to 90 degrees in 1 or 0.5, come out turned by one beam: each but the first has its
#   right neighbour's range (an index is cut where it should be rounded). A fan of 100 degrees is copied right. One from
#   -90 to 60 becomes -75 to 75, whose beams beyond 60 hold ranges that were measured at -90 to -76, marked as valid.
# Matters: maps and poses from bags are half a degree or a degree off, 14 cm at 8 m, and a laser whose fan was cut on one
#   side sees walls where it is blind. Nothing is said; tests with symmetric 100 or 270 degree fans pass.
# Version: MRPT 2.5.8 (1:2.5.8+ds-2). Source: ros1bridge/laser_scan.h: "builds" the scan from the message; angle_increment
#   of the message is not looked at.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libmrpt-ros1bridge2.5=1:2.5.8+ds-2 librostime1d=0.7.2-8+b2
debian_files libmrpt-{common,core,containers,system,typemeta,serialization,rtti,math,poses,obs,bayes,random,io,config}-dev=1:2.5.8+ds-2 \
  libmrpt-{img,opengl,expr,tfest,ros1bridge,maps}-dev=1:2.5.8+ds-2 libeigen3-dev=3.4.0-4 libsensor-msgs-dev=1.13.1-1+b1 \
  libgeometry-msgs-dev=1.13.1-1+b1 libstd-msgs-dev=0.5.13-2 libroscpp-core-dev=0.7.2-8+b2 libboost1.74-dev=1.74.0+ds1-21
cat > fans.cpp << 'CPP'
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/ros1bridge/laser_scan.h>
#include <sensor_msgs/LaserScan.h>

#include <cmath>
#include <iostream>

constexpr double kDegree = M_PI / 180.0;

/// Beam i measures 1 + i: its range tells where it was measured.
mrpt::obs::CObservation2DRangeScan bridged(double first_deg, double last_deg, int beams) {
  sensor_msgs::LaserScan scan;
  scan.angle_min = first_deg * kDegree;
  scan.angle_max = last_deg * kDegree;
  scan.angle_increment = (scan.angle_max - scan.angle_min) / (beams - 1);
  scan.range_max = 5000;
  for (int i = 0; i < beams; ++i) scan.ranges.push_back(1 + i);
  mrpt::obs::CObservation2DRangeScan result;
  mrpt::ros1bridge::fromROS(scan, mrpt::poses::CPose3D(), result);
  return result;
}

int main() {
  struct { double first_deg, last_deg; int beams; } fans[]{{-90, 90, 181}, {-90, 90, 361}, {-50, 50, 201}, {-90, 60, 151}};
  for (const auto& fan : fans) {
    const auto scan = bridged(fan.first_deg, fan.last_deg, fan.beams);
    int own = 0, right_neighbours = 0;
    for (int i = 0; i < fan.beams; ++i) {
      own += scan.getScanRange(i) == 1 + i ? 1 : 0;
      right_neighbours += scan.getScanRange(i) == i ? 1 : 0;
    }
    const int last = fan.beams - 1;
    std::cout << fan.first_deg << ".." << fan.last_deg << " of " << fan.beams << ": own " << own << ", right neighbour's "
              << right_neighbours << ", beam at " << std::round(scan.getScanAngle(last) / kDegree) << " measured at "
              << fan.first_deg + (scan.getScanRange(last) - 1) * (fan.last_deg - fan.first_deg) / last
              << (scan.getScanRangeValidity(last) ? " valid\n" : " invalid\n");
  }
}
CPP
includes=$(printf -- '-isystem %s ' "$root"/usr/include/mrpt/*/include "$root/usr/include/eigen3")
# shellcheck disable=SC2086
compiled fans.cpp $includes -lmrpt-ros1bridge -lmrpt-obs -lmrpt-poses -lmrpt-math -lmrpt-serialization -lmrpt-rtti -lmrpt-core -lrostime \
  -Wl,--allow-shlib-undefined
stated 'LaserScan to MRPT' '-90..90 of 181: own 1, right neighbour'"'"'s 180, beam at 90 measured at 89 valid
-90..90 of 361: own 1, right neighbour'"'"'s 360, beam at 90 measured at 89.5 valid
-50..50 of 201: own 201, right neighbour'"'"'s 0, beam at 50 measured at 50 valid
-90..60 of 151: own 0, right neighbour'"'"'s 0, beam at 75 measured at -76 valid' "$(with_libraries ./run)"
