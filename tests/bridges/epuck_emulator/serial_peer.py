"""An e-puck host written with pyserial, independent of everything else here: serial_peer.py DEVICE FIRMWARE."""
import struct
import sys

import serial


def line_after(port, request, start):
    port.write(request)
    for _ in range(20):
        line = port.read_until(b"\r\n")
        if line.startswith(start):
            return line.strip()
    sys.exit(f"no answer to {request!r}")


def packet(port, request, size):
    port.write(request)
    answer = port.read(size)
    if len(answer) != size:
        sys.exit(f"{request.hex()}: {len(answer)} bytes instead of {size}")
    return answer


def main(device, firmware):
    with serial.Serial(device, 115200, timeout=5) as port:
        version = line_after(port, b"V\r", b"v,")
        assert (b"Version 2.0" in version) == (firmware == "epuck2"), version
        line_after(port, b"", b"HW version")
        assert line_after(port, b"D,300,-200\r", b"d") == b"d"
        assert line_after(port, b"E\r", b"e,") == b"e,300,-200"

        # Set speeds, read encoders, proximity and accelerometer in one packet.
        request = b"\xbc" + struct.pack("<hh", 0, 0) + b"\xaf\xb2\x9f\x00"
        values = struct.unpack("<2h8h3h", packet(port, request, 26))
        assert values[0] >= 0 >= values[1], values
        assert all(0 <= p <= 4095 for p in values[2:10]), values
        assert values[10:] == (2048, 2048, 2848), values  # both firmwares answer around 2048, 1 g is 800

        if firmware == "epuck2":
            sensors = packet(port, b"\xf8\x00", 103)
            assert struct.unpack_from("<3h", sensors, 0) == (0, 0, 800)  # calibrated, unlike the answer to a
            assert struct.unpack_from("<2h", sensors, 79) == values[:2]
        assert line_after(port, b"S\r", b"s") == b"s"


main(*sys.argv[1:])
