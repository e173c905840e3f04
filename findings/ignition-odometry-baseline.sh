#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: DiffDriveOdometry takes the wheels' angles of its first Update as those from which it counts, or those at Init; after
#   another Init it begins anew at the wheels of then.
# Seen: each Init says that both wheels stand at 0. A robot whose wheels stand at 10 and 12 rad and do not move jumps at the
#   first Update by 1.06 m and 34 degrees, at 10.7 m/s; the same again after a second Init.
# Matters: a program that is started anew beside a controller that goes on counting, or that sets the pose back with Init,
#   places its robot metres off, by what the wheels have turned since they were switched on. Hand it angles less the first.
# Version: gz/ignition math 6.10.0 (libignition-math6-6 6.10.0+ds3-7+b4). Source: DiffDriveOdometry.hh: Init is "Initialize
#   the odometry", Update takes positions of the wheels; that they have to be 0 at Init is not said.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files libignition-math-dev=6.10.0+ds3-7+b4 libignition-math6-6=6.10.0+ds3-7+b4
cat > standing.cpp << 'CPP'
#include <chrono>
#include <cstdio>
#include <ignition/math/DiffDriveOdometry.hh>

using ignition::math::Angle;

int main() {
  std::chrono::steady_clock::time_point now(std::chrono::seconds(100));
  ignition::math::DiffDriveOdometry odometry;
  odometry.SetWheelParams(0.33, 0.0975, 0.0975);
  for (int start = 0; start < 2; ++start) {
    odometry.Init(now);
    for (int tick = 0; tick < 2; ++tick) {
      now += std::chrono::milliseconds(100);
      odometry.Update(Angle(10.0), Angle(12.0), now);
      std::printf("%.2f,%.2f m %.0f deg %.1f m/s; ", odometry.X(), odometry.Y(), odometry.Heading().Degree(),
                  odometry.LinearVelocity());
    }
  }
}
CPP
compiled standing.cpp -isystem "$root/usr/include/ignition/math6" -lignition-math6
jump='1.01,0.31 m 34 deg 10.7 m/s; 1.01,0.31 m 34 deg 5.4 m/s; '
stated 'standing robot: two updates, Init, two updates' "$jump$jump" "$(with_libraries ./run)"
