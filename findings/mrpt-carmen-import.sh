#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: MRPT's reader of CARMEN logs (carmen2rawlog) takes the 180 ranges of an FLASER line as a fan of 180 degrees that
#   starts at -90 in steps of 1, as CARMEN does, and keeps the time between lines.
# Seen: without a PARAM line, as in the public logs, the step is 0.5 and the fan -45 to 45 degrees. With "PARAM
#   laser_front_laser_resolution 1.0" it is stretched to -90..90, a step of 1.0056, up to a degree off at the left end. And
#   scans that are 50 s apart get stamps 50 ns apart or less, of "now" in place of the log's day.
# Matters: a data set that was converted so has rooms with the wrong shape, and each filter that looks at time between
#   scans (odometry noise, timeouts, playback) sees none pass.
# Version: MRPT 2.5.8 (1:2.5.8+ds-2). Source: carmen_log_tools.h: the sensor's place is taken from the log, time_start_log is
#   "the real timestamp that corresponds to a 0 in the CARMEN log"; CARMEN's logger writes seconds.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libmrpt-obs2.5=1:2.5.8+ds-2
debian_files libmrpt-{common,core,containers,system,typemeta,serialization,rtti,math,poses,obs,bayes,random,io,config}-dev=1:2.5.8+ds-2 \
  libmrpt-{img,opengl,expr,tfest}-dev=1:2.5.8+ds-2 libeigen3-dev=3.4.0-4
cat > carmen.cpp << 'CPP'
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/carmen_log_tools.h>

#include <cmath>
#include <cstdio>
#include <sstream>

int main() {
  std::string ranges;
  for (int i = 0; i < 180; ++i) ranges += " 2.5";
  std::ostringstream log;
  for (const char* time : {"976052857.100000", "976052907.100000"}) log << "FLASER 180" << ranges << " 0 0 0 0 0 0 " << time << " host 0\n";
  log << "PARAM laser_front_laser_resolution 1.0 976052907.2 host 0\nFLASER 180" << ranges << " 0 0 0 0 0 0 976052957.100000 host 0\n";
  std::istringstream lines(log.str());
  double before_s = 0.0;
  for (int line = 0; line < 4; ++line) {
    std::vector<mrpt::obs::CObservation::Ptr> read;
    mrpt::obs::carmen_log_parse_line(lines, read, mrpt::Clock::fromDouble(0));
    for (const auto& one : read) {
      const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(one);
      if (!scan) continue;
      const double degree = M_PI / 180.0, time_s = mrpt::Clock::toDouble(scan->timestamp);
      std::printf("%g..%g step %.4f", scan->getScanAngle(0) / degree, scan->getScanAngle(179) / degree,
                  (scan->getScanAngle(1) - scan->getScanAngle(0)) / degree);
      std::printf(before_s == 0.0 ? "; " : time_s - before_s < 1e-6 ? " less than 1 us later; " : " later; ");
      before_s = time_s;
    }
  }
}
CPP
includes=$(printf -- '-isystem %s ' "$root"/usr/include/mrpt/*/include "$root/usr/include/eigen3")
# shellcheck disable=SC2086
compiled carmen.cpp $includes -lmrpt-obs -lmrpt-poses -lmrpt-math -lmrpt-system -lmrpt-core -Wl,--allow-shlib-undefined
stated 'FLASER 180, a second one 50 s later, a third with PARAM' \
  '-45..45 step 0.5028; -45..45 step 0.5028 less than 1 us later; -90..90 step 1.0056 less than 1 us later; ' \
  "$(with_libraries ./run)"
