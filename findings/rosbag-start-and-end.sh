#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: start and end of a bag are the times of its first and last message by time, whatever was written when.
# Seen: they are those of the first and the last CHUNK. A bag of 200 to 209 s to which messages of 100 to 102 s are added
#   begins at 200 and ends at 102, lasts -98 s by `rosbag info`, and holds nothing between its own start and end; a bag of 200
#   to 209 to which one message of 204 is added ends at 204. Reading all of it brings every message, in order of time.
# Matters: tools that go by get_start_time() and get_end_time() (progress, cuts of the first minute, the length of a drive)
#   leave out half a drive or all of it, after maps, calibration or a second robot's topics were added to it afterwards.
# Version: rosbag 1.15.15 (1.15.15+ds-2). Source: bag format 2.0 asks for no order of chunks and has start and end for each;
#   rosbag's bag.py says of get_end_time "the end time of the bag".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs python3-rosbag=1.15.15+ds-2 python3-std-msgs=0.5.13-2
export PYTHONPATH=$root/usr/lib/python3/dist-packages
cat > added.py << 'PYTHON'
import rosbag
from genpy import Time
from std_msgs.msg import Int32


def added(*times):
    for mode, stamps in ("w", range(200, 210)), ("a", times):
        with rosbag.Bag("drive.bag", mode) as bag:
            for stamp in stamps:
                bag.write("/scan", Int32(stamp), Time(stamp))
    with rosbag.Bag("drive.bag") as bag:
        stamps = [message.data for _, message, _ in bag.read_messages()]
        first, last = Time(bag.get_start_time()), Time(bag.get_end_time())
        inside = sum(1 for _ in bag.read_messages(start_time=first, end_time=last))
        told = next(line.split()[1] for line in str(bag).splitlines() if line.startswith("duration"))
    print(f"{stamps[0]} to {stamps[-1]}, told {first.secs} to {last.secs}, {told}, {inside} of {len(stamps)} inside")


added(100, 101, 102)
added(204)
added(209)
PYTHON
mapfile -t seen < <(with_libraries /usr/bin/python3 added.py)
stated '100 to 102 are added' '100 to 209, told 200 to 102, -98.0s, 0 of 13 inside' "${seen[0]}"
stated '204 is added' '200 to 209, told 200 to 204, 4.0s, 6 of 11 inside' "${seen[1]}"
stated '209 is added' '200 to 209, told 200 to 209, 9.0s, 11 of 11 inside' "${seen[2]}"
