#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the newest map for a planner: from the daemon's page, or from the file that `map.newest` names.
usage: read_map.py http://127.0.0.1:8484 | /var/lib/deltamap/map.yaml  [X,Y]    prints a summary, and what is at X,Y (m)"""
import math
import os
import sys
import time
import urllib.request

FREE, OCCUPIED, UNKNOWN = range(3)


def fields_of(yaml):
    """The flat part of YAML that a map needs; one `key: value` a line."""
    pairs = (line.split("#")[0].partition(":") for line in yaml.splitlines())
    return {key.strip(): value.strip().strip("\"'") for key, colon, value in pairs if colon}


def pixels_of(pgm):
    """Width, height and the pixels of a binary PGM, row by row from the top."""
    words, at = [], 0
    while len(words) < 4:
        end = at
        while not pgm[end:end + 1].isspace():
            end += 1
        if pgm[at:at + 1] == b"#":
            end = pgm.index(b"\n", at)
        elif end > at:
            words.append(pgm[at:end])
        at = end + 1
    if words[0] != b"P5" or int(words[3]) > 255:
        raise ValueError("not a binary PGM of one byte a pixel")
    width, height = int(words[1]), int(words[2])
    if len(pgm) - at < width * height:
        raise ValueError("the PGM is cut")
    return width, height, pgm[at:at + width * height]


class Map:
    """Cells in the frame `map`: the lower left corner of cell (0, 0) lies at `origin`."""

    def __init__(self, yaml, pgm):
        fields = fields_of(yaml)
        self.resolution_m = float(fields["resolution"])
        self.origin = [float(number) for number in fields["origin"].strip("[]").split(",")][:2]
        self.width, self.height, pixels = pixels_of(pgm)
        free, occupied, negate = float(fields["free_thresh"]), float(fields["occupied_thresh"]), int(fields["negate"])
        share = [(pixel if negate else 255 - pixel) / 255 for pixel in range(256)]
        state = bytes(OCCUPIED if p > occupied else FREE if p < free else UNKNOWN for p in share)
        self.cells = pixels.translate(state)

    def at(self, x_m, y_m):
        """The state of the cell that holds this point; outside the map all is unknown."""
        column, row = (math.floor((p - o) / self.resolution_m) for p, o in zip((x_m, y_m), self.origin))
        if not (0 <= column < self.width and 0 <= row < self.height):
            return UNKNOWN
        return self.cells[(self.height - 1 - row) * self.width + column]


def from_page(address):
    """YAML and PGM are two answers: read again where the map has changed between them."""
    for _ in range(10):
        answers = []
        for name in ("map.yaml", "map.pgm"):
            with urllib.request.urlopen(f"{address}/api/{name}", timeout=10) as answer:
                answers.append((answer.headers["X-Deltamap-Revision"], answer.read()))
        (revision, yaml), (revision_of_pgm, pgm) = answers
        if revision == revision_of_pgm:
            return int(revision), Map(yaml.decode(), pgm)
    raise RuntimeError("the map changes faster than it can be read")


def from_file(path):
    """Each file is replaced in one step; for a moment the YAML may be absent, or older than the PGM: read again."""
    for _ in range(10):
        try:
            with open(path, encoding="utf-8") as file:
                yaml = file.read()
            with open(os.path.join(os.path.dirname(path), fields_of(yaml)["image"]), "rb") as file:
                pgm = file.read()
            with open(path, encoding="utf-8") as file:
                if file.read() == yaml:
                    return Map(yaml, pgm)
        except FileNotFoundError:
            pass
        time.sleep(0.2)
    raise RuntimeError(f"{path}: no whole map")


def main():
    place = sys.argv[1]
    if place.startswith("http"):
        revision, grid = from_page(place.rstrip("/"))
        print(f"revision {revision}")
    else:
        grid = from_file(place)
    print(f"{grid.width} x {grid.height} cells of {grid.resolution_m} m, lower left corner at {grid.origin[0]}, {grid.origin[1]}")
    names = ("free", "occupied", "unknown")
    print(", ".join(f"{grid.cells.count(state)} {name}" for state, name in enumerate(names)))
    if len(sys.argv) > 2:
        print(names[grid.at(*map(float, sys.argv[2].split(",")))])


if __name__ == "__main__":
    main()
