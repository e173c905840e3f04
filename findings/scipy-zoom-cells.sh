#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: ndimage.zoom(map, 2) halves the cells and zoom(map, 0.25) joins four to one: with the same origin and a resolution of
#   0.05 / factor each thing stays where it was. Shrinking by the nearest cell takes one in the middle of the four, in all libraries.
# Seen: zoom lays the CENTRES of the outermost cells on each other: with a factor of a quarter things lie 7.5 cm too far in at one edge of the
#   map, right in the middle, and 7.5 cm off the other way at the other edge; with 2 1.2 cm. grid_mode=True with mode='nearest' does what was
#   guessed. OpenCV's nearest takes the FIRST of four cells, so the map is 7.5 cm off all over, Pillow and scikit-image the third.
# Matters: pyramids of maps for a matcher, and maps for a planner of coarser cells: the pose is off by an amount that depends
#   on where in the map it is, and coarse maps that two programs made of one map do not lie on each other.
# Version: scipy 1.10.1 (1.10.1-2), OpenCV 4.6.0 (4.6.0+dfsg-12), Pillow 9.4.0 (9.4.0-1.1+deb12u1), scikit-image 0.19.3 (0.19.3-8). Source:
#   zoom's docstring has "zoom factor along the axes", and tells of centres under grid_mode only.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs python3-scipy=1.10.1-2 python3-numpy=1:1.24.2-1+deb12u1 python3-opencv=4.6.0+dfsg-12 python3-pil=9.4.0-1.1+deb12u1 \
  python3-skimage=0.19.3-8
cat > zoom.py << 'PYTHON'
import cv2
import numpy
import skimage.transform
from PIL import Image
from scipy import ndimage

middles_cm = (numpy.arange(40) + 0.5) * 5


def off_cm(values, resolution_cm):
    values = numpy.asarray(values).ravel()
    off = values - (numpy.arange(values.size) + 0.5) * resolution_cm
    return " ".join(f"{off[at] + 0:.1f}" for at in (0, -1))


row = middles_cm[None].astype("f4")
print(off_cm(ndimage.zoom(middles_cm, 2, order=1), 2.5))
print(off_cm(ndimage.zoom(middles_cm, 0.25, order=1), 20))
print(off_cm(ndimage.zoom(middles_cm, 0.25, order=1, grid_mode=True, mode="nearest"), 20))
print(off_cm(cv2.resize(row, None, fx=0.25, fy=1, interpolation=cv2.INTER_NEAREST), 20))
print(off_cm(Image.fromarray(row).resize((10, 1), Image.NEAREST), 20))
print(off_cm(skimage.transform.resize(row, (1, 10), order=0, anti_aliasing=False), 20))
PYTHON
seen=$(PYTHONPATH=$root/usr/lib/python3/dist-packages with_libraries timeout 100 /usr/bin/python3 zoom.py | paste -sd '|')
stated 'cm off at both edges: zoom by 2, by 1/4, in grid mode; nearest of OpenCV, Pillow, scikit-image' \
  '1.2 -1.2|-7.5 7.5|0.0 0.0|-7.5 -7.5|2.5 2.5|2.5 2.5' "$seen"
