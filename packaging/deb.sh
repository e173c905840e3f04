#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the Debian package of the files as they are, in a copy under build/deb/ARCH/source, and holds it against lintian.
# The packages land in build/deb/ARCH. DEB_BUILD_OPTIONS counts (parallel=N, noautodbgsym).
# usage: deb.sh [amd64]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
architecture=${1:-amd64}
machine=$(dpkg --print-architecture)
if [[ $architecture != "$machine" ]]; then
  echo "deb: $architecture: this machine is $machine, and a package is built on its own architecture only" >&2
  exit 2
fi

out=$PWD/build/deb/$architecture
source=$out/source
rm -rf "$out"
mkdir -p "$source"
git ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do
  [[ ! -e $file && ! -L $file ]] || printf '%s\0' "$file"
done | tar --null --files-from=- -c | tar -x -C "$source"

commit=$(git rev-parse --short HEAD)
[[ -z $(git status --porcelain) ]] || commit+=-dirty
echo "$commit" >"$source/COMMIT"

export DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-parallel=$(nproc)} nocheck"
if command -v ccache >/dev/null; then
  CCACHE_DIR=$(ccache --get-config cache_dir)  # debhelper gives the build a home of its own
  export CCACHE_DIR
fi
(cd "$source" && dpkg-buildpackage --build=binary --unsigned-changes --unsigned-buildinfo) >"$out/build.log" 2>&1 || {
  tail -n 30 "$out/build.log" >&2
  echo "deb: not built; all of it: $out/build.log" >&2
  exit 1
}
lintian --allow-root --fail-on error,warning "$out"/*.changes
ls -s --block-size=KB "$out"/*.deb
