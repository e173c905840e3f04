#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Names every instruction of 32-bit programs that computes in the x87 unit, and ends with 1 where there is one. Loads and stores are no
arithmetic; nor is the addition of 2^64 by which an unsigned 64-bit number becomes a double: 64 bits of mantissa hold it whole, and the
store rounds once, as amd64 does. It is known by its constant, or by what stands right before it: fildll, jns.
usage: x87.py PROGRAM..."""
import re, struct, subprocess, sys

COMPUTES = re.compile(r"\s*([0-9a-f]+):\s+(fi?(?:add|sub|mul|div|sqrt|prem|scale|patan|ptan|sin|cos|yl2x|2xm1)\w*)\s*(.*)")
TWO_TO_64 = struct.pack("<f", 2.0 ** 64)


def told(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Constants:
    """What position-independent code reads: an offset to the global offset table, whatever register holds that."""

    def __init__(self, program):
        with open(program, "rb") as file:
            self.bytes = file.read()
        self.sections = [[int(n, 16) for n in found] for found in re.findall(r"\sPROGBITS\s+([0-9a-f]+) ([0-9a-f]+) ([0-9a-f]+)", told("readelf", "--wide", "--sections", program))]
        base = re.search(r"([0-9a-f]+) \w _GLOBAL_OFFSET_TABLE_", told("nm", program))
        self.base = int(base.group(1), 16) if base else 0

    def four_bytes(self, operand):
        offset = re.fullmatch(r"(-?0x[0-9a-f]+)\(%e\w\w\)", operand.strip())
        if not offset:
            return b""
        address = self.base + int(offset.group(1), 16)
        place = next((at + address - begin for begin, at, size in self.sections if begin <= address < begin + size), 0)
        return self.bytes[place:place + 4]


def computing(program):
    constants, before = Constants(program), ["", ""]
    for line in told("objdump", "-d", "--no-show-raw-insn", program).splitlines():
        found = COMPUTES.match(line)
        is_conversion = found and found.group(2) == "fadds" and (constants.four_bytes(found.group(3)) == TWO_TO_64 or before == ["fildll", "jns"])
        if found and not is_conversion:
            yield found
        before = [before[1], (line.split("\t")[-1].split() or [""])[0]]


def main():
    wrong = [(program, one) for program in sys.argv[1:] for one in computing(program)]
    for program, one in wrong[:20]:
        print("%s: at %s: %s %s computes in the x87 unit: results differ from amd64's" % (program, *one.groups()), file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
