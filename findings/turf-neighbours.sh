#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: Turf's predicates are those of OGC's simple features, as each of them says: bays that share an edge touch and do not
#   overlap, an area that crosses itself is not valid, and a zone with a hole does not contain what fills the hole.
# Seen: bays side by side overlap by booleanOverlap; a hall touches the bay in its corner, all inside, by booleanTouches, and
#   the bay does not touch the hall; a bow tie, whose area is 0, and an area with a hole that lies outside of it are valid;
#   a zone with a pit contains a vehicle that stands over the pit, corners beyond it.
# Matters: a dispatcher's page that checks drawn areas by them refuses rows of bays, lets a crossed zone pass, of which no
#   program that follows says which half is inside, and sends a vehicle over a pit.
# Version: @turf/turf 7.4.0 (npm). Source: its README: booleanOverlap wants an intersection of the same dimension,
#   booleanTouches no common point in both insides, booleanValid "according to the OGC Simple Feature Specification",
#   booleanContains no point of the second outside of the first.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages @turf/turf@7.4.0
cat > zones.mjs << 'JS'
import * as turf from '@turf/turf';

const area = (...rings) => turf.polygon(rings.map((ring) => [...ring, ring[0]]));
const box = (left, low, right, high) => [[left, low], [right, low], [right, high], [left, high]];
const bay = area(box(0, 0, 2, 2)), next = area(box(2, 0, 4, 2)), hall = area(box(0, 0, 9, 9));
const bowTie = area([[0, 0], [2, 2], [2, 0], [0, 2]]), lostHole = area(box(0, 0, 2, 2), box(5, 5, 6, 6));
const zone = area(box(0, 0, 9, 9), box(4, 4, 5, 5));
console.log('overlap:', turf.booleanOverlap(bay, next), '; touch:', turf.booleanTouches(bay, next),
            turf.booleanTouches(bay, hall), turf.booleanTouches(hall, bay));
console.log('valid:', turf.booleanValid(bowTie), turf.booleanValid(lostHole), '; area', turf.area(bowTie));
console.log('contains:', turf.booleanContains(zone, area(box(3, 3, 6, 6))), turf.booleanContains(zone, area(box(6, 6, 8, 8))),
            turf.booleanContains(zone, turf.lineString([[3, 4.5], [6, 4.5]])));
JS
mapfile -t seen < <(timeout 60 node zones.mjs)
stated 'side by side; side by side, in the corner' 'overlap: true ; touch: true false true' "${seen[0]}"
stated 'bow tie, hole outside' 'valid: true true ; area 0' "${seen[1]}"
stated 'over the pit, beside it; a line across' 'contains: true true false' "${seen[2]}"
