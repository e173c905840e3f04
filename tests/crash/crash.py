#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills what keeps the maps at random moments, cuts its power, lets its disk fail, flips bytes of its store; and kills the real
daemon behind a simulated robot. After each: every revision that was called safe is there, nothing is torn, and it starts by itself.
usage: crash.py [--quick] [--seed N] [--only PART] [--build FOLDER] [--out FILE]"""
import argparse, collections, concurrent.futures, datetime, json, os, pathlib, random, re, subprocess, sys, tempfile, time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import project

REVISIONS = 5000    # of a run that is ended from outside
FAILING = 60        # of a run on a failing disk
A_FOLDER = 25       # trials in one folder: what one has left is what the next begins on
RATES = (0.005, 0.02, 0.1, 0.4, 1.0)  # calls that fail; 1: a disk that is full from the start
FAULTS = ("lost", "torn", "not started", "set aside")
A_ROBOT = 25        # trials of one robot and its maps
ROBOTS = 10         # at once: they mostly wait
SIZES = {"kills": (1000, 75), "power": (1000, 75), "failing": (1000, 50), "flips": (1000, 40), "daemon": (1000, 2)}  # whole, quick
PAGE = 4096         # of a store, in bytes: the first says what all others are


class Trials:
    """What came of the trials of one part."""

    def __init__(self, name, meant, seed):
        self.name, self.meant, self.seed = name, meant, seed
        self.runs, self.failures, self.revisions = 0, 0, 0
        self.faults, self.told = collections.Counter(), []

    def fault(self, kind, where, why):
        self.faults[kind] += 1
        self.told.append("%s: %s: %s: %s" % (self.name, kind, where, why))

    def add(self, other):
        self.runs += other.runs
        self.failures += other.failures
        self.revisions += other.revisions
        self.faults.update(other.faults)
        self.told += other.told


class Keeper:
    """One folder of maps, and what was called safe in it."""

    def __init__(self, build, folder, trials, seed):
        self.writer, self.disk = build / "tests/map_writer", build / "tests/libfailing_disk.so"
        self.folder, self.trials, self.seed, self.random = folder, trials, seed, random.Random(seed)
        self.safe = {"store": 0, "newest": 0}
        self.revisions = None  # in the store, where their number is known
        (folder / "maps").mkdir()

    def run(self, job, count=None, disk=None, kill_after_s=None):
        """Lines of what it told; None where it was not ended by itself."""
        command = [str(self.writer), job, str(self.folder / "maps")] + ([str(count)] if count else [])
        settings = dict(os.environ)
        if disk:
            settings.update(LD_PRELOAD=str(self.disk), DELTAMAP_DISK="%s %d %g %d %s" % ((self.folder / "maps",) + disk + (self.folder / "failures",)))
        with open(self.folder / "told", "w") as told:
            process = subprocess.Popen(command, stdout=told, stderr=subprocess.STDOUT, env=settings)
            try:
                process.wait(kill_after_s if kill_after_s is not None else 120)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        lines = (self.folder / "told").read_text(errors="replace").splitlines()
        self.listen(job, lines)
        return process.returncode, lines

    def listen(self, job, lines):
        for line in lines:
            words = line.split(" ")
            if words[0] == "safe" and len(words) == 3 and words[2].isdigit():
                self.safe[words[1]] = max(self.safe[words[1]], int(words[2]))
                self.trials.revisions += words[1] == "store"
            if words[0] == "began" and int(words[1]) < self.safe["store"]:
                self.trials.fault("lost", self.where(), "%d was safe, begins with %s" % (self.safe["store"], words[1]))
            if "set aside" in line and self.revisions is None:
                self.trials.fault("set aside", self.where(), line)

    def where(self):
        return "seed %d, trial %d" % (self.seed, self.trials.runs)

    def verify(self):
        code, lines = self.run("verify")
        found = {line.split(" ")[0]: int(line.split(" ")[1]) for line in lines if re.match(r"(store|newest|out) \d+", line)}
        if code != 0:
            kind = "torn" if any("torn" in line or "old" in line for line in lines) else "not started"
            return self.trials.fault(kind, self.where(), "; ".join(lines[-2:]))
        for name, serial in self.safe.items():
            if serial > 0 and found.get(name, -1) < serial:
                self.trials.fault("lost", self.where(), "%s was safe up to %d, holds %s" % (name, serial, found.get(name)))
        self.safe["store"] = max(self.safe["store"], found.get("store", 0))
        kept = [int(line.split(" ")[3]) for line in lines if re.match(r"store \d+ revisions \d+", line)][0]
        if self.revisions is not None and kept != self.revisions:
            self.trials.fault("lost", self.where(), "%d of %d revisions are there" % (kept, self.revisions))
        return kept

    def went_on(self, code, lines):
        """A start without a person, whatever was left."""
        if code == 1 or any(line.startswith("error") for line in lines):
            self.trials.fault("not started", self.where(), "; ".join(lines[-2:]))

    def kill(self):
        self.went_on(*self.run("write", REVISIONS, kill_after_s=self.random.uniform(0.0, 0.25)))

    def cut_power(self):
        code, lines = self.run("write", REVISIONS, disk=(self.random.randrange(1 << 30), 0.0, self.random.randint(1, 5000)))
        self.went_on(code, lines)
        self.trials.failures += self.count_failures()

    def lie(self):
        """Power cuts on a disk whose syncs do nothing: what these trials are worth."""
        self.run("write", REVISIONS, disk=(self.random.randrange(1 << 30), -1, self.random.randint(500, 5000)))

    def fail(self):
        """To its end, or killed: then its log is left for the next one."""
        disk = (self.random.randrange(1 << 30), self.random.choice(RATES), 0)
        self.went_on(*self.run("write", FAILING, disk=disk, kill_after_s=self.random.choice((None, self.random.uniform(0.0, 0.2)))))
        self.trials.failures += self.count_failures()

    def flip(self):
        """One byte of the store; and the start that finds it out is left alone, killed, or its power is cut."""
        self.revisions = None
        self.went_on(*self.run("write", self.random.randint(1, 60)))
        self.revisions = self.verify()
        store = self.folder / "maps/store.sqlite"
        damaged = bytearray(store.read_bytes())
        place = self.random.randrange(self.random.choice((PAGE, len(damaged))))
        damaged[place] ^= self.random.randint(1, 255)
        store.write_bytes(damaged)
        disturbance = self.random.choice(("none", "kill", "power"))
        if disturbance == "kill":
            self.run("verify", kill_after_s=self.random.uniform(0.0, 0.05))
        if disturbance == "power":
            self.run("verify", disk=(self.random.randrange(1 << 30), 0.0, self.random.randint(1, 300)))
        self.verify()
        for aside in store.parent.glob("store.sqlite.set-aside-*"):
            if not aside.name.endswith(("-wal", "-shm")) and aside.read_bytes() != damaged:
                self.trials.fault("set aside", self.where(), "%s is not what was damaged at %d" % (aside.name, place))
            self.trials.failures += not aside.name.endswith(("-wal", "-shm"))
            aside.unlink()

    def count_failures(self):
        file = self.folder / "failures"
        count = len(file.read_text().splitlines()) if file.exists() else 0
        file.unlink(missing_ok=True)
        return count

    def trial(self, act):
        self.trials.runs += 1
        act(self)
        self.verify()


def folder_of_trials(build, name, meant, act, seed, count):
    trials = Trials(name, meant, seed)
    with tempfile.TemporaryDirectory() as folder:
        keeper = Keeper(build, pathlib.Path(folder), trials, seed)
        for _ in range(count):
            keeper.trial(act)
        keeper.revisions = None  # it goes on: more come, old ones go
        keeper.went_on(*keeper.run("write", 3))
        keeper.verify()
    return trials


def in_folders(build, name, meant, act, seed, count):
    """Two at a time; each folder has a seed of its own."""
    trials = Trials(name, meant, "%d to %d" % (seed, seed + (count - 1) // A_FOLDER))
    sizes = [min(A_FOLDER, count - begin) for begin in range(0, count, A_FOLDER)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for done in pool.map(lambda job: folder_of_trials(build, name, meant, act, seed + job[0], job[1]), enumerate(sizes)):
            trials.add(done)
    return trials


class Robot:
    """The real daemon behind a simulated robot that drives about among boxes that come and go."""

    def __init__(self, build, folder, trials, seed):
        self.tool, self.program, self.out, self.trials = build / "bin/deltamap", build / "bin/deltamapd", folder, trials
        self.random, self.safe, self.daemon = random.Random(seed), -1, None
        world = ["--world", str(ROOT / "config/scenarios/room.yaml")]
        subprocess.run([self.tool, "sim", *world, "--write-map", folder / "m0.yaml"], check=True)
        (folder / "sim").mkdir()
        self.sim = subprocess.Popen([self.tool, "sim", *world, "--links", folder / "sim", "--seed", str(seed), "--change-every", "4"],
                                    stderr=subprocess.DEVNULL)
        while not (folder / "sim/laser").exists():
            time.sleep(0.05)

    def start(self):
        settings = {"robot.port": self.out / "sim/robot", "laser.port": self.out / "sim/laser", "map.file": self.out / "m0.yaml",
                    "map.store": self.out / "store.sqlite", "map.newest": self.out / "map.yaml", "map.retention.revisions": 10,
                    "recording.file": self.out / "bytes.pcapng", "control.socket": self.out / "ctl.sock", "mapping.persistence_s": 2,
                    "localization.memory.pose_period_s": 0.1,
                    "localization.initial_pose": "null" if self.trials.runs else "[1,2,0]"}
        options = [part for key, value in settings.items() for part in ("--set", "%s=%s" % (key, value))]
        self.log = open(self.out / "daemon.log", "w")
        self.daemon = subprocess.Popen([self.program, "--config", ROOT / "config/simulation.yaml", *options], stderr=self.log, cwd=ROOT)

    def lines(self):
        return (self.out / "daemon.log").read_text(errors="replace").splitlines()

    def is_up(self, within_s):
        """It has connected to its robot, and a person's word to drive is kept or given."""
        until = time.monotonic() + within_s
        while time.monotonic() < until:
            if self.daemon.poll() is not None:
                return False
            if subprocess.run([self.tool, "ctl", "--socket", self.out / "ctl.sock", "drive", "wander"], capture_output=True).returncode == 0:
                return True
            time.sleep(0.05)
        return False

    def trial(self):
        self.trials.runs += 1
        self.start()
        if not self.is_up(30):
            self.trials.fault("not started", self.where(), "; ".join(self.lines()[-3:]))
        time.sleep(self.random.uniform(0.0, 30.0))
        self.daemon.kill()
        self.daemon.wait()
        self.judge()

    def where(self):
        return "seed %d, trial %d" % (self.trials.seed, self.trials.runs)

    def judge(self):
        """A revision is safe when the next one is told of: the map thread does one after the other."""
        text = "\n".join(self.lines())
        made = [int(number) for number in re.findall(r"map changed: revision=(\d+)", text)]
        begun = [int(number) for number in re.findall(r"goes on with revision=(\d+)", text)]
        self.trials.revisions += len(made)
        where = self.where()
        if "set aside" in text:
            self.trials.fault("set aside", where, text[-300:])
        if begun and begun[0] < self.safe:
            self.trials.fault("lost", where, "revision %d was safe, goes on with %d" % (self.safe, begun[0]))
        self.safe = max([self.safe] + begun + [number - 1 for number in made])
        self.compare_maps(where)

    def compare_maps(self, where):
        listed = subprocess.run([self.tool, "map", "history", self.out / "store.sqlite", "list", "--json"], capture_output=True, text=True)
        numbers = [row["number"] for row in map(json.loads, listed.stdout.splitlines()) if not row["refused"]]
        if listed.returncode != 0 or not numbers or numbers[-1] < self.safe:
            return self.trials.fault("lost", where, "safe %d, listed %s %s" % (self.safe, numbers[-1:], listed.stderr))
        for number in reversed(numbers[-2:]):
            done = subprocess.run([self.tool, "map", "history", self.out / "store.sqlite", "export", str(number), self.out / "export.yaml"], capture_output=True)
            if done.returncode == 0 and (self.out / "export.pgm").read_bytes() == (self.out / "map.pgm").read_bytes():
                return
        self.trials.fault("torn", where, "map.pgm is neither the newest revision nor the one before")

    def end(self):
        for process in (self.daemon, self.sim):
            if process and process.poll() is None:
                process.kill()
                process.wait()


def one_robot(build, name, meant, seed, count):
    trials = Trials(name, meant, seed)
    with tempfile.TemporaryDirectory() as folder:
        robot = Robot(build, pathlib.Path(folder), trials, seed)
        try:
            for _ in range(count):
                robot.trial()
        finally:
            robot.end()
    return trials


def daemon_trials(build, seed, count):
    trials = Trials("daemon", "the real daemon is killed, robot and laser simulated", "%d to %d" % (seed, seed + (count - 1) // A_ROBOT))
    sizes = [min(A_ROBOT, count - begin) for begin in range(0, count, A_ROBOT)]
    with concurrent.futures.ThreadPoolExecutor(ROBOTS) as pool:
        for done in pool.map(lambda job: one_robot(build, trials.name, trials.meant, seed + job[0], job[1]), enumerate(sizes)):
            trials.add(done)
    return trials


def parts(build, seed, is_quick):
    size = {name: sizes[is_quick] for name, sizes in SIZES.items()}
    yield "kills", lambda: in_folders(build, "kills", "killed with SIGKILL at a random moment", Keeper.kill, seed, size["kills"])
    yield "power", lambda: in_folders(build, "power", "power cut before a random call, unsynced sectors and renames lost at random", Keeper.cut_power, 1000 + seed, size["power"])
    yield "failing", lambda: in_folders(build, "failing", "open, write, sync, truncate, rename fail (ENOSPC, EIO) or write short", Keeper.fail, 2000 + seed, size["failing"])
    yield "flips", lambda: in_folders(build, "flips", "one byte of the store flipped; the start that finds it left alone, killed, or its power cut", Keeper.flip, 4000 + seed, size["flips"])
    yield "daemon", lambda: daemon_trials(build, 3000 + seed, size["daemon"])


def notices_a_lying_disk(build, seed):
    return bool(in_folders(build, "lying", "", Keeper.lie, seed, 20).told)


def table(done, is_quick):
    lines = ["| what | trials | calls that failed | revisions called safe | " + " | ".join(FAULTS) + " | seeds |", "|---|---|---|---|" + "---|" * (len(FAULTS) + 1)]
    for trials in done:
        lines.append("| %s | %d | %s | %d | %s | %s |" % (trials.meant, trials.runs, trials.failures if trials.name == "failing" else "–", trials.revisions,
                                                    " | ".join(str(trials.faults[kind]) for kind in FAULTS), trials.seed))
    return lines


TITLE = "Crashes and failing disks"


def section(done, build, is_quick, seconds):
    head = ["Written by `./dev bench crash%s` (%s, %s, %.0f s)." % (" --quick" if is_quick else "", project.provenance(build), datetime.date.today(), seconds), "",
            "The first four rows run what the daemon's map thread runs (store with retention, `map.newest`, the files of `--out`, kept pose) without a pause, each",
            "trial on what the one before has left. After each trial every revision in the store is restored and held against its content, and so are `map.yaml` and `map.pgm`.",
            "The last row runs the daemon itself, %d at once, each behind a robot of its own, and kills it up to 30 s after its start, %d times on the same maps." % (ROBOTS, A_ROBOT),
            "*Lost*: something that was reported as written is not there. *Torn*: a map or revision is neither the old nor the new one. *Not started*: a",
            "start needs a person. *Set aside*: the store was called damaged and is not; where a byte was flipped, it was not kept aside whole.", ""]
    return head + table(done, is_quick)


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--quick", action="store_true")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--only", choices=SIZES)
    options.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    options.add_argument("--out", type=pathlib.Path)
    wanted = options.parse_args()
    began, done = time.monotonic(), []
    chosen = [(name, run) for name, run in parts(wanted.build.resolve(), wanted.seed, wanted.quick) if wanted.only in (None, name)]
    with concurrent.futures.ThreadPoolExecutor(1) as aside, concurrent.futures.ThreadPoolExecutor(1) as pool:
        # The daemons mostly wait for their moment: beside the others.
        results = [(name, (aside if name == "daemon" else pool).submit(run)) for name, run in chosen]
        for name, result in results:
            done.append(result.result())
            print("%s: %d trials, %d failures, %s" % (name, done[-1].runs, done[-1].failures, dict(done[-1].faults) or "nothing lost"), flush=True)
    lines = section(done, wanted.build.resolve(), wanted.quick, time.monotonic() - began)
    (project.write_section(wanted.out, TITLE, lines) if wanted.out else print("\n".join(lines)))
    told = [line for trials in done for line in trials.told]
    if wanted.only in (None, "power") and not notices_a_lying_disk(wanted.build.resolve(), wanted.seed):
        told.append("power: a disk that syncs nothing loses nothing: these trials show nothing")
    print("\n".join(told[:20]), file=sys.stderr)
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main())
