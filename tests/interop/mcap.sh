#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# `deltamap export mcap` read by @mcap/core and held against @foxglove/schemas, both from npm: each message fits its schema, the schemas are
# Foxglove's, and times, poses and ranges are those of `deltamap export csv` and `tum`. By hand: it needs node, npm and the network.
# usage: mcap.sh FOLDER-OF-PROGRAMS RECORDING [RUN-FOLDER]
set -euo pipefail
tool=$(readlink -f "$1")/deltamap
recording=$(readlink -f "$2")
run=${3:+$(readlink -f "$3")}
check=$(readlink -f "$(dirname "$0")/mcap.js")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init -y >/dev/null
npm install --no-audit --no-fund --silent @mcap/core@2.2.2 @foxglove/schemas@2.1.0 ajv@8.17.1
"$tool" export csv "$recording" scans.csv
"$tool" export tum "$recording" wheels.tum
"$tool" export mcap "$recording" recording.mcap
NODE_PATH=$work/node_modules node "$check" recording.mcap scans.csv wheels.tum
if [[ -n $run ]]; then
  "$tool" export tum "$run" run.tum
  "$tool" export mcap "$run" run.mcap --recording "$recording"
  NODE_PATH=$work/node_modules node "$check" run.mcap scans.csv wheels.tum run.tum
fi
