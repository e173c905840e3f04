#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A Debian i386 system with what the package needs, into build/target/root: for the container as it is, for the emulated
# machine as a disk with its kernel. Made once; no loop device, no mount. As root.
# usage: image.sh PACKAGE.deb [disk]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
source packaging/root.sh
deb=$(readlink -e "$1") || { echo "image: $1: no such file" >&2; exit 2; }
out=$PWD/build/target

quiet='MODULES=list\nCOMPRESS=zstd\nBUSYBOX=y\n' needed='virtio_pci\nvirtio_blk\next4\n'
make_root i386 "$out/root" "systemd,systemd-sysv,udev,kmod,dbus,procps,linux-image-686-pae,initramfs-tools,busybox,zstd,$(names_in "$(dpkg-deb -f "$deb" Depends)")" \
  "${without_documents[@]}" \
  --essential-hook="mkdir -p \"\$1/etc/initramfs-tools/conf.d\"; printf '$quiet' >\"\$1/etc/initramfs-tools/conf.d/machine\"; printf '$needed' >\"\$1/etc/initramfs-tools/modules\""

if [[ ! -e $out/root/etc/systemd/system/agent.service || ${2:-} == disk && ! -e $out/disk.qcow2 || $here/guest/agent -nt $out/disk.qcow2 ]]; then
  install -m 755 "$here/guest/agent" "$out/root/usr/local/sbin/agent"
  install -m 644 "$here/guest/agent.service" "$out/root/etc/systemd/system/agent.service"
  echo netbook >"$out/root/etc/hostname"
  echo "/dev/vda / ext4 rw,noatime 0 0" >"$out/root/etc/fstab"
  in_root "$out/root" --chdir=/ passwd -q -d root
  in_root "$out/root" --chdir=/ systemctl --quiet mask apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer fstrim.timer
  if [[ ${2:-} == disk ]]; then
    echo "image: making $out/disk.qcow2" >&2
    in_root "$out/root" --chdir=/ systemctl --quiet enable agent.service
    cp -L "$out"/root/boot/vmlinuz-* "$out/kernel"
    cp -L "$out"/root/boot/initrd.img-* "$out/initrd"
    rm -f "$out/disk.raw" "$out/disk.qcow2"
    mke2fs -q -t ext4 -d "$out/root" -L root "$out/disk.raw" 1500M >/dev/null
    qemu-img convert -O qcow2 "$out/disk.raw" "$out/disk.qcow2"
    rm "$out/disk.raw"
    in_root "$out/root" --chdir=/ systemctl --quiet disable agent.service
  fi
fi
