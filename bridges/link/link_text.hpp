// Links as people write them: serial:/dev/ttyUSB0@115200, tcp:HOST:PORT, slcan:/dev/ttyACM0@1000000, can:can0, lcm:URL,
// pty:NAME.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "bridges/link/link.hpp"
#include "bridges/link/link_terms.hpp"
#include "hal/result.hpp"

namespace tandem::bridges {

enum class LinkScheme : std::uint8_t { Serial, Tcp, Slcan, Can, Lcm, Pty };

/// A LINK text taken apart.
struct LinkAddress {
  LinkScheme scheme = LinkScheme::Serial;
  std::string target;      ///< device path, host and port, CAN interface, LCM url, or name of the pseudo-terminal
  std::uint32_t rate = 0;  ///< baud of a serial device (115200 when not written), bit/s of slcan's bus; 0: has none
};

/// "serial", "slcan", …
std::string_view scheme_name(LinkScheme scheme) noexcept;
/// The text that `parse_link` reads back as the same address.
std::string to_text(const LinkAddress& address);

/// The same link for a process with another current folder: a device's path becomes absolute. Other links, and what is
/// no link at all, stay as they are.
std::string absolute_link(std::string_view text);

/// Takes a LINK text apart without touching any device. Errors: no scheme, unknown scheme (lists them), nothing after
/// the colon, a rate that is no number, a baud rate that serial devices do not have (names the nearest).
hal::Result<LinkAddress> parse_link(std::string_view text);

/// An opener for the byte links that reach a robot from here: `serial:`, and `tcp:` with a port.
/// Errors: any other scheme. Errors of the device itself come from the opener.
hal::Result<LinkOpener> byte_link_opener(const LinkAddress& address, const LinkTerms& terms = {});

}  // namespace tandem::bridges
