#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""libFuzzer on everything that reads bytes from outside: ./dev fuzz [SECONDS [TARGET...]]

Each target (tests/fuzz/targets) is built by Clang with the address and undefined-behaviour sanitizers and runs for so long on a corpus
that is kept in build/fuzz/corpus and begins with tests/data. What it finds lies in build/fuzz as TARGET-crash-…; the exit code is 1."""
import concurrent.futures
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUT = ROOT / "build/fuzz"
FLAGS = ["clang++-14", "-std=c++20", "-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=undefined", "-ffp-contract=off", "-I", ROOT,
         "-isystem", "/usr/include/eigen3"]
# Compiled as one source each, as the sources of a library may be.
PARTS = {
    "core": ["core/*.cpp", "core/*/*.cpp"],
    "drivers": ["drivers/*.cpp"],
    "pioneer": ["drivers/pioneer/*.cpp"],
    "lms200": ["drivers/lms200/*.cpp"],
    "carmen": ["drivers/carmen/*.cpp"],
    "port": ["drivers/port/byte_log_reader.cpp", "drivers/port/byte_record.cpp", "drivers/port/log_audit.cpp", "drivers/port/packet_seal.cpp", "drivers/port/pcapng_*.cpp"],
    "import": ["tool/import/bag_file.cpp", "tool/import/mcap_file.cpp", "tool/import/ros_messages.cpp", "tool/import/unpacked.cpp"],
    "settings": ["daemon/settings/settings*.cpp", "daemon/settings/lost_keys.cpp", "daemon/settings/former_keys.cpp", "daemon/settings/run_contradictions.cpp",
                 "daemon/settings/memory_places.cpp", "daemon/settings/reader/*.cpp"],
    "rules": ["daemon/dashboard/access.cpp", "navigation/fan.cpp"],
    "control": ["daemon/control/request.cpp"],
    "site": ["daemon/site/*.cpp", "tool/bays/bay_import.cpp", "tool/bays/bay_table.cpp", "tool/bays/lif_stations.cpp"],
}
TARGETS = {
    "arcos": ["pioneer", "drivers", "core"],
    "lms200": ["lms200", "drivers", "core"],
    "robot_session": ["pioneer", "drivers", "core"],
    "laser_session": ["lms200", "drivers", "core"],
    "pcapng": ["port", "drivers", "core"],
    "carmen": ["carmen", "port", "pioneer", "lms200", "drivers", "core"],
    "bag": ["import", "core"],
    "mcap": ["import", "core"],
    "map": ["core"],
    "config": ["settings", "rules", "pioneer", "lms200", "drivers", "core"],
    "control": ["control", "core"],
    "site": ["site", "settings", "rules", "pioneer", "lms200", "drivers", "core"],
}
LIBRARIES = ["-lyaml-cpp", "-lpng", "-lbz2", "-llz4", "-lzstd"]
# The beginning of a corpus: patterns below the project.
SEEDS = {
    "arcos": ["tests/data/arcos*.bytes"],
    "robot_session": ["tests/data/arcos_packets.bytes"],
    "lms200": ["tests/data/lms*.bytes"],
    "laser_session": ["tests/data/lms_*.bytes"],
    "config": ["config/*.yaml"],
    "site": ["tests/data/site_*.text"],
}


def compiled(source, target, *more):
    newest = max(file.stat().st_mtime for folder in ("core", "drivers", "tool/import", "daemon/settings", "daemon/control", "daemon/site", "tool/bays", "tests/fuzz") for file in (ROOT / folder).rglob("*.?pp"))
    newest = max(newest, source.stat().st_mtime)
    if not target.exists() or target.stat().st_mtime < newest:
        done = subprocess.run([str(word) for word in [*FLAGS, *more, source, "-o", target]], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit("%s cannot be built:\n%s" % (target.name, done.stderr[-4000:]))
    return target


def build_part(name):
    files = sorted({file for pattern in PARTS[name] for file in ROOT.glob(pattern)})
    source = OUT / (name + ".cpp")
    text = "".join('#include "%s"\n' % file.relative_to(ROOT) for file in files)
    if not source.exists() or source.read_text() != text:
        source.write_text(text)
    compiled(source, OUT / (name + ".o"), "-fsanitize=fuzzer-no-link", "-c")


def build_target(name):
    parts = [OUT / (part + ".o") for part in TARGETS[name]]
    compiled(ROOT / "tests/fuzz/targets" / (name + "_target.cpp"), OUT / name, "-fsanitize=fuzzer", *parts, *LIBRARIES)


def run(name, seconds):
    corpus = OUT / "corpus" / name
    corpus.mkdir(parents=True, exist_ok=True)
    for pattern in SEEDS.get(name, []):
        for file in ROOT.glob(pattern):
            (corpus / file.name).write_bytes(file.read_bytes())
    done = subprocess.run([OUT / name, "-max_total_time=%d" % seconds, "-timeout=10", "-rss_limit_mb=3000", "-print_final_stats=1", "-artifact_prefix=%s/%s-" % (OUT, name), corpus],
                          capture_output=True, text=True, cwd=OUT)
    number = next((line.split()[-1] for line in done.stderr.splitlines() if "number_of_executed_units" in line), "?")
    print("%-14s %s, %s inputs, corpus %d" % (name, "ok" if done.returncode == 0 else "FOUND SOMETHING", number, len(list(corpus.iterdir()))), flush=True)
    if done.returncode:
        print(done.stderr[-3000:], flush=True)
    return done.returncode == 0


def main(seconds, names):
    unknown = set(names) - set(TARGETS)
    if unknown:
        raise SystemExit("no target %s: one of %s" % (", ".join(unknown), ", ".join(TARGETS)))
    OUT.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(build_part, sorted({part for name in names for part in TARGETS[name]})))
        list(pool.map(build_target, names))
        return 0 if all(pool.map(lambda name: run(name, seconds), names)) else 1


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 60, sys.argv[2:] or list(TARGETS)))
