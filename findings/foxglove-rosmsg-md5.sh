#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: md5() of Foxglove's parser for message definitions gives the checksum that ROS 1 gives the same text; the library is there
#   for it ("suitable for checksum generation").
# Seen: not where a field or a constant is a byte or a char: it is counted as int8 or uint8. Of the 109 messages of seven packages
#   six are wrong: DiagnosticStatus, with it DiagnosticArray, and Log of /rosout, as their levels are bytes; Byte, ByteMultiArray,
#   Char. All others are right.
# Matters: a node that subscribes with such a checksum is refused by every ROS 1 program, and a bag that is written with it is not
#   read; and that just for /diagnostics and /rosout: the scans pass, so the test does. Take the sum from genpy or from a bag.
# Version: @foxglove/rosmsg 5.0.5 (npm), genpy 0.6.16 and messages of Debian 12 as below. Source: the README's introduction;
#   genmsg's gentools.py, which hashes types as they are written; the ROS wiki's msg page has byte and char as aliases.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages @foxglove/rosmsg@5.0.5
debian_files python3-genmsg=0.6.0-1 python3-genpy=0.6.16-2 python3-std-msgs=0.5.13-2 python3-diagnostic-msgs=1.13.1-1 \
  python3-rosgraph-msgs=1.11.3-2 python3-geometry-msgs=1.13.1-1 python3-nav-msgs=1.13.1-1 python3-sensor-msgs=1.13.1-1 \
  python3-actionlib-msgs=1.13.1-1
cat > definitions.py << 'PYTHON'
import importlib
import json

packages = ["std_msgs", "diagnostic_msgs", "rosgraph_msgs", "geometry_msgs", "nav_msgs", "sensor_msgs", "actionlib_msgs"]
messages = [kind for package in packages for kind in vars(importlib.import_module(package + ".msg")).values()
            if hasattr(kind, "_md5sum")]
print(json.dumps([[kind._type, kind._md5sum, kind._full_text] for kind in messages]))
PYTHON
PYTHONPATH=$root/usr/lib/python3/dist-packages /usr/bin/python3 definitions.py > definitions.json
cat > sums.js << 'JS'
const { md5, parse } = require('@foxglove/rosmsg');

const messages = require('./definitions.json');
const wrong = messages.filter(([, sum, text]) => md5(parse(text)) !== sum).map(([name]) => name.split('/')[1]);
console.log(`${wrong.sort().join(' ')} of ${messages.length}`);
JS
stated 'wrong' 'Byte ByteMultiArray Char DiagnosticArray DiagnosticStatus Log of 109' "$(timeout 60 node sums.js)"
