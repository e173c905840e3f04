# SPDX-License-Identifier: Apache-2.0
"""What the scripts that measure share: where project and real data lie, programs run, data unpacked."""
import lzma, os, pathlib, shutil, subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("DELTAMAP_DATA", ROOT.parent / "shared" / "data"))


def run(*command):
    done = subprocess.run([str(c) for c in command], cwd=ROOT, text=True, capture_output=True)
    if done.returncode:
        raise SystemExit("%s\nfailed with %d:\n%s%s" % (" ".join(map(str, command)), done.returncode, done.stdout, done.stderr))
    return done.stdout


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
