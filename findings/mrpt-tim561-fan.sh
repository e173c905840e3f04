#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: MRPT's driver of the TiM561 lays the beams where the telegram says: from its start angle on, in its steps, and
#   counterclockwise, as a SICK measures (0 degrees to the right, 90 ahead).
# Seen: start angle and step are not read. Any number of beams is spread over 270 degrees, and from left to right: a post to
#   the right (0 degrees of the telegram) stands to the left behind the robot, at 135 degrees in place of -90, where the
#   laser is set to tell its front 180 degrees; with all of them it is mirrored, 90 in place of -90.
# Matters: a laser on its feet builds a mirrored map, in which everything fits; as soon as somebody narrows its fan, by
#   SOPAS, nothing fits.
# Version: MRPT 2.5.8 (1:2.5.8+ds-2). Source: SICK's "Telegrams for configuring and operating the LMS1xx, …, TiM5xx", LMDscandata:
#   start angle and size of a single angular step, 1/10000 degree, LMPoutputRange sets them; MRPT's header tells no limits.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libmrpt-{comms,config,core,hwdrivers,math,obs,poses,rtti,serialization,system}2.5=1:2.5.8+ds-2
debian_files libmrpt-{bayes,comms,common,config,containers,core,expr,graphs,gui,hwdrivers,img,io,maps}-dev=1:2.5.8+ds-2 \
  libmrpt-{math,obs,opengl,poses,random,rtti,serialization,slam,system,tfest,topography,typemeta,vision}-dev=1:2.5.8+ds-2 \
  libeigen3-dev=3.4.0-4
port=$((20000 + RANDOM % 10000))
cat > laser.py << 'PY'
# A TiM561 in its words (CoLa A): beams of a third of a degree, and a post, 1 m away, where the telegram says 0 degrees.
import socket
import sys

first_deg, beams = int(sys.argv[2]), int(sys.argv[3])
ranges = [4000] * beams
ranges[-3 * first_deg] = 1000
scan = "sRA LMDscandata 1 1 A1B2C3 0 0 1 1 10 10 0 0 0 0 0 5DC A2 0 1 DIST1 3F800000 00000000 "
scan += " ".join(f"{word:X}" for word in (first_deg * 10000 & 0xFFFFFFFF, 3333, beams, *ranges)) + " 0 0 0 0 0 0"
answers = {"sRIO": "sRA 0", "sRN SerialNumber": "sRA SerialNumber 8 12345678", "sRN SCdevicestate": "sRA SCdevicestate 1",
           "sRN FirmwareVersion": "sRA FirmwareVersion 5 V2.50", "sEN LMDscandata 1": "sEA LMDscandata 1", "sRN LMDscandata": scan}
server = socket.create_server(("127.0.0.1", int(sys.argv[1])))
open("ready", "w").close()
line, heard = server.accept()[0], b""
while more := line.recv(4096):
    heard += more
    while b"\x03" in heard:
        question, heard = heard.split(b"\x03", 1)
        line.sendall(b"\x02" + answers[question.strip(b"\x02\0").decode()].encode() + b"\x03")
PY
cat > driver.cpp << 'CPP'
#include <mrpt/hwdrivers/CSICKTim561Eth_2050101.h>

#include <cmath>
#include <cstdio>

int main(int, char** arguments) {
  mrpt::hwdrivers::CSICKTim561Eth laser("127.0.0.1", std::atoi(arguments[1]));
  laser.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  laser.turnOn();
  mrpt::obs::CObservation2DRangeScan scan;
  bool is_there = false, is_broken = false;
  for (int i = 0; i < 5 && !is_there; ++i) laser.doProcessSimple(is_there, scan, is_broken);
  const float per_beam = scan.aperture / (scan.getScanSize() - 1);
  for (size_t i = 0; i < scan.getScanSize(); ++i) {
    if (scan.getScanRange(i) > 2) continue;
    const float from_edge = i * per_beam - scan.aperture / 2;
    std::printf("%zu beams, post at %.0f", scan.getScanSize(), (scan.rightToLeft ? from_edge : -from_edge) * 180 / M_PI);
  }
}
CPP
includes=()
for folder in "$root"/usr/include/mrpt/*/include; do includes+=(-isystem "$folder"); done
compiled driver.cpp "${includes[@]}" -isystem "$root/usr/include/eigen3" -lmrpt-hwdrivers -lmrpt-obs -lmrpt-config -lmrpt-core \
  -lmrpt-system -lmrpt-poses -lmrpt-math -lmrpt-serialization -lmrpt-rtti -lmrpt-comms
post() {
  rm -f ready
  timeout 60 python3 laser.py "$@" &
  for _ in {1..100}; do [[ -e ready ]] && break; sleep 0.1; done
  with_libraries timeout 60 ./run "$1"
}
stated 'from -45 to 225 degrees' '811 beams, post at 90' "$(post $port -45 811)"
stated 'from 0 to 180 degrees' '541 beams, post at 135' "$(post $((port + 1)) 0 541)"
