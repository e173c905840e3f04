#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A Debian amd64 system with its own kernel and the libraries that our programs need, as a disk for an emulated machine, into
# build/target/amd64. Our programs are not in it: they come with each run. Made once; no loop device, no mount. As root.
# usage: adapters_image.sh PROGRAM...
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
source packaging/root.sh
out=$PWD/build/target/amd64
mkdir -p "$out"

libraries=$(dpkg-shlibdeps -O "$@" 2>/dev/null | sed 's/^shlibs:Depends=//')
quiet='MODULES=list\nCOMPRESS=zstd\nBUSYBOX=y\n' needed='virtio_pci\nvirtio_blk\next4\n'
make_root amd64 "$out/root" "systemd,systemd-sysv,udev,kmod,dbus,procps,linux-image-amd64,initramfs-tools,busybox,zstd,$(names_in "$libraries")" \
  "${without_documents[@]}" \
  --essential-hook="mkdir -p \"\$1/etc/initramfs-tools/conf.d\"; printf '$quiet' >\"\$1/etc/initramfs-tools/conf.d/machine\"; printf '$needed' >\"\$1/etc/initramfs-tools/modules\""

if [[ ! -e $out/disk.qcow2 || $out/root.packages -nt $out/disk.qcow2 || $here/guest/agent -nt $out/disk.qcow2 ]]; then
  echo "image: making $out/disk.qcow2" >&2
  install -m 755 "$here/guest/agent" "$out/root/usr/local/sbin/agent"
  install -m 644 "$here/guest/agent.service" "$out/root/etc/systemd/system/agent.service"
  echo robot >"$out/root/etc/hostname"
  echo "/dev/vda / ext4 rw,noatime 0 0" >"$out/root/etc/fstab"
  in_root "$out/root" --chdir=/ passwd -q -d root
  in_root "$out/root" --chdir=/ systemctl --quiet mask apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer fstrim.timer
  in_root "$out/root" --chdir=/ systemctl --quiet enable agent.service
  cp -L "$out"/root/boot/vmlinuz-* "$out/kernel"
  cp -L "$out"/root/boot/initrd.img-* "$out/initrd"
  rm -f "$out/disk.raw" "$out/disk.qcow2"
  mke2fs -q -t ext4 -d "$out/root" -L root "$out/disk.raw" 3000M >/dev/null
  qemu-img convert -O qcow2 "$out/disk.raw" "$out/disk.qcow2"
  rm "$out/disk.raw"
fi
