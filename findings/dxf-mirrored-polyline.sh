#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: the package dxf lays out a drawing in one place, whether it is asked for polylines or for an SVG; and where it
#   mirrors what is drawn on the back of the plane (extrusion 0 0 -1), it does so for all that DXF tells in such a system.
# Seen: toPolylines() mirrors arcs and circles, and leaves polylines (LWPOLYLINE) where they were: the wall of a site plan
#   stands at x 1 to 3, its rounded corner at -3. toSVG() of the same drawing mirrors both. Lines, which DXF tells in the
#   world's own system, are right in both.
# Matters: mirrored wings of a building and parts from CAD of machines have this extrusion. On the screen all fits, and the
#   walls that are taken for a map lie on the other side, but for their round ends.
# Version: dxf 5.3.1 (npm). Source: Autodesk's DXF reference, "Object Coordinate Systems": LINE in world, LWPOLYLINE, ARC and
#   CIRCLE in object coordinates, whose x axis is the world's backwards where the extrusion is 0 0 -1.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages dxf@5.3.1
cat > plan.cjs << 'JS'
const { Helper } = require('dxf');

const back = [210, 0, 220, 0, 230, -1];
const line = [0, 'LINE', 8, 'walls', 10, 1, 20, 0, 30, 0, 11, 3, 21, 0, 31, 0, ...back];
const polyline = [0, 'LWPOLYLINE', 8, 'walls', 90, 2, 70, 0, 10, 1, 20, 0, 10, 3, 20, 0, ...back];
const arc = [0, 'ARC', 8, 'walls', 10, 3, 20, 1, 30, 0, 40, 1, 50, 270, 51, 360, ...back];
for (const entity of [line, polyline, arc]) {
  const text = [0, 'SECTION', 2, 'ENTITIES', ...entity, 0, 'ENDSEC', 0, 'EOF'].join('\n') + '\n';
  const [{ vertices }] = new Helper(text).toPolylines().polylines;
  const xs = vertices.map(([x]) => x);
  const [, left, , width] = new Helper(text).toSVG().match(/viewBox="(\S+) (\S+) (\S+)/);
  const right = Number(left) + Number(width);
  console.log(`${entity[1]} ${Math.min(...xs)} to ${Math.max(...xs)}, drawn ${left} to ${right}`);
}
JS
stated 'x' 'LINE 1 to 3, drawn 1 to 3|LWPOLYLINE 1 to 3, drawn -3 to -1|ARC -4 to -3, drawn -4 to -3' \
  "$(node plan.cjs | paste -sd '|')"
