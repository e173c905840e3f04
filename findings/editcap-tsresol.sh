#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: editcap without options copies a pcapng stamp for stamp, whatever if_tsresol says; resolutions finer than a
#   nanosecond are cut to nanoseconds.
# Seen: with a binary resolution (2^-20 s) each pass moves nearly all stamps one tick back, ten passes ten ticks. With 10^-12
#   the fraction of the second is nonsense, for editcap and tshark alike: 0.123456789123 s is read as 0.012776324 s (the
#   product of fraction and 10^9 exceeds 64 bits).
# Matters: a recording that was copied or merged is no longer bit for bit the one that was recorded, and stamps of the
#   laser and of the robot may swap; recorders should write 10^-9, which survives.
# Version: Wireshark 4.0.17 (4.0.17-0+deb12u3). Source: the pcapng draft allows both in if_tsresol; editcap(1) changes
#   stamps by -t and -S alone.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs wireshark-common=4.0.17-0+deb12u3 tshark=4.0.17-0+deb12u3 libwireshark16=4.0.17-0+deb12u3 \
  libwiretap13=4.0.17-0+deb12u3 libwsutil14=4.0.17-0+deb12u3
cat > stamps.py << 'PYTHON'
"""write FILE RESOLUTION TICKS...: a pcapng of one interface; read FILE: the ticks of its packets."""
import struct
import sys


def block(kind, body):
    return struct.pack("<II", kind, len(body) + 12) + body + struct.pack("<I", len(body) + 12)


def write(file, resolution, ticks):
    out = block(0x0A0D0D0A, struct.pack("<IHHq", 0x1A2B3C4D, 1, 0, -1))
    out += block(1, struct.pack("<HHIHHBxxxHH", 147, 0, 0, 9, 1, resolution, 0, 0))
    for tick in ticks:
        out += block(6, struct.pack("<5I4s", 0, tick >> 32, tick & 0xFFFFFFFF, 4, 4, b"scan"))
    open(file, "wb").write(out)


def read(file):
    data, at, ticks = open(file, "rb").read(), 0, []
    while at < len(data):
        kind, size = struct.unpack_from("<II", data, at)
        if kind == 6:
            high, low = struct.unpack_from("<II", data, at + 12)
            ticks.append(high << 32 | low)
        at += size
    return ticks


if sys.argv[1] == "write":
    write(sys.argv[2], int(sys.argv[3]), [int(tick) for tick in sys.argv[4:]])
else:
    print(*read(sys.argv[2]))
PYTHON
copy() { with_libraries "$root/usr/bin/editcap" "$@"; }

second=1700000000
binary=$((second << 20))
python3 stamps.py write binary.pcapng $((0x80 | 20)) $((binary + 12345)) $((binary + 524288)) $((binary + 1000000))
copy binary.pcapng pass1.pcapng
for pass in {1..9}; do copy "pass$pass.pcapng" "pass$((pass + 1)).pcapng"; done
moved() { for tick in $(python3 stamps.py read "$1"); do printf '%d ' $((tick - binary)); done; }
stated 'ticks of 2^-20 s: 12345 524288 1000000; after 1 and 10 passes' '12344 524288 999999 ; 12335 524288 999990 ' \
  "$(moved pass1.pcapng); $(moved pass10.pcapng)"

python3 stamps.py write nano.pcapng 9 ${second}123456789
copy nano.pcapng nano2.pcapng
stated 'nanoseconds, copied' ${second}123456789 "$(python3 stamps.py read nano2.pcapng)"

python3 stamps.py write pico.pcapng 12 1700123456789123
stated 'picoseconds: 1700.123456789123 s is' 1700.012776324 \
  "$(with_libraries "$root/usr/bin/tshark" -r pico.pcapng -T fields -e frame.time_epoch 2> /dev/null)"
