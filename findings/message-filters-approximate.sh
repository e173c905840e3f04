#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: ApproximateTimeSynchronizer of Python pairs messages as the C++ policy of that name does: scans at 10 Hz and
#   odometry that is told more often, once with the scan's very stamp, come out with equal stamps.
# Seen: C++ waits until no better partner can come, and pairs equal stamps. Python takes the first partner within the
#   slop that is there when the scan comes: 40 ms off, then 20, 40, though the exact one is the next message.
# Matters: a localizer that was tried in Python is fed with odometry 40 ms old (4 cm and 2 degrees at 1 m/s and 1 rad/s),
#   and the error vanishes, or appears, on the way to C++.
# Version: message_filters 1.15.15 (1.15.15+ds-2). Source: the ROS wiki on message_filters/ApproximateTime: the best match,
#   and the output depends on the stamps, not on the arrival; Python's docstring promises neither, under the same name.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs python3-message-filters=1.15.15+ds-2 libmessage-filters1d=1.15.15+ds-2 libroscpp4d=1.15.15+ds-2
debian_files libmessage-filters-dev=1.15.15+ds-2 libroscpp-dev=1.15.15+ds-2 libroscpp-core-dev=0.7.2-8+b2 \
  librosconsole-dev=1.14.3-10+b3 libxmlrpcpp-dev=1.15.15+ds-2 libgeometry-msgs-dev=1.13.1-1+b1 libstd-msgs-dev=0.5.13-2 \
  libroscpp-msg-dev=1.15.15+ds-2 libros-rosgraph-msgs-dev=1.11.3-2 libboost1.74-dev=1.74.0+ds1-21
# What arrives, in order: scans and odometry by their stamps in ms.
arriving='o960 s1000 o1000 o1040 s1100 o1080 o1100 o1140 s1200 o1160 o1200 o1240 s1300 o1300'
cat > pairs.py << 'PYTHON'
import sys

import message_filters
import rospy
from genpy import Time

rospy.rostime.set_rostime_initialized(True)


class Stamped:
    def __init__(self, ms):
        self.header = type("Header", (), {"stamp": Time(0, ms * 1000000)})()


scans, odometry = message_filters.SimpleFilter(), message_filters.SimpleFilter()
synchronizer = message_filters.ApproximateTimeSynchronizer([scans, odometry], 10, 0.06)
synchronizer.registerCallback(lambda scan, wheels: print(
    scan.header.stamp.to_nsec() // 1000000, wheels.header.stamp.to_nsec() // 1000000, sep="-", end=" "))
for word in sys.argv[1:]:
    (scans if word[0] == "s" else odometry).signalMessage(Stamped(int(word[1:])))
PYTHON
cat > pairs.cpp << 'CPP'
#include <geometry_msgs/PointStamped.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>

#include <iostream>
#include <string>

using Stamped = geometry_msgs::PointStamped;
using Policy = message_filters::sync_policies::ApproximateTime<Stamped, Stamped>;

int ms_of(const Stamped::ConstPtr& message) { return static_cast<int>(message->header.stamp.toNSec() / 1000000); }

void print(const Stamped::ConstPtr& scan, const Stamped::ConstPtr& wheels) {
  std::cout << ms_of(scan) << '-' << ms_of(wheels) << ' ';
}

int main(int count, char** words) {
  ros::Time::init();
  message_filters::Synchronizer<Policy> synchronizer(Policy(10));
  synchronizer.setMaxIntervalDuration(ros::Duration(0.06));
  synchronizer.registerCallback(boost::bind(&print, boost::placeholders::_1, boost::placeholders::_2));
  for (int i = 1; i < count; ++i) {
    Stamped::Ptr message(new Stamped);
    message->header.stamp.fromNSec(std::stoull(words[i] + 1) * 1000000);
    const ros::MessageEvent<Stamped const> event(message, message->header.stamp);
    words[i][0] == 's' ? synchronizer.add<0>(event) : synchronizer.add<1>(event);
  }
}
CPP
compiled pairs.cpp -lmessage_filters -lroscpp -lrosconsole -lrostime -l:libboost_thread.so.1.74.0 -Wl,--allow-shlib-undefined
# shellcheck disable=SC2086
stated 'C++, scan-odometry' '1000-1000 1100-1100 1200-1200 1300-1300 ' "$(with_libraries ./run $arriving)"
# shellcheck disable=SC2086
stated 'Python, scan-odometry' '1000-960 1100-1080 1200-1160 1300-1300 ' \
  "$(PYTHONPATH=$root/usr/lib/python3/dist-packages with_libraries /usr/bin/python3 pairs.py $arriving)"
