#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: GDAL burns a polygon into the cells whose centres are inside, and of centres that lie on the border it takes one side, left
#   or right and lower or upper, as scan converters do: a square of three metres is nine cells of a metre, wherever it lies, and
#   zones side by side share none.
# Seen: with the border on centres the square has 12 cells: three columns by FOUR rows. Columns are half open, rows are closed. Of two zones that
#   lie above each other the row between belongs to both, and to the one that is burned last; beside each other they share none.
# Matters: sites are drawn on rounded coordinates, and maps of 5 cm whose origin is -12.525 have their centres on these. Keep-out zones grow to
#   the north and south by a row, not to the east and west, areas by counted cells are wrong, and the order of features decides.
# Version: GDAL 3.6.2 (python3-gdal 3.6.2+dfsg-1+b2). Source: gdal_rasterize's page: without ALL_TOUCHED the cells "on the line render path or
#   whose center point is within the polygon".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs python3-gdal=3.6.2+dfsg-1+b2 python3-numpy=1:1.24.2-1+deb12u1
cat > zones.py << 'PYTHON'
from osgeo import gdal, ogr


def box(left, low, right, high):
    return f"POLYGON(({left} {low},{right} {low},{right} {high},{left} {high},{left} {low}))"


def burned(*zones):
    source = ogr.GetDriverByName("Memory").CreateDataSource("")
    layer = source.CreateLayer("zones")
    layer.CreateField(ogr.FieldDefn("number", ogr.OFTInteger))
    for number, zone in enumerate(zones, 1):
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetField(0, number)
        feature.SetGeometry(ogr.CreateGeometryFromWkt(zone))
        layer.CreateFeature(feature)
    grid = gdal.GetDriverByName("MEM").Create("", 8, 8, 1)
    grid.SetGeoTransform([0, 1, 0, 8, 0, -1])
    gdal.RasterizeLayer(grid, [1], layer, options=["ATTRIBUTE=number"])
    return grid.ReadAsArray()


def counts(cells):
    return " and ".join(str((cells == number).sum()) for number in range(1, cells.max() + 1))


gdal.PushErrorHandler("CPLQuietErrorHandler")
square = burned(box(1.5, 1.5, 4.5, 4.5))
print(f"{(square.any(0)).sum()} columns by {square.any(1).sum()} rows", counts(burned(box(1.2, 1.2, 4.2, 4.2))),
      counts(burned(box(1.5, 1.5, 3.5, 3.5), box(3.5, 1.5, 5.5, 3.5))), counts(burned(box(1.5, 1.5, 3.5, 3.5), box(1.5, 3.5, 3.5, 5.5))),
      sep="; ")
PYTHON
rasterized() {
  PYTHONPATH=$root/usr/lib/python3/dist-packages GDAL_DATA=$root/usr/share/gdal PROJ_LIB=$root/usr/share/proj with_libraries \
    timeout 100 /usr/bin/python3 zones.py
}
stated 'on centres; beside them; side by side; one above the other' \
  '3 columns by 4 rows; 9; 6 and 6; 4 and 6' "$(rasterized)"
