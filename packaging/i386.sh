#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command in the i386 build root, in this source tree: its programs run as fast as any.
# usage: i386.sh COMMAND...
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source packaging/root.sh
i386_build_root
in_root_as=exec  # it gets the signals
in_i386 "$@"
