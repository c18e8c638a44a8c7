// Device that a link leads to, resolved: equal for two names of one device, different for two devices.
//
//   serial and slcan   "/dev/ttyUSB0 188:0": path without links, and device number
//   TCP                "192.168.1.20:3000", "[fe80::1]:1000": numeric, as connected
//   CAN                "can0 of net:[4026531840]": interface, and the network that it is in
//   LCM, others        the text itself
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace tandem::bridges {

/// Of an open link, by `ByteLink::descriptor` or its like. Nothing: no descriptor, or one of no such device.
std::optional<std::string> device_of(int descriptor);

/// Of a LINK text, without opening it; may ask for a host's address, and so take seconds. The same text that
/// `device_of` gives once it is open. Nothing: there is no such device, host or interface now.
std::optional<std::string> device_at(std::string_view link);

/// What this computer knows of what hangs on an open serial device: the address of the Bluetooth robot, the serial
/// number of the USB adapter. Nothing: it does not tell.
std::optional<std::string> serial_number_of(int descriptor);

}  // namespace tandem::bridges
