"""A foot-bot's host written with python-can, independent of everything else here: can_peer.py DEVICE."""
import struct
import sys
import time

import can

HOST_WHOLE, HOST_FIRST, HOST_LAST = 0x300, 0x100, 0x200


def say(bus, kind, *words):
    inner = struct.pack("<H", kind) + struct.pack(f"<{len(words)}h", *words)
    if len(inner) <= 8:
        parts = [(HOST_WHOLE, inner)]
    else:
        assert len(inner) <= 16
        parts = [(HOST_FIRST, inner[:8]), (HOST_LAST, inner[8:])]
    for identifier, data in parts:
        bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))


def messages(bus, wanted, seconds=5.0):
    """Whole messages as (source, type, payload), until `wanted` of them have come."""
    found, pieces = [], {}
    end = time.monotonic() + seconds
    while len(found) < wanted and time.monotonic() < end:
        frame = bus.recv(0.2)
        if frame is None:
            continue
        assert not frame.is_extended_id and not frame.is_remote_frame
        part, source = frame.arbitration_id >> 8, frame.arbitration_id & 255
        if part in (1, 3):
            assert source not in pieces, "a message was cut off"
            pieces[source] = b""
        pieces[source] += bytes(frame.data)
        if part in (2, 3):
            inner = pieces.pop(source)
            found.append((source, struct.unpack_from("<H", inner)[0], inner[2:]))
    assert len(found) == wanted, f"{len(found)} messages instead of {wanted}"
    return found


def main(device):
    bus = can.Bus(interface="slcan", channel=device, bitrate=1000000, sleep_after_open=0.1)
    try:
        say(bus, 0xA011, 5)
        present = messages(bus, 9)
        assert sorted(m[0] for m in present) == list(range(1, 10)), present
        assert all(m[1:] == (0x900C, b"\x05\x00") for m in present), present

        # Every module describes itself, all of them at once: what they announce comes, and nothing else.
        say(bus, 0xA000, 4)
        expected = {1: 5, 2: 5, 3: 6, 4: 8, 5: 8, 6: 6, 7: 7, 8: 4, 9: 6}
        answers = messages(bus, sum(expected.values()) + 9 * (1 + 1 + 2))
        for source, variables in expected.items():
            mine = [m for m in answers if m[0] == source]
            kinds = [m[1] for m in mine]
            assert kinds == [0x9000] + [0x9001] * variables + [0x9002] + [0x9003] * 2, (source, kinds)
            name_end = 1 + mine[0][2][0]
            told = struct.unpack_from("<7H", mine[0][2], name_end)
            assert told[4:] == (variables, 1, 2), (source, told)
            sizes = [struct.unpack_from("<H", m[2])[0] for m in mine[1:1 + variables]]
            assert sizes[:3] == [1, 1, 32] and sum(sizes) <= told[3], (source, sizes)

        say(bus, 0xA00C, 1, 34, 30)
        say(bus, 0xA00B, 1, 34, 1)
        assert messages(bus, 1) == [(1, 0x9005, struct.pack("<2h", 34, 30))]

        # A message of two frames there, and of seven back.
        say(bus, 0xA00C, 7, 34, 1, 2, 3)
        say(bus, 0xA00B, 7, 34, 24)
        assert messages(bus, 1) == [(7, 0x9005, struct.pack("<25h", 34, 1, 2, 3, *[0] * 21))]
    finally:
        bus.shutdown()


main(*sys.argv[1:])
