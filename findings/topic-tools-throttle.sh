#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: "throttle messages /scan 20" lets 20 of 25 scans a second through, and 20 of 30: as many as it may.
# Seen: it lets half of them through, 12.5 and 15 a second. What is left are whole fractions of what comes in: all, a half, a third.
#   The time begins anew at the message that was let through, not when it was due, so at 25 a second each second one is
#   "too early" by 10 ms, and the next is 30 ms late.
# Matters: a localizer or a recorder behind it is fed with 12.5 scans a second where 20 were asked for, and one that asks for the
#   very rate that comes (10 of 10) loses the next one after each that comes late: 53 of 80 came through here. Where each n-th
#   message will do, take drop.
# Version: topic_tools 1.15.15 (topic-tools 1.15.15+ds-2). Source: the ROS wiki, topic_tools/throttle: at maximum bandwidth or
#   message rate; throttle.cpp sets g_last_time to now.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs topic-tools=1.15.15+ds-2 python3-rosmaster=1.15.15+ds-2 python3-rospy=1.15.15+ds-2 python3-std-msgs=0.5.13-2
export PYTHONPATH=$root/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries ROS_HOME=$work ROS_LOG_DIR=$work ROS_IP=127.0.0.1
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://127.0.0.1:$port
cat > scans.py << 'PYTHON'
import sys
import time

import rospy
from std_msgs.msg import Header

rospy.init_node("scans", disable_signals=True, disable_rosout=True)
come = []
rospy.Subscriber("/few", Header, come.append)
scans = rospy.Publisher("/scan", Header, queue_size=100)
for _ in range(300):
    if scans.get_num_connections() == 1 and rospy.get_published_topics() and len(come) > 0:
        break
    scans.publish(Header())
    time.sleep(0.1)
time.sleep(0.5)
come.clear()
for hz in map(int, sys.argv[1:]):
    begin = time.monotonic()
    for sent in range(6 * hz):
        time.sleep(max(0.0, begin + sent / hz - time.monotonic()))
        scans.publish(Header(seq=sent))
    time.sleep(0.5)
    print(hz, "half" if 0.4 < len(come) / (6 * hz) < 0.6 else f"{len(come)} of {6 * hz}", end="; ")
    come.clear()
PYTHON
/usr/bin/python3 "$root/usr/bin/rosmaster" --core -p "$port" > master.log 2>&1 &
for _ in {1..50}; do (: < "/dev/tcp/127.0.0.1/$port") 2> /dev/null && break; sleep 0.2; done
"$root/usr/lib/topic_tools/throttle" messages /scan 20 /few > throttle.log 2>&1 &
stated 'let through by a throttle of 20, of so many a second' '25 half; 30 half; ' \
  "$(timeout 60 /usr/bin/python3 scans.py 25 30 2> scans.log)"
