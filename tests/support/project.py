# SPDX-License-Identifier: Apache-2.0
"""What the scripts that measure share: where project and real data lie, programs run, data unpacked."""
import json, lzma, os, pathlib, platform, shutil, subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("DELTAMAP_DATA", ROOT.parent / "shared" / "data"))


def run(*command):
    done = subprocess.run([str(c) for c in command], cwd=ROOT, text=True, capture_output=True)
    if done.returncode:
        raise SystemExit("%s\nfailed with %d:\n%s%s" % (" ".join(map(str, command)), done.returncode, done.stdout, done.stderr))
    return done.stdout


def version():
    """"0.1.0 (commit fc42533, GCC 12.2.0, 64 bit)": of the programs that are measured."""
    return run(ROOT / "build/release/bin/deltamap", "--version").strip().removeprefix("deltamap ")


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def provenance():
    """What stands at the head of a table: which programs were measured, and on what."""
    return "deltamap %s on %s, %d processors" % (version(), processor(), os.cpu_count())


def settings_text(settings):
    """The `settings` of a report.json or summary.json, in one line."""
    changed = ", ".join("%s: %s" % (key, json.dumps(value, ensure_ascii=False)) for key, value in settings["changed"].items())
    return "settings %s: as delivered%s" % (settings["fingerprint"], ", but " + changed if changed else "")


def settings_section(files):
    """The lines that tell with which settings the runs of a table were made, from their report.json or summary.json; runs that
    differ by their seed alone share a line."""
    groups = {}
    for file in files:
        changed = dict(json.loads(file.read_text()).get("settings", {}).get("changed", {"settings": "not told: an older program"}))
        seed = changed.pop("seed", 1)
        text = ", ".join("%s: %s" % (key, json.dumps(value, ensure_ascii=False)) for key, value in changed.items())
        groups.setdefault(text or "as delivered", []).append((file.parent.name if file.parent.name != "run" else file.parents[1].name, seed))
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
