#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: with timeout=0.5 pyserial's readline() comes back after half a second at the latest with what is there, as read(10)
#   does; with inter_byte_timeout=0.1 read(10) comes back 0.1 s after the last of four bytes.
# Seen: readline() begins the time anew with each byte: a device that says a byte each 0.3 s and no newline holds it for as long
#   as it talks, here 3 s. inter_byte_timeout ends nothing: read(10) waits for the whole timeout of 2 s, and with none until
#   six more bytes come. read(10) and read_until() keep the time.
# Matters: a loop that has to stop a robot when its odometry stays away, or to send its keep-alive, stands in readline() while a
#   wrong baud rate or a broken line brings bytes. And packets without a length cannot be cut by their pauses. Use read_until(),
#   or read(in_waiting) and a clock of your own.
# Version: pyserial 3.5 (python3-serial 3.5-1.1), on Linux. Source: pyserial's short introduction asks for a timeout with
#   readline, as it "could block forever" without; readline is that of io.RawIOBase, which reads byte by byte; serialposix.py
#   gives inter_byte_timeout to the terminal (VTIME), and reads on until its own time is over.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files python3-serial=3.5-1.1
cat > device.py << 'PYTHON'
import os
import pty
import threading
import time
import tty

import serial


def opened(**options):
    device, line = pty.openpty()
    tty.setraw(line)
    return device, serial.Serial(os.ttyname(line), 9600, **options)


def taken_s(read):
    begin = time.monotonic()
    read()
    return time.monotonic() - begin


def slowly(device):
    for byte in b"0123456789":
        os.write(device, bytes([byte]))
        time.sleep(0.3)


for call, argument in (("readline", -1), ("read_until", b"\n"), ("read", 10)):
    device, port = opened(timeout=0.5)
    talking = threading.Thread(target=slowly, args=(device,))
    talking.start()
    print(call, "within 1.5 s" if taken_s(lambda: getattr(port, call)(argument)) < 1.5 else "for as long as it talks", end="; ")
    talking.join()
device, port = opened(timeout=2, inter_byte_timeout=0.1)
os.write(device, b"abcd")
print("four bytes", "within 1.5 s" if taken_s(lambda: port.read(10)) < 1.5 else "after all of it", end="; ")
device, port = opened(timeout=None, inter_byte_timeout=0.1)
os.write(device, b"abcd")
threading.Timer(4, lambda: os.write(device, b"efghij")).start()
print("without it", "within 1.5 s" if taken_s(lambda: port.read(10)) < 1.5 else "when six more came")
PYTHON
expected='readline for as long as it talks; read_until within 1.5 s; read within 1.5 s; '
expected+='four bytes after all of it; without it when six more came'
stated 'timeout 0.5; then 2, inter-byte 0.1' "$expected" \
  "$(PYTHONPATH=$root/usr/lib/python3/dist-packages timeout 60 /usr/bin/python3 device.py)"
