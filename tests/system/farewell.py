#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Real daemon, simulated robot whose controller reports absurd speeds: SIGTERM must end the daemon in time, in order, and not let go a
robot that rolls on by its own word. usage: farewell.py FOLDER-OF-PROGRAMS"""
import pathlib, signal, struct, sys, tempfile, time

from kills import Cable, Trial

ENDS_WITHIN_S = 5.0
NOT_LET_GO = "is told to stop and not let go"
SPEEDS = {None: False, 32767: True, -32768: True, 25000: True}  # mm/s, both wheels; whether the robot is kept


def checksum(body):
    total = sum(struct.unpack(">%dH" % (len(body) // 2), body[:len(body) // 2 * 2])) & 0xFFFF
    return total ^ body[-1] if len(body) % 2 else total


class LyingCable(Cable):
    """Puts a speed into every SIP, once it is told one."""
    speed, rest = None, b""

    def passed_on(self, data):
        data, out = self.rest + data, b""
        while (begin := data.find(b"\xfa\xfb")) >= 0 and len(data) >= begin + 3 and len(data) >= begin + 3 + data[begin + 2]:
            end = begin + 3 + data[begin + 2]
            body = bytearray(data[begin + 3:end - 2])
            if self.speed is not None and len(body) > 11 and body[0] in (0x32, 0x33):
                struct.pack_into("<hh", body, 7, self.speed, self.speed)
            out += data[:begin + 3] + bytes(body) + struct.pack(">H", checksum(body))
            data = data[end:]
        if begin < 0 and not data.endswith(b"\xfa"):
            out, data = out + data, b""
        self.rest = data
        return out


def main():
    faults = []
    for speed, is_kept in SPEEDS.items():
        with tempfile.TemporaryDirectory() as out:
            trial = Trial(sys.argv[1], out, 1, LyingCable)
            try:
                trial.start()
                trial.time_until_back()
                trial.ask("drive", "wander")
                time.sleep(3.0)
                trial.cable.speed = speed
                time.sleep(1.0)
                began = time.monotonic()
                trial.daemon.send_signal(signal.SIGTERM)
                code = trial.daemon.wait(150)
                took_s = time.monotonic() - began
                log = (pathlib.Path(out) / "daemon.log").read_text()
                print("reports %s mm/s: ended after %.1f s" % ("its own" if speed is None else speed, took_s), flush=True)
                if took_s > ENDS_WITHIN_S or code != 0:
                    faults.append("reports %s mm/s: ended after %.1f s with %d" % (speed, took_s, code))
                if (NOT_LET_GO in log) != is_kept:
                    faults.append("reports %s mm/s: %s" % (speed, "let go" if is_kept else "not let go"))
                time.sleep(1.0)
                began = time.time()
                time.sleep(1.0)
                if trial.way_since(began) > 0.01:
                    faults.append("reports %s mm/s: it drives on" % speed)
            finally:
                trial.end()
    for fault in faults:
        print("farewell: " + fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
