#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: netpbm, whose format maps are kept in, halves a map by the mean of the cells: of an occupied (0) and a free one
#   (254) becomes 127, which is unknown by the thresholds of all map servers.
# Seen: 179: shades are those of a picture, which tell light by a curve, and the light is averaged. Of a map server's darkness 0.30 is left where
#   0.50 was meant; of one occupied cell in four 0.14, which is FREE by 0.196, where the mean, 0.25, is unknown. So does -reduce;
#   pamscale -linear gives the mean, and so does a filter (-filter=box).
# Matters: walls of one cell, legs of tables and fences vanish as floor from a map that is made coarser in the usual way; with a mean, or by
#   the darkest cell, they stay. Pictures look right, which is what the curve is for.
# Version: netpbm 11.01.00 (netpbm 2:11.01.00-2). Source: pgm(5): a gray value is the intensity "adjusted by the ITU-R Recommendation BT.709
#   gamma transfer function"; pamscale(1), "Linear vs Gamma-adjusted". Other readers of PGM know of no curve.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs netpbm=2:11.01.00-2
printf 'P2\n4 2\n255\n0 254 254 254\n0 254 254 0\n' > map.pgm
halved() { with_libraries "$root/usr/bin/pamscale" "$@" 0.5 map.pgm | with_libraries "$root/usr/bin/pamtopnm" -plain | tail -n 1; }
seen=$( (halved && halved -linear && halved -filter=box) | sed 's/ *$//' | paste -sd ',')
stated 'two of four and one of four occupied; plain, -linear, -filter=box' '179 220,127 191,127 190' "$seen"
