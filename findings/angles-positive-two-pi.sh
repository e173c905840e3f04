#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: angles::normalize_angle_positive maps every angle to 0 up to, but without, two pi.
# Seen: of -1e-17 to -4e-16 rad, which is what rounding leaves of "straight along x", it makes two pi itself. Of 36 sectors of
#   10 degrees such a heading lies in number 36, one past the end.
# Matters: a histogram of directions, as VFH and its kind count by, is written one past its end, and what lies straight ahead
#   is missing in sector 0. Take the index modulo the number of sectors, or ask for less than two pi.
# Version: angles 1.16.0 (libangles-dev 1.16.0-1). Source: angles.h promises "0 to 2*M_PI"; the sum of a tiny negative
#   number and two pi is rounded to two pi, and no second fmod follows.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files libangles-dev=1.16.0-1
cat > sectors.cpp << 'CPP'
#include <angles/angles.h>

#include <cstdio>

int main() {
  for (const double heading : {1e-17, 0.0, -4e-16, -1e-17, -1e-15}) {
    const double positive = angles::normalize_angle_positive(heading);
    std::printf("%g in %d; ", heading, static_cast<int>(positive / (2.0 * M_PI) * 36.0));
  }
}
CPP
compiled sectors.cpp -isystem "$root/usr/include/angles"
stated 'heading in sector 0 to 35' '1e-17 in 0; 0 in 0; -4e-16 in 36; -1e-17 in 36; -1e-15 in 35; ' "$(./run)"
