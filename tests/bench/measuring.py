# SPDX-License-Identifier: Apache-2.0
"""What all parts of ./dev bench localization use: programs run, data unpacked, rows of the table."""
import lzma, os, pathlib, shutil, subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("DELTAMAP_DATA", ROOT.parent / "shared" / "data"))
OUT = ROOT / "build/bench-localization"
TOOL = ROOT / "build/release/bin/deltamap"


def run(*command):
    done = subprocess.run([str(c) for c in command], cwd=ROOT, text=True, capture_output=True)
    if done.returncode:
        raise SystemExit("%s\nfailed with %d:\n%s%s" % (" ".join(map(str, command)), done.returncode, done.stdout, done.stderr))
    return done.stdout


def row(figure, ours, target="", met=None, peers=""):
    return {"figure": figure, "peers": peers, "ours": ours, "target": target, "met": met}


def unpacked(name):
    """A file of the data folder without its .xz."""
    target = OUT / "data" / name
    packed = DATA / (name + ".xz")
    if not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        if packed.exists():
            with lzma.open(packed) as source, open(target, "wb") as out:
                shutil.copyfileobj(source, out)
        else:
            shutil.copy(DATA / name, target)
    return target


def median(values):
    return sorted(values)[len(values) // 2]
