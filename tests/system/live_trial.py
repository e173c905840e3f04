# SPDX-License-Identifier: Apache-2.0
"""What the tests of a running daemon share: what they check, how they wait, and the folder that they run in."""

import os
import pathlib
import socket
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE_S = 120.0
NAME = pathlib.Path(sys.argv[0]).stem


def check(condition, what):
    if not condition:
        raise SystemExit(f"{NAME}: {what}")


def until(condition, what):
    give_up_at = time.monotonic() + PATIENCE_S
    while not condition():
        check(time.monotonic() < give_up_at, what)
        time.sleep(0.05)


def set_options(settings):
    """The words of a command line that set these keys."""
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def main(run):
    """Calls run(folder of the programs, a folder of its own, a log), and shows the end of the log where that fails."""
    bin_folder = pathlib.Path(sys.argv[1]).resolve()
    os.chdir(ROOT)
    with tempfile.TemporaryDirectory(prefix=f"deltamap-{NAME}-") as folder:
        place = pathlib.Path(folder)
        with (place / "log").open("w") as log:
            try:
                run(bin_folder, place, log)
            except BaseException:
                print((place / "log").read_text()[-4000:], file=sys.stderr)
                raise
