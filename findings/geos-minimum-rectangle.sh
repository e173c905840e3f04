#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: GEOS' minimum rotated rectangle is the one of least area around a shape, as OpenCV's minAreaRect and Shapely's, so
#   it is never larger than the box along the axes.
# Seen: it is the one of least WIDTH. Around a pallet load of six by six with two cut corners it is turned by 45 degrees and
#   has 48 square metres, a third more than the upright box of 36. Shapely up to 1.8 computes its own, of 36, from the same
#   corners: Shapely 2 hands the question to GEOS.
# Matters: footprints, bays and parking outlines that are fitted by it turn by 45 degrees and reach over their neighbours,
#   after an update of Shapely or on the way from Python to C++.
# Version: GEOS 3.11.1 (3.11.1-1), Shapely 1.8.5 (1.8.5-2+b1). Source: geos_c.h, GEOSMinimumRotatedRectangle: its width is
#   the minimum diameter; Shapely's manual, minimum_rotated_rectangle: "the general minimum bounding rectangle".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libgeos-c1v5=3.11.1-1 python3-shapely=1.8.5-2+b1
debian_files libgeos-dev=3.11.1-1
cat > rectangle.cpp << 'CPP'
#include <geos_c.h>

#include <cstdio>

int main() {
  initGEOS(nullptr, nullptr);
  GEOSWKTReader* reader = GEOSWKTReader_create();
  GEOSGeometry* load = GEOSWKTReader_read(reader, "POLYGON ((0 0, 6 0, 5 3, 2 6, 0 6, 0 0))");
  double area = 0, width = 0, upright = 0;
  GEOSArea(GEOSMinimumRotatedRectangle(load), &area);
  GEOSLength(GEOSMinimumWidth(load), &width);
  GEOSArea(GEOSEnvelope(load), &upright);
  std::printf("area %.2f, width %.2f, upright box %.2f", area, width, upright);
}
CPP
compiled rectangle.cpp -l:libgeos_c.so.1
stated 'GEOS' 'area 48.00, width 5.66, upright box 36.00' "$(with_libraries ./run)"
cat > rectangle.py << 'PY'
from shapely.geometry import Polygon
from shapely.geos import geos_version_string

load = Polygon([(0, 0), (6, 0), (5, 3), (2, 6), (0, 6)])
print(f"area {load.minimum_rotated_rectangle.area:.2f} over GEOS {geos_version_string.split('-')[0]}")
PY
stated 'Shapely' 'area 36.00 over GEOS 3.11.1' \
  "$(PYTHONPATH=$root/usr/lib/python3/dist-packages with_libraries /usr/bin/python3 rectangle.py)"
