#!/usr/bin/env python3
"""An eye-bot in Python: plain sockets that speak LCM's short messages, types made by lcm-gen -p. It knows nothing of our code.

    peer.py FOLDER NAME      FOLDER holds the package `eyebot` that lcm-gen made; runs until it is terminated.

It flies without inertia: a place or a velocity is followed at once, at a metre a second at most.
"""
import select
import socket
import struct
import sys
import time

sys.path.insert(0, sys.argv[1])
import eyebot  # noqa: E402

GROUP, PORT = "239.255.76.67", 7667
NAME = sys.argv[2]
HEAD = "eyebot/" + NAME + "/"
SESSION = 0x70790001
SPEED_M_S = 1.0


def open_socket():
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
    s.bind(("", PORT))
    s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, struct.pack("4sL", socket.inet_aton(GROUP), socket.INADDR_ANY))
    s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    return s


class Robot:
    def __init__(self):
        self.socket = open_socket()
        self.datagrams = 0
        self.seq = {}
        self.mode = eyebot.status_t.MODE_IDLE
        self.armed = False
        self.place = [0.0, 0.0, 0.0]
        self.target = None
        self.velocity = [0.0, 0.0, 0.0]
        self.done = {}  # (session, seq) of orders -> result
        self.last_order = (0, 0)
        self.controller = 0

    def say(self, topic, message):
        message.hdr = eyebot.header_t()
        message.hdr.utime = int(time.time() * 1e6)
        message.hdr.seq = self.seq.get(topic, 0)
        message.hdr.session = SESSION
        self.seq[topic] = message.hdr.seq + 1
        datagram = struct.pack(">II", 0x4C433032, self.datagrams) + (HEAD + topic).encode() + b"\0" + message.encode()
        self.datagrams += 1
        self.socket.sendto(datagram, (GROUP, PORT))

    def say_heartbeat(self):
        m = eyebot.heartbeat_t()
        m.name, m.role, m.proto_major, m.proto_minor = NAME, eyebot.heartbeat_t.ROLE_ROBOT, 1, 0
        m.period_ms, m.uptime_ms = 200, int(time.monotonic() * 1000)
        self.say("heartbeat", m)

    def say_status(self):
        m = eyebot.status_t()
        m.mode, m.failsafe, m.armed = self.mode, eyebot.status_t.FS_NONE, self.armed
        m.magnet_on = m.attached = False
        m.cmd_session, m.cmd_seq = self.last_order
        m.cmd_age_ms, m.cmd_rejected, m.text = 0, 0, ""
        self.say("status", m)

    def say_state(self):
        m = eyebot.state_t()
        m.source, m.pos_valid, m.yaw_valid = eyebot.state_t.SRC_SIM, True, True
        m.pos, m.vel = list(self.place), list(self.velocity)
        m.quat, m.omega, m.pos_sigma = [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.01
        self.say("state", m)

    def order(self, m):
        key = (m.hdr.session, m.hdr.seq)
        if key not in self.done:
            self.done[key] = self.obey(m)
        ack = eyebot.ack_t()
        ack.channel = HEAD + "cmd/mode"
        ack.cmd_session, ack.cmd_seq = key
        ack.result, ack.text = self.done[key], ""
        self.say("ack", ack)
        self.say_status()

    def obey(self, m):
        c, s, a = eyebot.cmd_mode_t, eyebot.status_t, eyebot.ack_t
        if m.action == c.ACT_ARM:
            if self.controller not in (0, m.hdr.session):
                return a.REJECTED_SOURCE
            self.controller, self.armed = m.hdr.session, True
        elif m.hdr.session != self.controller:
            return a.REJECTED_SOURCE
        elif m.action == c.ACT_DISARM:
            if self.mode != s.MODE_IDLE:
                return a.REJECTED_MODE
            self.controller, self.armed = 0, False
        elif m.action == c.ACT_TAKEOFF:
            if self.mode != s.MODE_IDLE or not self.armed:
                return a.REJECTED_MODE
            self.mode, self.target = s.MODE_TAKEOFF, [self.place[0], self.place[1], 1.0]
        elif m.action == c.ACT_HOVER:
            self.mode, self.target = s.MODE_HOVER, None
        elif m.action == c.ACT_LAND:
            self.mode, self.target = s.MODE_LAND, [self.place[0], self.place[1], 0.0]
        else:
            return a.UNSUPPORTED
        self.last_order = (m.hdr.session, m.hdr.seq)
        return a.OK

    def take(self, datagram):
        if datagram[:4] != b"LC02":
            return
        channel, payload = datagram[8:].split(b"\0", 1)
        channel = channel.decode()
        flies = self.mode in (eyebot.status_t.MODE_HOVER, eyebot.status_t.MODE_POSITION, eyebot.status_t.MODE_VELOCITY)
        if channel == HEAD + "cmd/mode":
            self.order(eyebot.cmd_mode_t.decode(payload))
        elif channel == HEAD + "cmd/position" and flies:
            m = eyebot.cmd_position_t.decode(payload)
            if m.hdr.session == self.controller:
                self.mode, self.target = eyebot.status_t.MODE_POSITION, list(m.pos)
        elif channel == HEAD + "cmd/velocity" and flies:
            m = eyebot.cmd_velocity_t.decode(payload)
            if m.hdr.session == self.controller:
                self.mode, self.target, self.velocity = eyebot.status_t.MODE_VELOCITY, None, list(m.vel)

    def move(self, dt_s):
        if self.mode == eyebot.status_t.MODE_VELOCITY:
            self.place = [p + v * dt_s for p, v in zip(self.place, self.velocity)]
            return
        if self.target is None:
            return
        way = [t - p for t, p in zip(self.target, self.place)]
        length = sum(w * w for w in way) ** 0.5
        part = 1.0 if length <= SPEED_M_S * dt_s else SPEED_M_S * dt_s / length
        self.place = [p + part * w for p, w in zip(self.place, way)]
        if part == 1.0 and self.mode == eyebot.status_t.MODE_TAKEOFF:
            self.mode = eyebot.status_t.MODE_HOVER
        if part == 1.0 and self.mode == eyebot.status_t.MODE_LAND:
            self.mode = eyebot.status_t.MODE_IDLE

    def live(self):
        step = 0
        due = time.monotonic()
        while True:
            wait = due - time.monotonic()
            if wait > 0:
                if select.select([self.socket], [], [], wait)[0]:
                    self.take(self.socket.recv(65536))
                continue
            due += 0.02
            self.move(0.02)
            self.say_state()
            if step % 5 == 0:
                self.say_status()
            if step % 10 == 0:
                self.say_heartbeat()
            step += 1


Robot().live()
