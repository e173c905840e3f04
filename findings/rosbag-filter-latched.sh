#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: "rosbag filter IN OUT True" and "rosbag compress" keep what was recorded: two nodes that each latch their own
#   /tf_static stay two connections with two names.
# Seen: both merge all publishers of a topic into the first one's connection. The messages are all there, the second
#   node's name is gone, and with it its latch: a player latches per connection.
# Matters: played from a filtered or compressed bag, whoever listens late gets the last /tf_static alone: the laser's
#   mount is missing, though "rosbag info" shows the same topics and counts as before.
# Version: rosbag 1.15.15 (python3-rosbag 1.15.15+ds-2). Source: Bag.write keeps one connection a topic and looks at
#   connection_header, which its docstring leaves out, for the first message alone; player.cpp makes one publisher for each
#   pair of node and topic.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs python3-rosbag=1.15.15+ds-2 python3-std-msgs=0.5.13-2
export PYTHONPATH=$root/usr/lib/python3/dist-packages
cat > bags.py << 'PYTHON'
"""write FILE: two latched publishers of one topic; read FILE: who has published what."""
import sys

import rosbag
from genpy import Time
from std_msgs.msg import String

if sys.argv[1] == "write":
    with rosbag.Bag(sys.argv[2], "w") as bag:
        for node in ("/laser", "/camera"):
            bag._topic_connections.clear()  # else Bag.write itself merges them, as a recorder of C++ does not
            bag.write("/tf_static", String(data=node), Time(1), connection_header={
                "topic": "/tf_static", "type": String._type, "md5sum": String._md5sum,
                "message_definition": String._full_text, "callerid": node, "latching": "1"})
else:
    with rosbag.Bag(sys.argv[2]) as bag:
        for _, message, _, header in bag.read_messages(return_connection_header=True):
            node = header["callerid"]
            print(f"{message.data} by {node.decode() if isinstance(node, bytes) else node}", end=", ")
        print(bag.get_message_count(), "messages")
PYTHON
python() { with_libraries /usr/bin/python3 "$@"; }
python bags.py write recorded.bag
python "$root/usr/bin/rosbag" filter recorded.bag filtered.bag True > /dev/null
mkdir compressed
python "$root/usr/bin/rosbag" compress --quiet --output-dir=compressed recorded.bag > /dev/null
stated recorded '/laser by /laser, /camera by /camera, 2 messages' "$(python bags.py read recorded.bag)"
stated filtered '/laser by /laser, /camera by /laser, 2 messages' "$(python bags.py read filtered.bag)"
stated compressed '/laser by /laser, /camera by /laser, 2 messages' "$(python bags.py read compressed/recorded.bag)"
