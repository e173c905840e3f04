#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real daemon, simulated robot, and a crowd at its live page and its control socket: idle clients, slow ones (a byte a second) and
hostile ones (garbage, half requests, WebSockets and maps that nobody reads, commands without the token). Meanwhile STOP by the page,
with the token and without, and `deltamap ctl drive off` must all be done; prints how soon. Then the same where the daemon may hardly
open anything, and where nobody reads its log. usage: siege.py FOLDER-OF-PROGRAMS [CLIENTS] [SECONDS] [P99_S]: with P99_S a later p99 is a fault, too."""
import fcntl, heapq, http.client, multiprocessing, os, pathlib, random, resource, selectors, socket, struct, subprocess, sys, tempfile, time

from live_trial import ROOT, check, free_port, set_options, until

TOKEN = "of-the-siege-0123456789"
STOP = '{"command":"drive","mode":"off"}'
STOP_PATIENCE_S = 20.0
AGAIN_AFTER_S = 0.25  # a client that was sent away
FEW_DESCRIPTORS = 6   # beyond those that the daemon has open while nobody is there

HOST = b" HTTP/1.1\r\nHost: 127.0.0.1\r\n"
UPGRADE = HOST + b"Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
POST = b"POST /api/command" + HOST + b"Content-Type: application/json\r\nContent-Length: 20\r\n\r\n"
SLOW = {"page": b"GET /api/status" + HOST + b"X-Slow: " + b"x" * 1000, "control": b'{"command":"status",' + b" " * 1000}
HOSTILE = {
    "page": [b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"A" * 20000, b"GET / HT", POST + b'{"command":',
             POST + b'{"command":"status"}', b"GET /live" + UPGRADE, b"GET /drive" + UPGRADE, b"GET /api/map.png" + HOST + b"\r\n",
             (b"GET /api/map.pgm" + HOST + b"\r\n") * 20, (b"GET /api/status" + HOST + b"\r\n") * 50],
    "control": [b"{", b"garbage\n" * 50, b'{"command":"status"}\n' * 100, b'{"command":"save"}\n' * 3, b"x" * 5000]}


class Crowd:
    """So many clients, in one process: each comes back soon after it was sent away, one of six to the control socket."""

    def __init__(self, count, port, control, seed):
        self.random, self.port, self.control = random.Random(seed), port, str(control)
        self.selector, self.turns, self.order = selectors.DefaultSelector(), [], 0
        for number in range(count):
            self.later(self.random.uniform(0.0, 1.0), self.come, number)

    def later(self, pause_s, act, *arguments):
        self.order += 1
        heapq.heappush(self.turns, (time.monotonic() + pause_s, self.order, act, arguments))

    def come(self, number):
        to = "control" if number % 6 == 5 else "page"
        client = socket.socket(socket.AF_UNIX if to == "control" else socket.AF_INET)
        client.setblocking(False)
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # no port stays behind
        error = client.connect_ex(self.control if to == "control" else ("127.0.0.1", self.port))
        if error and (to == "control" or error != 115):  # EINPROGRESS
            client.close()
            return self.later(AGAIN_AFTER_S, self.come, number)
        kind = number // 6 % 3
        if kind == 2:
            self.later(0.0, self.send, client, self.random.choice(HOSTILE[to]))
            return self.later(self.random.uniform(0.5, 5.0), self.go, number, client)
        self.selector.register(client, selectors.EVENT_READ, number)
        if kind == 1:
            self.later(0.0, self.trickle, client, SLOW[to], 0)

    def trickle(self, client, text, at):
        if client.fileno() >= 0:
            self.send(client, text[at:at + 1])
            self.later(1.0, self.trickle, client, text, (at + 1) % len(text))

    def send(self, client, data):
        try:
            if client.fileno() >= 0:
                client.send(data)
        except BlockingIOError:  # it still connects
            self.later(0.05, self.send, client, data)
        except OSError:
            pass  # it was sent away, and will see it

    def go(self, number, client):
        if client in self.selector.get_map():
            self.selector.unregister(client)
        client.close()
        self.later(AGAIN_AFTER_S, self.come, number)

    def throng(self):
        while True:
            while self.turns[0][0] <= time.monotonic():
                _, _, act, arguments = heapq.heappop(self.turns)
                act(*arguments)
            for key, _ in self.selector.select(max(0.0, self.turns[0][0] - time.monotonic())):
                try:
                    data = key.fileobj.recv(4096)
                except OSError:
                    data = b""
                if not data:
                    self.go(key.data, key.fileobj)


def throng(*arguments):
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(most, 16384), most))
    Crowd(*arguments).throng()


class Castle:
    def __init__(self, bin, out, descriptors, log_is_read):
        self.bin, self.out, self.control = pathlib.Path(bin).resolve(), pathlib.Path(out), pathlib.Path(out) / "ctl.sock"
        world = ["--world", str(ROOT / "config/scenarios/room.yaml")]
        subprocess.run([self.bin / "deltamap", "sim", *world, "--write-map", self.out / "m0.yaml"], check=True)
        (self.out / "token").write_text(TOKEN + "\n")
        (self.out / "token").chmod(0o600)
        self.sim = subprocess.Popen([self.bin / "deltamap", "sim", *world, "--links", self.out, "--seed", "1"], stderr=open(self.out / "sim.log", "w"))
        until((self.out / "laser").exists, "no simulator")
        self.port = free_port()
        settings = {"localization.initial_pose": "[1,2,0]", "robot.port": self.out / "robot", "laser.port": self.out / "laser", "map.file": self.out / "m0.yaml",
                    "map.store": self.out / "store.sqlite", "recording.file": self.out / "bytes.pcapng", "control.socket": self.control,
                    "dashboard.port": self.port, "dashboard.token_file": self.out / "token"}
        self.log, log = os.pipe() if not log_is_read else (None, os.open(self.out / "daemon.log", os.O_WRONLY | os.O_CREAT))
        self.daemon = subprocess.Popen([self.bin / "deltamapd", "--config", ROOT / "config/simulation.yaml", *set_options(settings)], cwd=ROOT, stderr=log)
        if not log_is_read:
            fcntl.fcntl(log, fcntl.F_SETPIPE_SZ, 4096)
        os.close(log)
        until(self.both_speak, "robot and laser do not speak")
        if descriptors is not None:
            has = [int(number) for number in os.listdir("/proc/%d/fd" % self.daemon.pid)]
            limit = max(has) + 1 + descriptors
            resource.prlimit(self.daemon.pid, resource.RLIMIT_NOFILE, (limit, limit))
        for _ in range(0 if log_is_read else 100):
            self.ctl("log-level", "info")  # a line or two each: then the pipe is full

    def both_speak(self):
        check(self.daemon.poll() is None, "the daemon has ended")
        status = self.ctl("status", "--json")
        return b"localized" in status and b'"robot":"up"' in status

    def ctl(self, *words):
        return subprocess.run([self.bin / "deltamap", "ctl", "--socket", self.control, *words], capture_output=True).stdout

    def is_stopped_by_ctl(self):
        done = subprocess.run([self.bin / "deltamap", "ctl", "--socket", self.control, "drive", "off"], capture_output=True, text=True)
        return done.returncode == 0, (done.stdout + done.stderr).strip()

    def is_stopped_by_page(self, headers):
        page = http.client.HTTPConnection("127.0.0.1", self.port, timeout=STOP_PATIENCE_S)
        try:
            page.request("POST", "/api/command", STOP, {"Content-Type": "application/json", **headers})
            answer = page.getresponse()
            return answer.status == 200, "%d %s" % (answer.status, answer.read().decode().strip())
        except (OSError, http.client.HTTPException) as error:
            return False, repr(error)
        finally:
            page.close()

    def end(self):
        for process in (self.daemon, self.sim):
            process.kill()
            process.wait()


def besieged(bin, clients, seconds, p99_s, faults, descriptors=None, log_is_read=True):
    few = "" if descriptors is None else ", %d descriptors free" % descriptors
    what = "%d clients%s%s" % (clients, few, "" if log_is_read else ", a log that nobody reads")
    with tempfile.TemporaryDirectory() as out:
        castle = Castle(bin, out, descriptors, log_is_read)
        crowds = [multiprocessing.Process(target=throng, args=(clients, castle.port, castle.control, 1), daemon=True)]
        ways = {"STOP": lambda: castle.is_stopped_by_page({}), "STOP with token": lambda: castle.is_stopped_by_page({"Authorization": "Bearer " + TOKEN}),
                "drive off": castle.is_stopped_by_ctl}
        if descriptors is not None:
            ways = {"drive off": castle.is_stopped_by_ctl}  # the page's guests are as many as the process has descriptors
        times_s, done = {way: [] for way in ways}, dict.fromkeys(ways, 0)
        try:
            for crowd in crowds:
                crowd.start()
            time.sleep(2.0)  # all have come
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                for way, stop in ways.items():
                    began = time.monotonic()
                    is_done, answer = stop()
                    times_s[way].append(time.monotonic() - began)
                    done[way] += is_done
                    if not is_done:
                        faults.append("%s: %s after %.2f s: %s" % (what, way, times_s[way][-1], answer))
                    time.sleep(0.05)
            if not all(crowd.is_alive() for crowd in crowds) or castle.daemon.poll() is not None:
                faults.append(what + ": crowd or daemon have ended")
        finally:
            for crowd in crowds:
                crowd.kill()
            castle.end()
        for way, all_s in times_s.items():
            all_s.sort()
            p50, p99 = all_s[len(all_s) // 2], all_s[min(len(all_s) - 1, int(0.99 * len(all_s)))]
            print("%s: %-15s %4d of %4d done, p50 %.3f s, p99 %.3f s, at most %.3f s" % (what, way, done[way], len(all_s), p50, p99, all_s[-1]), flush=True)
            if p99_s is not None and p99 > p99_s:
                faults.append("%s: p99 of %s is %.3f s" % (what, way, p99))


def main():
    clients = int(sys.argv[2]) if len(sys.argv) > 2 else 150
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 6.0
    p99_s = float(sys.argv[4]) if len(sys.argv) > 4 else None
    faults = []
    besieged(sys.argv[1], clients, seconds, p99_s, faults)
    besieged(sys.argv[1], clients, seconds, p99_s, faults, descriptors=FEW_DESCRIPTORS)
    besieged(sys.argv[1], 12, seconds / 2, p99_s, faults, log_is_read=False)
    for fault in faults[:20]:
        print("siege: " + fault, file=sys.stderr)
    if faults:
        print("siege: %d faults" % len(faults), file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
