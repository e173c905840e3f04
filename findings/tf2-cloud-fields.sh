#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: tf2 takes a PointCloud2 into another frame by its named fields: x, y and z are moved wherever they stand in the point, an
#   intensity stays what it is, normals are turned.
# Seen: Python's do_transform_cloud moves the first three fields of a point, whatever their names: of a cloud whose points begin
#   with the intensity it makes intensity = 9, x = 7 where x = 10, y = 1 is right, and says nothing. Normals stay as they were: the
#   wall is in the new frame, and looks where it looked in the old.
# Matters: the order of fields is free, so it hangs on the laser's driver; C++ finds x, y and z by name and is right on the same
#   cloud, but leaves the normals too. What looks at normals after a transform (point-to-plane ICP, floor against wall) is wrong by
#   the mounting angle. Take normals anew in the new frame, and look at the order of the fields in Python.
# Version: tf2_sensor_msgs 0.7.6 (python3-tf2-sensor-msgs 0.7.6-1). Source: PointCloud2.msg: fields describe the channels and their
#   layout; tf2_sensor_msgs.py (p_in[0] to [2]) and tf2_sensor_msgs.h (x, y, z by name, no other field).
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs python3-tf2-sensor-msgs=0.7.6-1
cat > clouds.py << 'PYTHON'
import math

from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import PointCloud2, PointField
from sensor_msgs.point_cloud2 import create_cloud, read_points
from std_msgs.msg import Header
from tf2_sensor_msgs.tf2_sensor_msgs import do_transform_cloud

ahead = TransformStamped()  # the laser is 10 m ahead in x and looks to the left
ahead.transform.translation.x = 10.0
ahead.transform.rotation.z = ahead.transform.rotation.w = math.sqrt(0.5)


def transformed(*point):
    fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, (name, _) in enumerate(point)]
    cloud = create_cloud(Header(), fields, [[value for _, value in point]])
    values = next(read_points(do_transform_cloud(cloud, ahead)))
    return " ".join(f"{name}={round(value, 3) + 0.0:g}" for (name, _), value in zip(point, values))


x_y_z = (("x", 1.0), ("y", 0.0), ("z", 0.0))
print(transformed(*x_y_z, ("intensity", 7.0)), transformed(("intensity", 7.0), *x_y_z),
      transformed(*x_y_z, ("normal_x", 1.0), ("normal_y", 0.0), ("normal_z", 0.0)), sep="; ")
PYTHON
expected='x=10 y=1 z=0 intensity=7; intensity=9 x=7 y=0 z=0; x=10 y=1 z=0 normal_x=1 normal_y=0 normal_z=0'
stated 'from x=1, turned by 90 degrees and moved by 10' "$expected" \
  "$(PYTHONPATH=$root/usr/lib/python3/dist-packages with_libraries timeout 60 /usr/bin/python3 clouds.py)"
