# SPDX-License-Identifier: Apache-2.0
# Debian roots of their own, clean or of another architecture: sourced by what builds and tests the package. An amd64
# processor runs i386 programs itself, so a root is a folder and a chroot. Mounts live in a namespace of their own:
# nothing stays mounted, whatever ends.

release() { (. /etc/os-release && echo "$VERSION_CODENAME"); }

# The sources of this machine's own apt: whatever mirror or snapshot it is set up with.
sources() {
  apt-get indextargets --format '$(ORIGIN)|$(REPO_URI)|$(RELEASE)|$(COMPONENT)' 'Created-By: Packages' |
    awk -F'|' -v s="$(release)" '$1=="Debian" && ($3==s || $3==s"-updates" || $3==s"-security") {print "deb "$2" "$3" "$4}' | sort -u
}

# usable_sources ARCHITECTURE: those whose lists can be fetched whole; a mirror may hold an old list of one architecture.
usable_sources() {
  local architecture=$1 line state
  state=$(mktemp -d)
  while read -r line; do
    rm -rf "$state/lists" && mkdir -p "$state/lists/partial" "$state/cache/archives/partial" "$state/parts"
    echo "$line" >"$state/list" && : >"$state/status"
    if apt-get -qq --error-on=any -o Dir::State="$state" -o Dir::State::status="$state/status" -o Dir::Cache="$state/cache" \
      -o Dir::Etc::SourceList="$state/list" -o Dir::Etc::SourceParts="$state/parts" -o APT::Sandbox::User=root \
      -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" update >"$state/log" 2>&1; then
      echo "$line"
    else
      echo "root: left out for $architecture: $(cut -d' ' -f3- <<<"$line"): $(grep -m 1 '^E:' "$state/log")" >&2
    fi
  done < <(sources)
  rm -rf "$state"
}

# names_in DEPENDENCIES: their names with commas between, of alternatives the first, without versions and architectures
names_in() { tr ',\n' '\n ' <<<"$1" | sed -E 's/\|.*//; s/\(.*//; s/\[.*//; s/[[:space:]]//g' | grep . | paste -sd,; }

# make_root ARCHITECTURE FOLDER PACKAGE,PACKAGE... [OPTION of mmdebstrap...]: makes it anew where it has other packages
make_root() {
  local architecture=$1 folder=$2 packages=$3
  shift 3
  [[ ! -e $folder.packages || $(<"$folder.packages") != "$packages" ]] || return 0
  if ((EUID != 0)); then
    echo "root: a root of its own can only be made by root: try sudo" >&2
    return 1
  fi
  echo "root: making $folder, 1 to 2 GB from Debian's archive" >&2
  rm -rf --one-file-system "$folder" "$folder.packages"
  mkdir -p "$(dirname "$folder")"
  usable_sources "$architecture" | mmdebstrap --quiet --architectures="$architecture" --variant=apt --mode=root \
    --aptopt='Apt::Install-Recommends "false"' --dpkgopt='force-unsafe-io' --include="$packages" "$@" "$(release)" "$folder" - || return
  echo "$packages" >"$folder.packages"
}

without_documents=(--dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/man/*'
  --dpkgopt='path-exclude=/usr/share/locale/*')

# in_root FOLDER [NAME=VALUE...] COMMAND...: runs it in the root, in the same working folder. The folders in the array
# root_binds are there under their own names. With in_root_as=exec the command takes the place of the shell.
root_binds=()
in_root_as=
in_root() {
  local folder=$1
  shift
  $in_root_as unshare --mount --propagation private bash -euc '
    root=$1 binds=$2; shift 2
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount -t sysfs -o ro sysfs "$root/sys"  # what kind of device a number is
    while IFS= read -r bound; do
      [[ -z $bound ]] || { mkdir -p "$root$bound"; mount --bind "$bound" "$root$bound"; }
    done <<<"$binds"
    machine=$(uname -m)
    [[ $(dpkg --root="$root" --print-architecture) != i386 ]] || machine=i686
    exec setarch "$machine" chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
      env --chdir="$PWD" "$@"
  ' in_root "$folder" "$(printf '%s\n' "${root_binds[@]}")" "$@"
}

# What an i386 build needs: the package's own build dependencies, and what tests and measures it.
i386_build_root() {
  local needed
  needed=$(names_in "$(sed -n '/^Build-Depends:/,/^[A-Z]/{s/^Build-Depends://;/^[A-Z]/d;p}' debian/control)")
  make_root i386 "$PWD/build/i386-root" "build-essential,${needed/debhelper-compat/debhelper},libgtest-dev,libbenchmark-dev,ccache,valgrind,git" \
    "${without_documents[@]}"
}

# in_i386 COMMAND...: in that root, with this source tree, the compiler's cache and the real logs
in_i386() {
  local data=${DELTAMAP_DATA:-$PWD/../shared/data} environment=() name
  local root_binds=("$PWD")
  if [[ -d $data ]]; then
    data=$(realpath "$data")
    root_binds+=("$data")
    environment+=("DELTAMAP_DATA=$data")
  fi
  if command -v ccache >/dev/null; then
    local CCACHE_DIR
    CCACHE_DIR=$(ccache --get-config cache_dir)
    mkdir -p "$CCACHE_DIR"
    root_binds+=("$CCACHE_DIR")
  fi
  for name in CMAKE_C_COMPILER_LAUNCHER CMAKE_CXX_COMPILER_LAUNCHER CCACHE_DIR CCACHE_BASEDIR CCACHE_NOHASHDIR CCACHE_SLOPPINESS \
    DEB_BUILD_OPTIONS DEB_BUILD_MAINT_OPTIONS TMPDIR; do
    [[ -z ${!name:-} ]] || environment+=("$name=${!name}")
  done
  in_root "$PWD/build/i386-root" "${environment[@]}" "$@"
}
