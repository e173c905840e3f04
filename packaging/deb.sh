#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the Debian package of the files as they are, in a copy under build/deb/ARCH/source, and holds it against lintian.
# The packages land in build/deb/ARCH. DEB_BUILD_OPTIONS counts (parallel=N, noautodbgsym). i386 is built on amd64 in a
# root of its own, as root. What was compiled stays in the copy and is used again for files whose content is as it was, as
# long as flags, debian/rules, compiler and libraries are the same: else all of it is compiled anew. build/release is of no
# use here: it has other flags. No tests run: ./dev test does that.
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

say() { echo "deb: $architecture: $*, $((SECONDS / 60)) min $((SECONDS % 60)) s" >&2; }

files_of_the_tree() {
  git ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do
    [[ ! -e $file && ! -L $file ]] || printf '%s\0' "$file"
  done
}

# copy_of_the_tree FOLDER: files whose content is as it was in there keep their time, all others get the present one: that
# is what ninja goes by. What was compiled in there stays.
copy_of_the_tree() {
  local before=$1.before file commit
  rm -rf "$before"
  [[ ! -e $1 ]] || mv "$1" "$before"
  mkdir -p "$1"
  files_of_the_tree | tar --null --files-from=- -c | tar --touch -x -C "$1"
  commit=$(git rev-parse --short HEAD)
  [[ -z $(git status --porcelain) ]] || commit+=-dirty
  echo "$commit" >"$1/COMMIT"
  [[ -e $before ]] || return 0
  while IFS= read -r -d '' file; do
    ! cmp -s "$before/$file" "$1/$file" || touch --no-dereference --reference="$before/$file" "$1/$file"
  done < <(files_of_the_tree && printf 'COMMIT\0')
  [[ ! -e $before/build ]] || mv "$before/build" "$1/build"
  rm -rf "$before"
}

# What objects depend on beside the tree: dpkg's flags, how they are used, compiler and libraries.
made_with() {
  cat debian/rules
  in_place "$architecture" env DEB_BUILD_MAINT_OPTIONS=hardening=+all dpkg-buildflags
  in_place "$architecture" dpkg-query -W -f '${Package} ${Version} ${db:Status-Status}\n' \
    '*-dev' 'gcc-*' 'g++-*' 'cpp-*' 'binutils*' cmake ninja-build debhelper 'dpkg*' | grep ' installed$'
}

# Tells from the build's log on the standard input how far it is: each step, and each tenth of the compiling.
progress() {
  local line tenth=0 at
  while IFS= read -r line; do
    case $line in
      '   '*dh_auto_configure*) say "configures" ;;
      '   dh_auto_build'*) say "compiles" ;;
      '['[0-9]*/[0-9]*']'*)
        line=${line#[} line=${line%%]*}
        at=$((10 * ${line%/*} / ${line#*/}))
        ((at == tenth)) || say "${line%/*} of ${line#*/} steps of compiling"
        tenth=$at
        ;;
      '   dh_auto_install'*) break ;;
    esac
  done
  [[ -z $line ]] || say "packs"
  cat >/dev/null
}

export DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-parallel=$(nproc)} nocheck"
if command -v ccache >/dev/null; then
  CCACHE_DIR=$(ccache --get-config cache_dir)  # debhelper gives the build a home of its own
  export CCACHE_DIR
fi
for architecture in "${architectures[@]}"; do
  [[ $architecture == "$machine" ]] || i386_build_root
  out=$PWD/build/deb/$architecture
  mkdir -p "$out"
  find "$out" -mindepth 1 -maxdepth 1 ! -name 'source*' -exec rm -rf {} +
  if [[ $(made_with) != "$(cat "$out/source.made-with" 2>/dev/null)" ]]; then
    say "compiles all anew: the first time, or with other flags, compiler or libraries"
    rm -rf "$out/source"
    made_with >"$out/source.made-with"
  fi
  copy_of_the_tree "$out/source"
  # Without the cleaning before: it would remove what was compiled; nothing else of an earlier build is in the copy.
  in_place "$architecture" env --chdir="$out/source" dpkg-buildpackage --build=binary --no-pre-clean --unsigned-changes \
    --unsigned-buildinfo 2>&1 | tee "$out/build.log" | progress || {
    tail -n 30 "$out/build.log" >&2
    echo "deb: not built; all of it: $out/build.log" >&2
    exit 1
  }
  say "held against lintian"
  lintian --allow-root --fail-on error,warning "$out"/*.changes
  ls -s --block-size=KB "$out"/*.deb
done
