#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the i386 package, then the tests in the same build tree, so that they run on the very objects that are delivered,
# and runs them in the i386 root. The programs themselves must do no arithmetic in the x87 unit. As root.
# usage: i386_tests.sh [OPTION-OF-CTEST...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
packaging/deb.sh i386
source packaging/root.sh
built=build/deb/i386/source/build/package
for program in deltamapd deltamap; do
  x87=$(objdump -d --no-show-raw-insn "$built/bin/$program" | awk '$2 ~ /^fi?(add|sub|mul|div|sqrt|prem|scale|patan|ptan|sin|cos|yl2x|2xm1)/' | wc -l)
  if ((x87 != 0)); then
    echo "i386_tests: $program has $x87 instructions that compute in the x87 unit: its results differ from amd64's" >&2
    exit 1
  fi
done
in_i386 cmake -DDELTAMAP_BUILD_TESTS=ON "$built" >build/deb/i386/tests.log 2>&1 || { cat build/deb/i386/tests.log >&2; exit 1; }
in_i386 cmake --build "$built"
in_i386 ctest --test-dir "$built" --output-on-failure -LE '^long$' -j "$(nproc)" "$@"
