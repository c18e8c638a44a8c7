#!/usr/bin/env python3
"""A peer of a run in lock-step, written from bridges/peer/README.md alone: an e-puck that turns away from what is near.

lockstep_peer.py HOST PORT ROBOT"""
import json
import socket
import struct
import sys
import zlib

HELLO, ROBOT, READY, TICK, COMMANDS, END, BYE = range(1, 8)
TYPES = {"f32": "f", "f64": "d", "u8": "B", "u16": "H", "u32": "I", "i32": "i", "i64": "q", "bool": "?"}


def frame(kind, payload):
    length = struct.pack("<I", len(payload))
    check = 255 - (kind + sum(length)) % 256
    body = bytes([kind, check]) + length + payload
    return b"TL" + body + struct.pack("<I", zlib.crc32(body))


def frames(link):
    data = b""
    while True:
        while len(data) >= 8:
            length = struct.unpack_from("<I", data, 4)[0]
            if data[:2] != b"TL" or data[3] != 255 - (data[2] + sum(data[4:8])) % 256 or length > 1 << 20:
                data = data[1:]
                continue
            if len(data) < length + 12:
                break
            if zlib.crc32(data[2:length + 8]) != struct.unpack_from("<I", data, length + 8)[0]:
                data = data[1:]
                continue
            yield data[2], data[8:length + 8]
            data = data[length + 12:]
        more = link.recv(65536)
        if not more:
            return
        data += more


def unpack(port, data, at):
    values = {}
    for name, kind, count, used_by, per_entry in port["fields"]:
        if used_by:
            count = values[used_by][0] * per_entry
        values[name] = struct.unpack_from("<%d%s" % (count, TYPES[kind]), data, at)
        at += struct.calcsize("<%d%s" % (count, TYPES[kind]))
    return values, at


def main():
    host, port, name = sys.argv[1:4]
    link = socket.create_connection((host, int(port)))
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    link.sendall(frame(HELLO, json.dumps({"protocol": "tandem lockstep", "version": 1, "robot": name}).encode()))
    proximity = wheels = None
    ticks = 0
    for kind, payload in frames(link):
        if kind == ROBOT:
            robot = json.loads(payload)
            by_name = {(p["role"], p["name"]): p for p in robot["ports"]}
            proximity = by_name["sensor", "proximity"]
            wheels = by_name["actuator", "differential_steering"]
            takes = [{k: p[k] for k in ("role", "name", "digest")} for p in (proximity, wheels)]
            ready = {"session": robot["session"], "takes": takes, "publishes": []}
            link.sendall(frame(READY, json.dumps(ready).encode()))
        elif kind == TICK:
            tick, flags = struct.unpack_from("<qB", payload)
            reading, at = unpack(proximity, payload, 9)
            if flags & 1:
                _, at = unpack(wheels, payload, at)
            assert at == len(payload), "the port does not have the form that the hub told"
            distances = reading["distance"]
            near = min(distances) < 0.03
            link.sendall(frame(COMMANDS, struct.pack("<qBdd", tick, 0, 0.05, -0.05 if near else 0.05)))
            ticks += 1
        elif kind == END:
            end = json.loads(payload)
            print(ticks, end["text"])
            return 1 if end["error"] else 0
    return 2


if __name__ == "__main__":
    sys.exit(main())
