#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the Debian package of the files as they are, in a copy under build/deb/ARCH/source, and holds it against lintian.
# The packages land in build/deb/ARCH. DEB_BUILD_OPTIONS counts (parallel=N, noautodbgsym). i386 is built on amd64 in a
# root of its own, as root.
# usage: deb.sh [amd64 | i386 | all]   (default: this machine's)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source packaging/root.sh
machine=$(dpkg --print-architecture)
case "${1:-$machine}" in
  amd64 | i386) architectures=("${1:-$machine}") ;;
  all) architectures=(amd64 i386) ;;
  *) echo "deb: $1: the package is for amd64 and i386" >&2; exit 2 ;;
esac

# in_place ARCHITECTURE COMMAND...: on this machine, or in the i386 root
in_place() {
  local architecture=$1
  shift
  if [[ $architecture == "$machine" ]]; then
    "$@"
  elif [[ $architecture == i386 && $machine == amd64 ]]; then
    in_i386 "$@"
  else
    echo "deb: $architecture: cannot be built on $machine" >&2
    exit 2
  fi
}

copy_of_the_tree() {
  git ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do
    [[ ! -e $file && ! -L $file ]] || printf '%s\0' "$file"
  done | tar --null --files-from=- -c | tar -x -C "$1"
  local commit
  commit=$(git rev-parse --short HEAD)
  [[ -z $(git status --porcelain) ]] || commit+=-dirty
  echo "$commit" >"$1/COMMIT"
}

export DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-parallel=$(nproc)} nocheck"
if command -v ccache >/dev/null; then
  CCACHE_DIR=$(ccache --get-config cache_dir)  # debhelper gives the build a home of its own
  export CCACHE_DIR
fi
for architecture in "${architectures[@]}"; do
  [[ $architecture == "$machine" ]] || i386_build_root
  out=$PWD/build/deb/$architecture
  rm -rf "$out"
  mkdir -p "$out/source"
  copy_of_the_tree "$out/source"
  in_place "$architecture" env --chdir="$out/source" dpkg-buildpackage --build=binary --unsigned-changes --unsigned-buildinfo \
    >"$out/build.log" 2>&1 || {
    tail -n 30 "$out/build.log" >&2
    echo "deb: not built; all of it: $out/build.log" >&2
    exit 1
  }
  lintian --allow-root --fail-on error,warning "$out"/*.changes
  ls -s --block-size=KB "$out"/*.deb
done
