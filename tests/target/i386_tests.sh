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
tests/target/x87.py "$built/bin/deltamapd" "$built/bin/deltamap"
in_i386 cmake -DDELTAMAP_BUILD_TESTS=ON "$built" >build/deb/i386/tests.log 2>&1 || { cat build/deb/i386/tests.log >&2; exit 1; }
in_i386 cmake --build "$built"
in_i386 ctest --test-dir "$built" --output-on-failure -LE '^long$' -j "$(nproc)" "$@"
