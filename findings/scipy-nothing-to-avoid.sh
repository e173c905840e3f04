#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: in a grid without an obstacle the distance to the nearest one is infinite, or so large that it cannot be missed.
# Seen: scipy's distance_transform_edt measures to a cell that does not exist, just above the first one: 1, 1.41, 2.24 … in
#   the first row, and its nearest obstacle is (-1, 0). Its two siblings tell other things: distance_transform_cdt -1
#   everywhere, distance_transform_bf 1e154. OpenCV 4.6 gives 31622776 with the exact mask, and 8192 with the mask of 5.
# Matters: a window of the map in open space gets costs and likelihoods as if a post stood at its corner, moving along with
#   the window. Ask whether there is an obstacle, first.
# Version: scipy 1.10.1 (1.10.1-2), OpenCV 4.6.0 (4.6.0+dfsg-12). Source: scipy's reference, distance_transform_edt: the
#   distance "to the nearest background point"; nothing is said of arrays that have none.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs python3-scipy=1.10.1-2 python3-opencv=4.6.0+dfsg-12
cat > open_space.py << 'PY'
import cv2
import numpy
from scipy import ndimage

free = numpy.ones((3, 4), numpy.uint8)
distance, nearest = ndimage.distance_transform_edt(free, return_indices=True)
print(*(" ".join(f"{cell:.2f}" for cell in row) for row in distance), sep=" / ", end="; ")
print("nearest", *{(int(row), int(column)) for row, column in zip(nearest[0].flat, nearest[1].flat)})
print("cdt", set(ndimage.distance_transform_cdt(free).ravel().tolist()), end=", ")
print("bf", {float(f"{cell:.0e}") for cell in ndimage.distance_transform_bf(free).ravel()})
exact = cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
print({*exact.ravel().tolist()}, {*cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_5).ravel().tolist()})
PY
mapfile -t seen < <(PYTHONPATH=$root/usr/lib/python3/dist-packages with_libraries /usr/bin/python3 open_space.py)
stated 'edt' '1.00 1.41 2.24 3.16 / 2.00 2.24 2.83 3.61 / 3.00 3.16 3.61 4.24; nearest (-1, 0)' "${seen[0]}"
stated 'siblings' 'cdt {-1}, bf {1e+154}' "${seen[1]}"
stated 'OpenCV, exact and mask of 5' '{31622776.0} {8192.0}' "${seen[2]}"
