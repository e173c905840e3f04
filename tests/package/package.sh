#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The Debian package in a clean Debian root: every file, what installing does and does not do, the tool and the daemon
# outside the repository, upgrade, remove, purge. As root, with mmdebstrap; the root needs no network once it is made.
# usage: package.sh [PACKAGE.deb]   (default: builds it with packaging/deb.sh)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."

if ((EUID != 0)); then
  echo "package: a root of its own can only be made by root" >&2
  exit 1
fi
if (($#)); then
  deb=$(readlink -e "$1") || { echo "package: $1: no such file" >&2; exit 2; }
else
  packaging/deb.sh
  deb=$(readlink -e build/deb/"$(dpkg --print-architecture)"/deltamap_*.deb)
fi

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
root=$work/root
architecture=$(dpkg-deb -f "$deb" Architecture)
version=$(dpkg-deb -f "$deb" Version)

# The sources of this machine's own apt: whatever mirror or snapshot it is set up with.
sources() {
  local suite
  suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
  apt-get indextargets --format '$(ORIGIN)|$(REPO_URI)|$(RELEASE)|$(COMPONENT)' 'Created-By: Packages' |
    awk -F'|' -v s="$suite" '$1=="Debian" && ($3==s || $3==s"-updates" || $3==s"-security") {print "deb "$2" "$3" "$4}' | sort -u
}

# The first alternative of each dependency, without its version: dpkg checks the versions.
dependencies() { dpkg-deb -f "$deb" Depends | tr ',' '\n' | sed -E 's/\|.*//; s/\(.*//; s/[[:space:]]//g' | paste -sd,; }

# The same package with another version, and another delivered configuration.
as_version() {
  local tree=$work/tree
  rm -rf "$tree"
  dpkg-deb -R "$deb" "$tree"
  sed -i "s/^Version: .*/Version: $1/" "$tree/DEBIAN/control"
  echo "# delivered with $1" >>"$tree/etc/deltamap/deltamap.yaml"
  dpkg-deb --root-owner-group -b "$tree" "$root/deltamap_$1.deb" >/dev/null
}

echo "package: making a clean root" >&2
sources | mmdebstrap --quiet --architectures="$architecture" --variant=apt --mode=root --aptopt='Apt::Install-Recommends "false"' \
  --dpkgopt='force-unsafe-io' --include="$(dependencies),systemd" "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root" -
cp "$deb" "$root/deltamap_$version.deb"
as_version "$version+1"
as_version "$version+2"
install -m 755 "$here/inside.sh" "$root/inside.sh"
# Processes of its own, too: what runs on this machine is not seen, and not ended.
unshare --mount --pid --fork --propagation private bash -c '
  root=$1; shift
  mount -t proc proc "$root/proc"; mount --bind /dev "$root/dev"
  exec chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"
' inside "$root" /inside.sh "$version"
