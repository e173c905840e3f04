#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: Clipper's MinkowskiSum of a robot's outline and a path is the region that the robot passes over, as its documentation says,
#   and of the outline and a closed obstacle the obstacle grown by the robot: both solid.
# Seen: both can be hollow. A square robot of 1 m that drives 0.3 m covers 0.6 square metres in two strips, one ahead and one behind: where it
#   stood all the time is left out. It is the EDGE of the pattern that is swept. Of an obstacle of 10 m a frame remains, with 81
#   square metres of free ground within; one of 0.8 m has a hole of 0.2 m. United with the robot at each end the short drive is solid.
# Matters: a configuration space or a swept path that is made so is free just where the robot stands, and within walls; a planner that
#   begins inside finds no collision. It shows for short steps only, and not in a picture of a long drive.
# Version: Clipper 6.4.2 (libpolyclipping22 6.4.2-7). Source: its documentation, MinkowskiSum: adds the points of the pattern to the set of
#   points of the path, "the region that the 'pattern' would pass over in moving from the beginning to the end of the 'path'".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libpolyclipping22=6.4.2-7
debian_files libpolyclipping-dev=6.4.2-7
cat > sweep.cpp << 'CPP'
#include <cstdio>
#include <polyclipping/clipper.hpp>

using namespace ClipperLib;

double square_metres(const Paths& paths) {  // of outlines in decimetres; holes count against it
  double sum = 0;
  for (const Path& path : paths) sum += Area(path);
  return sum / 100;
}

Path square(cInt low, cInt high) { return {{low, low}, {high, low}, {high, high}, {low, high}}; }

int main() {
  const Path robot = square(-5, 5);
  Paths swept;
  for (const cInt way : {3, 30}) {
    MinkowskiSum(robot, Path{{0, 0}, {way, 0}}, swept, false);
    std::printf("%.1f m: %.1f; ", way / 10.0, square_metres(swept));
  }
  Clipper whole;
  MinkowskiSum(robot, Path{{0, 0}, {3, 0}}, swept, false);
  whole.AddPaths(swept, ptSubject, true);
  whole.AddPath(robot, ptSubject, true);
  whole.AddPath({{-2, -5}, {8, -5}, {8, 5}, {-2, 5}}, ptSubject, true);
  whole.Execute(ctUnion, swept, pftNonZero, pftNonZero);
  std::printf("0.3 m with both ends: %.1f; ", square_metres(swept));
  for (const cInt side : {8, 100}) {
    MinkowskiSum(robot, square(0, side), swept, true);
    std::printf("obstacle of %.1f m: %.2f; ", side / 10.0, square_metres(swept));
  }
}
CPP
compiled sweep.cpp -l:libpolyclipping.so.22
stated 'square metres, where 1.3, 4.0, 1.3, 3.24 and 121 are solid' \
  '0.3 m: 0.6; 3.0 m: 4.0; 0.3 m with both ends: 1.3; obstacle of 0.8 m: 3.20; obstacle of 10.0 m: 40.00; ' \
  "$(with_libraries ./run)"
