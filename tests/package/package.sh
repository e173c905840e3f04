#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The Debian package in a clean Debian root: every file, what installing does and does not do, the tool and the daemon
# outside the repository, upgrade, remove, purge. As root, with mmdebstrap; the root needs no network once it is made.
# usage: package.sh [PACKAGE.deb]   (default: builds it with packaging/deb.sh)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
source packaging/root.sh

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

# The same package with another version, and another delivered configuration.
as_version() {
  local tree=$work/tree
  rm -rf "$tree"
  dpkg-deb -R "$deb" "$tree"
  sed -i "s/^Version: .*/Version: $1/" "$tree/DEBIAN/control"
  echo "# delivered with $1" >>"$tree/etc/deltamap/deltamap.yaml"
  dpkg-deb --root-owner-group -b "$tree" "$root/deltamap_$1.deb" >/dev/null
}

make_root "$architecture" "$root" "$(names_in "$(dpkg-deb -f "$deb" Depends)"),systemd"
cp "$deb" "$root/deltamap_$version.deb"
as_version "$version+1"
as_version "$version+2"
install -m 755 "$here/inside.sh" "$root/inside.sh"
# Processes of its own, too: what runs on this machine is not seen, and not ended.
unshare --pid --fork bash -c 'source packaging/root.sh; in_root "$1" --chdir=/ /inside.sh "$2"' package "$root" "$version"
