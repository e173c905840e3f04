#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the golden frames of both devices: NAME.bytes, frames one after another as on the wire, and NAME.expected, a JSON
line for each with its place (at, size), its name and the fields that went into it. Framing, checksum and CRC are built here
from the words of docs/protocols (arcos.md, lms200.md); nothing is shared with the codecs that are tested against them.

  golden_frames.py            writes the files beside itself
  golden_frames.py --check    exit code 1 where a file is not what would be written"""
import json, pathlib, struct, sys

HERE = pathlib.Path(__file__).resolve().parent


# --- ARCOS: FA FB, count, data, checksum high byte first ---

def arcos_sum(data):
    """Words high byte first are added modulo 65536; a single last byte is XORed into the low byte."""
    total = 0
    for i in range(0, len(data) - 1, 2):
        total = (total + data[i] * 256 + data[i + 1]) % 65536
    if len(data) % 2:
        total ^= data[-1]
    return total


def packet(data):
    return bytes([0xFA, 0xFB, len(data) + 2]) + data + struct.pack(">H", arcos_sum(data))


def number_argument(value):
    """Sign and magnitude: never two's complement."""
    return struct.pack("<BH", 0x3B if value >= 0 else 0x1B, abs(value))


def byte_pair_argument(left, right):
    """The two signed bytes make one 16-bit value first; the sign rule then acts on that."""
    return number_argument(struct.unpack("<h", struct.pack("bb", right, left))[0])


def arcos_commands():
    plain = [("PULSE", 0), ("OPEN", 1), ("CLOSE", 2), ("SETO", 7), ("CONFIG", 18), ("STOP", 29), ("ESTOP", 55), ("RESET", 253)]
    for name, number in plain:
        yield packet(bytes([number])), {"name": name, "command": number}
    numbers = [("OPEN", 1, 1), ("ENABLE", 4, 1), ("ENABLE", 4, 0), ("SETA", 5, 300), ("SETA", 5, -300), ("SETV", 6, 750), ("MOVE", 8, -1500),
               ("ROTATE", 9, -30), ("SETRV", 10, 100), ("VEL", 11, 0), ("VEL", 11, 250), ("VEL", 11, -250), ("VEL", 11, -1), ("HEAD", 12, 359),
               ("DHEAD", 13, -90), ("ENCODER", 19, 2), ("RVEL", 21, 45), ("RVEL", 21, -45), ("SETRA", 23, 100), ("SETRA", 23, -100),
               ("SONAR", 28, 0), ("ADSEL", 35, 3), ("GYROCALCW", 38, 65535), ("IOREQUEST", 40, 2), ("BUMPSTALL", 44, 3), ("JOYDRIVE", 47, 1),
               ("SONARCYCLE", 48, 40), ("HOSTBAUD", 50, 2), ("ESTALL", 56, 1), ("GYRO", 58, 1), ("BATTERYINFO", 62, 1), ("BATTEST", 250, 118)]
    for name, number, value in numbers:
        yield packet(bytes([number]) + number_argument(value)), {"name": name, "command": number, "argument": value}
    for left, right in ((10, 10), (10, -5), (-5, 5), (-10, -10), (0, -1), (-128, 127)):
        fields = {"name": "VEL2", "command": 32, "left": left, "right": right}
        yield packet(bytes([32]) + byte_pair_argument(left, right)), fields
    for text in (b"\x01\x02\x03\x04\x05\x06\x07\x08", b"", bytes(range(1, 33))):
        yield packet(bytes([3, 0x2B, len(text)]) + text), {"name": "POLLING", "command": 3, "text": text.hex()}


def sip(kind, x, y, heading, left, right, battery, stall, control, flags, compass, sonar, tail):
    fields = dict(name="SIP", moving=kind == 0x33, x_units=x, y_units=y, heading_units=heading, left_mm_per_s=left, right_mm_per_s=right,
                  battery_decivolts=battery, left_stall=bool(stall[0] & 1), rear_bumpers=stall[0] >> 1, right_stall=bool(stall[1] & 1),
                  front_bumpers=stall[1] >> 1, control_units=control, flags=flags, compass=compass, sonar=[list(one) for one in sonar])
    data = struct.pack("<BHHhhhBBBhHBB", kind, x, y, heading, left, right, battery, stall[0], stall[1], control, flags, compass, len(sonar))
    for index, range_mm in sonar:
        data += struct.pack("<BH", index, range_mm)
    layout = [("grip_state", "B"), ("analog_port", "B"), ("analog", "B"), ("digital_in", "B"), ("digital_out", "B"),
              ("battery_x10_decivolts", "H"), ("charge_state", "B"), ("turn_rate_decideg_per_s", "h"), ("fault_flags", "H"),
              ("lateral_mm_per_s", "h"), ("temperature_c", "b"), ("charge_percent", "B"), ("controller_time_us", "I"), ("flags3", "I")]
    for (name, code), value in zip(layout, tail):
        data += struct.pack("<" + code, value)
        fields[name] = value
    return packet(data), fields


def arcos_packets():
    yield packet(b"\x00"), {"name": "SYNC0"}
    yield packet(b"\x01"), {"name": "SYNC1"}
    yield packet(b"\x02" + b"Hall_7\0Pioneer\0p3dx-sh\0"), {"name": "identity", "robot": "Hall_7", "type": "Pioneer", "subtype": "p3dx-sh"}
    yield packet(b"\x02" + b"\0Pioneer\0p3dx\0"), {"name": "identity", "robot": "", "type": "Pioneer", "subtype": "p3dx"}
    eight = [(i, 400 + 311 * i) for i in range(8)]
    sixteen = [(15 - i, 5000 - 297 * i) for i in range(16)]
    yield sip(0x32, 0, 0, 0, 0, 0, 126, (0, 0), 0, 0x0000, 0, [], [])
    yield sip(0x33, 1234, 32767, -2048, 300, 301, 121, (0, 0), -1024, 0x001F, 45, eight, [0, 1, 127, 0xA5, 0x5A])
    yield sip(0x33, 65535, 1, 2047, -250, 250, 118, (0x01, 0x00), 1023, 0x0001, 179, sixteen,
              [3, 2, 255, 0, 255, 1214, 1, -800, 0x8001])
    yield sip(0x32, 20000, 40000, -1, 0, 0, 109, (0x55, 0xAB), 0, 0x0421, 1, [(31, 65535)],
              [0, 0, 0, 0, 0, 1090, 3, 0, 0x0002, -3, -127, 88])
    yield sip(0x33, 7, 8, 9, 10, 11, 12, (0xFE, 0xFE), 13, 0x07FE, 14, [], [1, 2, 3, 4, 5, 6, 2, 7, 8, 9, 10, 11, 4000000000, 0x01020304])
    yield config()
    yield packet(struct.pack("<Bii", 0x90, 123456789, -2)), {"name": "ENCODERpac", "left_ticks": 123456789, "right_ticks": -2}
    readings = [(512, 25), (511, 25), (1023, 255), (0, 0)]
    data = struct.pack("<BB", 0x98, len(readings)) + b"".join(struct.pack("<HB", *one) for one in readings)
    yield packet(data), {"name": "GYROpac", "readings": [list(one) for one in readings]}
    yield packet(b"\x98\x00"), {"name": "GYROpac", "readings": []}
    data = bytes([0xF0, 2, 0x81, 0x7E, 1, 0x3C, 3]) + struct.pack("<3H", 0, 513, 1023)
    yield packet(data), {"name": "IOpac", "digital_in": [0x81, 0x7E], "digital_out": [0x3C], "analog": [0, 513, 1023]}


# In wire order. Every value is another one, so that no field can stand in for its neighbour.
CONFIG = [("type", "s", "Pioneer"), ("subtype", "s", "p3dx-sh"), ("serial_number", "s", "AB-1042"), ("four_motors", "B", 1),
          ("rot_vel_top", "H", 501), ("trans_vel_top", "H", 2202), ("rot_acc_top", "H", 303), ("trans_acc_top", "H", 2004), ("pwm_max", "H", 505),
          ("name", "s", "Hall_7"), ("sip_cycle_ms", "B", 100), ("host_baud", "B", 2), ("aux1_baud", "B", 3), ("has_gripper", "H", 6),
          ("front_sonar", "H", 7), ("rear_sonar", "B", 8), ("low_battery_decivolts", "H", 115), ("rev_count", "H", 16571), ("watchdog_ms", "H", 1999),
          ("p2_mpacs", "B", 9), ("stall_val", "H", 201), ("stall_count_ms", "H", 202), ("joy_vel", "H", 203), ("joy_rot_vel", "H", 204),
          ("rot_vel_max", "H", 205), ("trans_vel_max", "H", 751), ("rot_acc", "H", 206), ("rot_decel", "H", 207), ("rot_kp", "H", 41),
          ("rot_kv", "H", 21), ("rot_ki", "H", 10), ("trans_acc", "H", 301), ("trans_decel", "H", 302), ("trans_kp", "H", 42), ("trans_kv", "H", 22),
          ("trans_ki", "H", 11), ("front_bumpers", "B", 5), ("rear_bumpers", "B", 4), ("charger", "B", 12), ("sonar_cycle_ms", "B", 43),
          ("auto_baud", "B", 1), ("has_gyro", "B", 2), ("drift_factor", "h", -13), ("aux2_baud", "B", 14), ("aux3_baud", "B", 15),
          ("ticks_per_mm", "H", 129), ("shutdown_decivolts", "H", 110), ("firmware_version", "s", "3.1"), ("gyro_cw", "H", 16), ("gyro_ccw", "H", 17),
          ("kinematics_delay_ms", "B", 18), ("lat_vel_top", "H", 19), ("lat_acc_top", "H", 20), ("lat_vel_max", "H", 23), ("lat_acc", "H", 24),
          ("lat_decel", "H", 25), ("charge_threshold", "H", 26), ("pdb_port", "B", 27), ("gyro_rate_limit", "H", 28), ("high_temperature", "B", 29),
          ("power_bits", "H", 30), ("battery_type", "B", 31), ("soc_low", "H", 32), ("soc_shutdown", "H", 33)]


def config():
    data, fields = b"\x20", {"name": "CONFIGpac"}
    for name, code, value in CONFIG:
        data += value.encode() + b"\0" if code == "s" else struct.pack("<" + code, value)
        fields["robot" if name == "name" else name] = value
    return packet(data), fields


# --- LMS200: 02, address, length, command, data, CRC low byte first ---

def lms_crc(frame):
    """Shift left, and where a bit falls out of the 15 below it xor with 8005h; then xor with the last two bytes."""
    crc = before = 0
    for byte in frame:
        crc = ((crc & 0x7FFF) << 1) ^ 0x8005 if crc & 0x8000 else crc << 1
        crc ^= before << 8 | byte
        before = byte
    return crc


def telegram(address, content):
    frame = struct.pack("<BBH", 0x02, address, len(content)) + content
    return frame + struct.pack("<H", lms_crc(frame))


def request(command, data=b"", **fields):
    return telegram(0x00, bytes([command]) + data), dict(fields, command=command, data=data.hex())


def reply(response, content, state=0x10, **fields):
    return telegram(0x80, bytes([response]) + content + bytes([state])), dict(fields, response=response, state=state)


# Blanking, thresholds, mode, units, …: a configuration of a laser at 32 m in mm with real-time indices.
CONFIGURATION = bytes([0x00, 0x00, 0x46, 0x00, 0x02, 0x06, 0x01, 0x00, 0x00, 0x05, 0x02, 0x07, 0x00, 0x00, 0x0A, 0x0B, 0x50, 0x64, 0x00, 0x0A, 0x0C,
                       0x50, 0x80, 0x00, 0x0A, 0x0D, 0x50, 0x65, 0x03, 0x04, 0x08, 0x09, 0x02, 0x00])


def lms_requests():
    yield request(0x10, name="reset")
    yield request(0x20, b"\x00SICK_LMS", name="installation mode")
    yield request(0x20, b"\x24", name="stream")
    yield request(0x20, b"\x25", name="on request")
    for mode, baud in ((0x40, 38400), (0x41, 19200), (0x42, 9600), (0x48, 500000)):
        yield request(0x20, bytes([mode]), name="baud", baud=baud)
    yield request(0x30, b"\x01", name="scan")
    yield request(0x31, name="status")
    yield request(0x32, name="errors")
    yield request(0x3A, name="type")
    for angle, step in VARIANTS:
        yield request(0x3B, struct.pack("<HH", angle, step), name="variant", angle_deg=angle, step_centideg=step)
    yield request(0x66, b"\x00", name="permanent baud", on=False)
    yield request(0x66, b"\x01", name="permanent baud", on=True)
    yield request(0x74, name="configuration")
    yield request(0x77, CONFIGURATION, name="write configuration")


VARIANTS = [(180, 100), (180, 50), (100, 100), (100, 50), (100, 25)]
# Measuring mode: bits of the range.
RANGE_BITS = {0x00: 13, 0x01: 13, 0x02: 13, 0x03: 14, 0x04: 14, 0x05: 15, 0x06: 15}
# Below the highest code, which is "not valid": x..FFh.
CODES = {0: "not valid", 1: "dazzled", 2: "other", 4: "other", 5: "other", 8: "beyond maximum"}


def scan(angle, step, unit, mode, indices=None, partial=None, status=0x10):
    count = angle * 100 // step + 1 if partial is None else 181 if partial == 0 else 180
    bits = RANGE_BITS[mode]
    highest = (1 << bits) - 1
    words, ranges = [], []
    for i in range(count):
        if i % 17 == 5:
            below = list(CODES)[i // 17 % len(CODES)]
            word, meaning = highest - below, CODES[below]
        else:
            word = 1 + (7 + i * 89) % (highest - 9)  # 0 is no range, and at highest - 8 the codes begin
            meaning = word
        flags = 0 if bits == 16 else i % (1 << 16 - bits)
        words.append(flags << bits | word)
        ranges.append(meaning)
    head = count | unit << 14 | (0 if partial is None else 0x2000 | partial << 11)
    data = struct.pack("<H%dH" % count, head, *words) + (bytes(indices) if indices else b"")
    return reply(0xB0, data, status, name="scan", count=count, unit=unit, mode=mode, partial=partial, indices=list(indices or []), ranges=ranges)


def status_reply():
    data = bytearray(153)
    fields = dict(name="status", software_version="V02.30 ", operating_mode=0x24, fault=1, variant_type=2, motor_revolutions=149, measuring_mode=6,
                  scan_angle_deg=100, resolution_centideg=25, restart_mode=3, restart_time=777, baud=38400, evaluations=4, permanent_baud=1,
                  address=5, field_set=6, units=1, laser_on=1, boot_version="V02.10 ", pollution=[101, 102, 103, 104, 105, 106, 107, 65535],
                  reference_pollution=[201, 202, 203, 204])
    data[1:8], data[124:131] = b"V02.30 ", b"V02.10 "
    struct.pack_into("<8H4H", data, 19, *fields["pollution"], *fields["reference_pollution"])
    for offset, value in ((8, 0x24), (9, 1), (18, 2), (102, 6), (111, 3), (118, 4), (119, 1), (120, 5), (121, 6), (122, 1), (123, 1)):
        data[offset] = value
    for offset, value in ((67, 149), (107, 100), (109, 25), (112, 777), (116, 0x8019)):
        struct.pack_into("<H", data, offset, value)
    return reply(0xB1, bytes(data[1:]), **fields)


def lms_replies():
    yield b"\x06", {"name": "ACK"}
    yield b"\x15", {"name": "NAK"}
    yield reply(0x90, b"LMS200;301063;V02.10 ", name="power on", text="LMS200;301063;V02.10 ")
    yield reply(0x92, b"", name="refused")
    yield reply(0xA0, b"\x00", name="mode", switched=True)
    yield reply(0xA0, b"\x01", name="mode", switched=False)
    yield reply(0xBA, b"LMS200;301063;V02.10 ", name="type", text="LMS200;301063;V02.10 ")
    for accepted, (angle, step) in zip((True, True, True, False, False), VARIANTS):
        yield reply(0xBB, struct.pack("<BHH", accepted, angle, step), name="variant", accepted=accepted, angle_deg=angle, step_centideg=step)
    yield reply(0xF4, CONFIGURATION, name="configuration", bytes=CONFIGURATION.hex(), mode=6, units=1, indices=True)
    yield reply(0xF7, b"\x01" + CONFIGURATION, name="configuration written", bytes=CONFIGURATION.hex(), accepted=True)
    yield reply(0xF7, b"\x00" + CONFIGURATION, name="configuration written", bytes=CONFIGURATION.hex(), accepted=False)
    yield status_reply()


def lms_scans():
    for angle, step in VARIANTS:
        yield scan(angle, step, 0, 0x00)
        yield scan(angle, step, 1, 0x06)
    for mode in sorted(RANGE_BITS):
        yield scan(180, 100, 1, mode)
    yield scan(180, 50, 1, 0x06, indices=(254, 17))
    for raster in range(4):
        yield scan(180, 100, 0, 0x00, partial=raster)
    for status in (0x11, 0x12, 0x13, 0x14, 0x50, 0x90):  # information … fatal, implausible values, dirty window
        yield scan(180, 100, 0, 0x00, status=status)


STREAMS = {"arcos_commands": arcos_commands, "arcos_packets": arcos_packets, "lms_requests": lms_requests, "lms_replies": lms_replies,
           "lms_scans": lms_scans}


def files():
    for name, frames in STREAMS.items():
        stream, lines = b"", []
        for frame, fields in frames():
            lines.append(json.dumps({"at": len(stream), "size": len(frame), **fields}))
            stream += frame
        yield name + ".bytes", stream
        yield name + ".expected", ("\n".join(lines) + "\n").encode()


def main():
    stale = [name for name, content in files() if not (HERE / name).exists() or (HERE / name).read_bytes() != content]
    if sys.argv[1:] == ["--check"]:
        if stale:
            raise SystemExit("not as golden_frames.py writes them: " + ", ".join(stale))
        return
    for name, content in files():
        (HERE / name).write_bytes(content)


main()
