# SPDX-License-Identifier: Apache-2.0
"""What the scripts that measure share: where project and real data lie, programs run, data unpacked."""
import argparse, datetime, json, lzma, os, pathlib, platform, shutil, subprocess, sys, time

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("DELTAMAP_DATA", ROOT.parent / "shared" / "data"))


def run(*command):
    done = subprocess.run([str(c) for c in command], cwd=ROOT, text=True, capture_output=True)
    if done.returncode:
        raise SystemExit("%s\nfailed with %d:\n%s%s" % (" ".join(map(str, command)), done.returncode, done.stdout, done.stderr))
    return done.stdout


def version(build=ROOT / "build/release"):
    """"0.1.0 (commit fc42533, GCC 12.2.0, 64 bit)": of the programs that are measured."""
    return run(build / "bin/deltamap", "--version").strip().removeprefix("deltamap ")


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def provenance(build=ROOT / "build/release"):
    """What stands at the head of a table: which programs were measured, and on what."""
    return "deltamap %s on %s, %d processors" % (version(build), processor(), os.cpu_count())


def write_section(file, title, lines):
    """Puts a section into a document that several programs write, in place of the section of the same title; a new one goes to the end."""
    text = file.read_text() if file.exists() else "# %s\n" % file.stem.capitalize()
    head, *sections = text.rstrip("\n").split("\n## ")
    made = "\n".join([title, ""] + lines).rstrip("\n") + "\n"
    titles = [section.split("\n", 1)[0] for section in sections]
    if title in titles:
        sections[titles.index(title)] = made
    else:
        sections.append(made)
    file.write_text("\n## ".join([head.rstrip("\n") + "\n"] + [section.rstrip("\n") + "\n" for section in sections]))


PLACES = {"robot.port", "laser.port", "map.file", "map.store", "map.newest", "control.socket", "poses.socket",
          "recording.file", "incidents.folder", "dashboard.token_file"}


def measure_a_section(description, command, title, measure):
    """The whole of a program that measures one section of a results page. `measure(seed, quick)` gives what comes below the
    provenance, line by line, and whether everything asked for is met: that is the exit code. `command` is what an engineer types."""
    options = argparse.ArgumentParser(description=description)
    options.add_argument("--quick", action="store_true")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--out", type=pathlib.Path)
    wanted = options.parse_args()
    began = time.monotonic()
    lines, is_met = measure(wanted.seed, wanted.quick)
    command += " --quick" if wanted.quick else ""
    lines = ["Written by `%s` (%s, %s, %.0f s)." % (command, provenance(), datetime.date.today(), time.monotonic() - began), ""] + lines
    if wanted.out:
        write_section(wanted.out, title, lines)
    else:
        print("\n".join(lines))
    sys.exit(0 if is_met else 1)


def told(settings):
    """The changed settings of a report.json or summary.json without seed and places, in one line."""
    changed = {key: value for key, value in settings["changed"].items() if key not in PLACES | {"seed"}}
    return ", ".join("%s: %s" % (key, json.dumps(value, ensure_ascii=False)) for key, value in changed.items()) or "as delivered"


def settings_section(files):
    """The lines that tell with which settings the runs of a table were made, from their report.json or summary.json; runs that
    differ by their seed or by where their files are share a line."""
    groups = {}
    for file in files:
        settings = json.loads(file.read_text()).get("settings", {"changed": {"settings": "not told by an older program"}})
        name = file.parents[1 if file.parent.name == "run" else 0].name
        groups.setdefault(told(settings), []).append((name, settings["changed"].get("seed", 1)))
    lines = ["## Settings", "", "What is not listed is as delivered (`config/default.yaml` of that commit).", ""]
    return lines + ["- %s (seeds %s): %s" % (", ".join(name for name, _ in runs), ", ".join(str(seed) for seed in sorted({seed for _, seed in runs})), text)
                    for text, runs in groups.items()]


def unpacked(name, folder):
    """A file of the data folder without its .xz, below the folder."""
    target = folder / name
    if not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        packed = DATA / (name + ".xz")
        if packed.exists():
            with lzma.open(packed) as source, open(target, "wb") as out:
                shutil.copyfileobj(source, out)
        else:
            shutil.copy(DATA / name, target)
    return target
