#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: the union of two bays that meet in a corner only is two polygons, as GeoJSON wants it, whichever corners meet.
# Seen: two polygons if the one stands to the upper right of the other; if it stands to the lower right, one ring that runs through the
#   corner twice and round the two bays in opposite directions. Its area, by the shoelace sum, is 0 of 8 square metres; of bays of 8 and
#   4 square metres it is 4 of 12. What is left of a square without two bays on its diagonal is such a ring too. polygon-clipping gives two polygons for both.
# Matters: floor areas, zones and freed bays from it: half of the chequered layouts lose area, and each checker of GeoJSON or
#   OGC geometry refuses what was made of valid input; mirrored, the same site passes.
# Version: martinez-polygon-clipping 0.8.1 (npm, as a module; 0.7.4 gives the same), polygon-clipping 0.15.7. Source: its README takes and gives
#   GeoJSON coordinates; RFC 7946 asks for linear rings, and OGC's simple features for rings that do not cross themselves.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages martinez-polygon-clipping@0.8.1 polygon-clipping@0.15.7
cat > corner.mjs << 'JS'
import * as martinez from 'martinez-polygon-clipping';
import clipping from 'polygon-clipping';

const box = (left, low, right, high) => [[[left, low], [right, low], [right, high], [left, high], [left, low]]];
const area = (ring) => Math.abs(ring.slice(1).reduce((sum, [x, y], i) => sum + ring[i][0] * y - x * ring[i][1], 0)) / 2;
const told = (polygons) => `${polygons.length} of ${polygons.map(([outer]) => area(outer)).join(' and ')}`;
const left = box(0, 2, 2, 4), lower = box(0, 0, 2, 2), right = box(2, 0, 4, 2), upper = box(2, 2, 4, 4), large = box(2, -2, 4, 2);
for (const [a, b] of [[lower, upper], [left, right], [left, large]]) {
  console.log(told(martinez.union(a, b)), '/', told(clipping.union(a, b)));
}
const floor = box(0, 0, 4, 4);
console.log(told(martinez.diff(floor, [lower, upper])), '/', told(clipping.difference(floor, [lower, upper])));
JS
mapfile -t seen < <(timeout 60 node corner.mjs)
stated 'upper right' '2 of 4 and 4 / 2 of 4 and 4' "${seen[0]}"
stated 'lower right' '1 of 0 / 2 of 4 and 4' "${seen[1]}"
stated 'lower right, 4 and 8' '1 of 4 / 2 of 4 and 8' "${seen[2]}"
stated 'a floor without two corners' '1 of 0 / 2 of 4 and 4' "${seen[3]}"
