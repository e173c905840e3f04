#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: from a frame that moves with the continents' plates to one that lies still on a plate PROJ wants the year, or says
#   that it has none; and where WGS 84 is named in place of such a frame, something is converted, too.
# Seen: without a year each conversion takes the one that its own parameters were told for. From ITRF2014 to UTM zone 32 on
#   ETRS89 that is 2010: 0.52 m in place of the 0.94 m of 2026.9. To ETRF2005 it is 1989: 0.08 m in place of 0.95 m.
#   Nothing is said, and the exit code is 0. Named as WGS 84 (EPSG:4326) the same point moves by nothing at all.
# Matters: a satellite receiver with corrections tells ITRF or ETRS89 by its corrections' service, the surveyor's site plan is
#   ETRS89. Gates and bays then lie half a metre to a metre off, the same everywhere, which looks like a calibrated map.
# Version: PROJ 9.1.1 (9.1.1-1+b1). Source: cs2cs(1): the fourth column is a time, if given; PROJ's manual,
#   Helmert transform: t_epoch is the "central epoch", used with a time; EPSG:4326 is an ensemble of 2 m.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs proj-bin=9.1.1-1+b1 proj-data=9.1.1-1 libproj25=9.1.1-1+b1
export LD_LIBRARY_PATH=$libraries PROJ_DATA=$root/usr/share/proj PATH=$root/usr/bin:$PATH
# moved FROM TO [YEAR]: metres in UTM from where the same degrees lie in TO.
moved() {
  there=$(echo "50 9 0 ${3-}" | cs2cs -f %.9f "$1" "$2" 2>> said | cut -d' ' -f1 | tr '\t' ' ')
  { echo 50 9; echo "$there"; } | cs2cs -f %.4f EPSG:4258 EPSG:25832 2>> said |
    awk '{e = $1 - e; n = $2 - n} END {printf "%.2f", sqrt(e * e + n * n)}'
}
stated 'to ETRS89 without a year, in 2010 and 2026.9, m' '0.52 0.52 0.94' \
  "$(moved EPSG:9000 EPSG:4258) $(moved EPSG:9000 EPSG:4258 2010) $(moved EPSG:9000 EPSG:4258 2026.9)"
stated 'to ETRF2005 without a year, in 1989 and 2026.9, m' '0.08 0.08 0.95' \
  "$(moved EPSG:9000 EPSG:9068) $(moved EPSG:9000 EPSG:9068 1989) $(moved EPSG:9000 EPSG:9068 2026.9)"
stated 'from WGS 84 without a year and in 2026.9, m' '0.00 0.00' "$(moved EPSG:4326 EPSG:4258) $(moved EPSG:4326 EPSG:4258 2026.9)"
stated 'lines said' 0 "$(wc -l < said)"
