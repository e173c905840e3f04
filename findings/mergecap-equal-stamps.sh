#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: where packets of several files bear the same stamp, mergecap keeps the order in which the files were named.
# Seen: the file that was named LAST comes first, and all its packets of that stamp come before those of the others: files
#   x y z with two packets each at one instant are merged as z0 z1 y0 y1 x0 x1.
# Matters: recordings of two ports (or of what was sent and what came back) whose clock ticks in ms or us come out with the
#   answer before the question; a replay that trusts the order of the file differs from the run.
# Version: mergecap of Wireshark 4.0.17 (4.0.17-0+deb12u3). Source: mergecap(1) says that packets are put in
#   chronological order by their stamps and that each file has to be in order; it says nothing of equal ones.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs wireshark-common=4.0.17-0+deb12u3 libwireshark16=4.0.17-0+deb12u3 libwiretap13=4.0.17-0+deb12u3 \
  libwsutil14=4.0.17-0+deb12u3
packets() {  # NAME: a pcap of four packets, NAME0 to NAME3, two at second 1 and two at second 2
  printf '\xd4\xc3\xb2\xa1\x02\x00\x04\x00\0\0\0\0\0\0\0\0\xff\xff\x00\x00\x93\x00\x00\x00'
  for number in 0 1 2 3; do
    printf '%b\0\0\0\0\0\0\0\x02\0\0\0\x02\0\0\0%s%d' "\\x0$((1 + number / 2))" "$1" $number
  done
}
for name in x y z; do packets $name > $name.pcap; done
with_libraries "$root/usr/bin/mergecap" -F pcap -w merged.pcap x.pcap y.pcap z.pcap
stated 'x y z merged' 'z0 z1 y0 y1 x0 x1 z2 z3 y2 y3 x2 x3' "$(grep -aoE '[xyz][0-3]' merged.pcap | paste -sd ' ')"
