#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the robot's pose whenever a planner may drive by it. usage: pose_client.py [SOCKET]"""
import json, socket, sys

SILENCE_S = 0.5  # no line for so long: no pose


def poses(path):
    """Each localized scan as a dictionary (docs/api.md); None where the stream is silent. Ends with the daemon."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as stream:
        stream.connect(path)
        stream.settimeout(SILENCE_S)
        waiting = b""
        while True:
            try:
                if not (received := stream.recv(65536)):
                    return
            except TimeoutError:
                yield None
                continue
            *lines, waiting = (waiting + received).split(b"\n")
            yield from (told for told in map(json.loads, lines) if told["type"] == "pose")


socket_of_daemon = sys.argv[1] if len(sys.argv) > 1 else "/run/deltamap/poses.sock"
try:
    for pose in poses(socket_of_daemon):
        if pose is None or not pose["may_drive_by_pose"] or pose["state"] != "tracking":
            print("stand", flush=True)
        else:
            print(f"{pose['time']:.3f} {pose['x_m']:.3f} {pose['y_m']:.3f} {pose['heading_rad']:.4f}", flush=True)
except BrokenPipeError:  # who reads has seen enough
    sys.exit()
except OSError as error:
    sys.exit(f"{socket_of_daemon}: {error.strerror}: does a daemon run that has it as poses.socket?")
