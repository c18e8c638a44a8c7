"""A hub of its own for the emulated eye-bot: plain UDP sockets that speak LCM's short messages, and lcm-gen's Python.

usage: peer.py TANDEM TYPES FOLDER

Starts `TANDEM emulate eyebot` and lcm-logger, both in FOLDER, and flies the robot through a story. Ends with a message and code 1
where the robot does not do as the protocol says. TYPES is the folder where lcm-gen has put the package eyebot.
"""

import math
import os
import signal
import socket
import struct
import subprocess
import sys
import time

sys.path.insert(0, sys.argv[2])
import eyebot  # noqa: E402

GROUP, PORT = "239.255.76.67", 7667
PATIENCE_S = 30.0
FAILSAFE = eyebot.status_t
MODE = eyebot.status_t
ACTION = eyebot.cmd_mode_t
TYPES = {"heartbeat": eyebot.heartbeat_t, "status": eyebot.status_t, "state": eyebot.state_t, "ack": eyebot.ack_t,
         "altitude": eyebot.altitude_t, "battery": eyebot.battery_t, "prox": eyebot.prox_t, "light": eyebot.light_t,
         "pan_tilt": eyebot.pan_tilt_t, "rab": eyebot.rab_t, "blobs": eyebot.blobs_t, "leds": eyebot.leds_t,
         "scan": eyebot.scan_t}


class Wrong(Exception):
    """The robot did something else than the protocol says."""


class Bus:
    """Every message of the network, newest of each channel; what the robot said, decoded."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind(("", PORT))
        member = socket.inet_aton(GROUP) + socket.inet_aton("127.0.0.1")
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.sent = 0
        self.newest = {}
        self.seen = []  # (mode, failsafe), as they changed

    def send(self, channel, payload):
        datagram = struct.pack(">II", 0x4C433032, self.sent) + channel.encode() + b"\0" + payload
        self.sent += 1
        self.socket.sendto(datagram, (GROUP, PORT))

    def listen(self, seconds):
        """Takes what is there; waits for the first no longer than so."""
        self.socket.settimeout(max(seconds, 1e-3))
        while True:
            try:
                datagram = self.socket.recv(65536)
            except (socket.timeout, BlockingIOError):
                return
            self.socket.setblocking(False)
            if len(datagram) < 8 or struct.unpack(">I", datagram[:4])[0] != 0x4C433032:
                continue
            channel, _, payload = datagram[8:].partition(b"\0")
            parts = channel.decode().split("/")
            if len(parts) == 3 and parts[0] == "eyebot" and parts[2] in TYPES:
                message = TYPES[parts[2]].decode(payload)
                if message.encode() != payload:
                    raise Wrong("%s is not what it is encoded as" % parts[2])
                self.newest[parts[2]] = message
                if parts[2] == "status" and (message.mode, message.failsafe) != (self.seen or [None])[-1]:
                    self.seen.append((message.mode, message.failsafe))


class Hub:
    """Beats, orders and steers; lives on one bus with others."""

    def __init__(self, bus, name, session, beats=True):
        self.bus, self.name, self.session, self.beats = bus, name, session, beats
        self.seq = {}
        self.beat_at = 0.0

    def head(self, message, channel):
        message.hdr.utime = time.time_ns() // 1000
        message.hdr.session = self.session
        message.hdr.seq = self.seq[channel] = self.seq.get(channel, -1) + 1
        return message

    def live(self, seconds=0.02):
        if self.beats and time.monotonic() >= self.beat_at:
            self.beat_at = time.monotonic() + 0.2
            beat = self.head(eyebot.heartbeat_t(), "heartbeat")
            beat.name, beat.role, beat.proto_major, beat.period_ms = self.name, beat.ROLE_HUB, 1, 200
            self.bus.send("hub/%s/heartbeat" % self.name, beat.encode())
        self.bus.listen(seconds)

    def until(self, what, condition, meanwhile=lambda: None):
        end = time.monotonic() + PATIENCE_S
        while not condition(self.bus.newest):
            if time.monotonic() > end:
                raise Wrong("not within %g s: %s; seen: %s" % (PATIENCE_S, what, self.bus.seen))
            meanwhile()
            self.live()

    def until_mode(self, mode, failsafe=None, meanwhile=lambda: None):
        self.until("mode %d, fail-safe %s" % (mode, failsafe),
                   lambda n: n["status"].mode == mode and failsafe in (None, n["status"].failsafe), meanwhile)

    def order(self, action, expected, param=0.0, again=None):
        """Sends until it is acknowledged. @returns the message"""
        message = again or self.head(ACTION(), "mode")
        if not again:
            message.action, message.param = action, param
        self.bus.newest.pop("ack", None)

        def answered(newest):
            ack = newest.get("ack")
            return ack and (ack.cmd_session, ack.cmd_seq) == (self.session, message.hdr.seq)

        self.bus.send("eyebot/eb0/cmd/mode", message.encode())
        self.until("an answer to %d" % message.action, answered)
        result = self.bus.newest["ack"].result
        if result != expected:
            raise Wrong("%d was answered with %d instead of %d" % (message.action, result, expected))
        return message

    def fly_to(self, x, y, z):
        message = self.head(eyebot.cmd_position_t(), "position")
        message.pos = [x, y, z]
        self.bus.send("eyebot/eb0/cmd/position", message.encode())
        self.until("at (%g, %g, %g)" % (x, y, z), lambda n: math.dist(n["state"].pos, (x, y, z)) < 0.05)

    def fly(self, x, y, z, timeout_ms=0):
        message = self.head(eyebot.cmd_velocity_t(), "velocity")
        message.vel, message.timeout_ms = [x, y, z], timeout_ms
        self.bus.send("eyebot/eb0/cmd/velocity", message.encode())


def hostile(bus):
    """What must be counted, and no more."""
    head = struct.pack(">qii", time.time_ns() // 1000, 1 << 30, 999)
    rab = struct.pack(">q", 0x45c4aa329f54ecfd)
    beat = struct.pack(">q", 0x7d370a605beb9bcc)
    for payload in (b"", rab, rab + head, rab + head + b"\xff", rab + head + b"\x7f"):
        bus.send("eyebot/eb0/cmd/rab", payload)
    for length in (0, -1, -(1 << 31), (1 << 31) - 1):
        bus.send("hub/evil/heartbeat", beat + head + struct.pack(">i", length) + b"\0" * 15)
    bus.send("eyebot/eb0/cmd/mode", b"\0" * 29)
    bus.send("eyebot/eb0/cmd/position", b"\xff" * 60000)


def story(bus):
    hub, rival = Hub(bus, "lab", 4711), Hub(bus, "rival", 815, beats=False)
    hub.until("a sign of life", lambda n: {"heartbeat", "status", "state"} <= set(n))
    hub.until_mode(MODE.MODE_IDLE)
    hub.order(ACTION.ACT_TAKEOFF, 4)  # nobody is in control
    armed = hub.order(ACTION.ACT_ARM, 0)
    hub.order(None, 0, again=armed)
    rival.order(ACTION.ACT_ARM, 4)
    hub.order(ACTION.ACT_TAKEOFF, 0, param=1.0)
    hub.until_mode(MODE.MODE_HOVER)
    for corner in ((1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (0.0, 1.0, 1.5), (0.0, 0.0, 1.0)):
        rival.fly(-1.0, -1.0, 0.0)
        hub.fly_to(*corner)
    if bus.newest["status"].cmd_rejected < 6:
        raise Wrong("%d commands were refused instead of 6 or more" % bus.newest["status"].cmd_rejected)
    hostile(bus)
    hub.fly(0.3, 0.0, 0.0)
    hub.until_mode(MODE.MODE_HOVER, FAILSAFE.FS_CMD_TIMEOUT)
    hub.fly(math.nan, 0.0, 0.0)
    hub.fly(0.2, 0.0, 0.0, timeout_ms=60000)
    hub.until_mode(MODE.MODE_VELOCITY, FAILSAFE.FS_NONE)
    # The hub dies in flight: nobody sends any more.
    watcher = Hub(bus, "nobody", 1, beats=False)
    watcher.until_mode(MODE.MODE_HOVER, FAILSAFE.FS_LINK_LOST)
    watcher.until_mode(MODE.MODE_LAND, FAILSAFE.FS_LINK_LOST)
    watcher.until_mode(MODE.MODE_IDLE, FAILSAFE.FS_LINK_LOST)
    if bus.newest["status"].armed or bus.newest["state"].pos[2] > 0.01:
        raise Wrong("it lies on the ground and is not armed")


def wait_for_witness(bus, path):
    """Until it writes down what it hears."""
    end = time.monotonic() + PATIENCE_S
    while not os.path.exists(path) or os.path.getsize(path) == 0:
        if time.monotonic() > end:
            raise Wrong("lcm-logger writes nothing")
        bus.send("peer/hello", b"")
        time.sleep(0.05)


def end(process, number, name):
    process.send_signal(number)
    code = process.wait(PATIENCE_S)
    if name and code != 0:
        raise Wrong("%s ended with %d" % (name, code))


def main():
    tandem, folder = sys.argv[1], sys.argv[3]
    url = "udpm://%s:%d?ttl=0" % (GROUP, PORT)
    bus = Bus()
    started = []
    try:
        # A witness that gets no processor loses what it should write down: it goes first.
        logger = subprocess.Popen(["lcm-logger", "-q", "--lcm-url=" + url, "witness.lcm"], cwd=folder,
                                  preexec_fn=lambda: os.setpriority(os.PRIO_PROCESS, 0, -15))
        started.append(logger)
        wait_for_witness(bus, os.path.join(folder, "witness.lcm"))
        robot = subprocess.Popen([tandem, "emulate", "eyebot", "--link", "lcm:" + url, "--log", "robot.jsonl"],
                                 cwd=folder)
        started.append(robot)
        story(bus)
        end(robot, signal.SIGINT, "the emulator")
        end(logger, signal.SIGTERM, None)
    except Wrong as wrong:
        print("peer: %s" % wrong)
        return 1
    finally:
        for process in started:
            if process.poll() is None:
                process.kill()
    return 0


if __name__ == "__main__":
    sys.exit(main())
