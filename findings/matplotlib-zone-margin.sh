#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: Path.contains_point(point, radius=r) of matplotlib asks whether the point is in the area or nearer than r to it, and a negative r
#   keeps away from its border; its docstring says that the path is extended by r / 2.
# Seen: r / 2 it is, and its sign goes by the winding of the corners: of a zone that is told counterclockwise 0.2 adds a margin of 0.1, of the
#   same zone told clockwise it takes 0.1 away, and -0.2 adds it. contains_points() does the same.
# Matters: the predicate of many scripts that sort poses, bays and hits by zones of a site: drawn outlines come in both
#   windings, so "in the zone, with a margin for the localizer" is stricter for half of the zones. Wind them first.
# Version: matplotlib 3.6.3 (python3-matplotlib 3.6.3-1+b1). Source: the docstring of contains_point(): "additional margin on the path in
#   coordinates of point", "extended tangentially by radius/2", negative values shrink; no word of the winding.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs python3-matplotlib=3.6.3-1+b1 python3-numpy=1:1.24.2-1+deb12u1
cat > margin.py << 'PYTHON'
from matplotlib.path import Path

outline = [(0, 0), (2, 0), (2, 2), (0, 2), (0, 0)]
for corners in (outline, outline[::-1]):
    zone = Path(corners, closed=True)
    for radius in (0, 0.2, -0.2):
        points = [(2 + past, 1) for past in (-0.15, -0.05, 0.05, 0.15)]
        one_by_one = [zone.contains_point(point, radius=radius) for point in points]
        assert one_by_one == list(zone.contains_points(points, radius=radius))
        print("".join("01"[bool(inside)] for inside in one_by_one), end=" ")
PYTHON
cp -r "$root/usr/share/matplotlib/mpl-data" "$root/usr/lib/python3/dist-packages/matplotlib/"
stated '15 and 5 cm within, 5 and 15 beyond the border, by radius 0, 0.2, -0.2; counterclockwise, then clockwise' \
  '1100 1110 1000 1100 1000 1110 ' "$(PYTHONPATH=$root/usr/lib/python3/dist-packages MATPLOTLIBRC=$root/etc/matplotlibrc \
    MPLCONFIGDIR=$work with_libraries timeout 100 /usr/bin/python3 margin.py)"
