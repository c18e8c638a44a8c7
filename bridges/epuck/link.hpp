// Links to e-pucks: serial:DEVICE@115200, tcp:HOST:PORT of a serial server, epuck-tcp:HOST of an e-puck2's own radio.
#pragma once
#include <string_view>

#include "bridges/epuck/conversation.hpp"
#include "bridges/link/link.hpp"
#include "bridges/link/link_terms.hpp"

namespace tandem::bridges::epuck {

inline constexpr std::string_view kWifiScheme = "epuck-tcp";
inline constexpr std::uint16_t kWifiPort = 1000;  ///< [e-puck2_esp32]

/// For people.
inline constexpr std::string_view kLinks = "serial:DEVICE@115200, tcp:HOST:PORT (ser2net), epuck-tcp:HOST (e-puck2)";

struct EpuckLink {
  WireForm wire = WireForm::Serial;
  LinkOpener open;
  std::uint16_t port = 0;  ///< that it connects to; 0: no network is between
};

/// How to open the link to an e-puck, and what is spoken there. Errors: not a link, one that carries no bytes, no host
/// or port; a baud rate that no e-puck's firmware has: what is sent at a wrong rate arrives as other bytes, and these
/// could move the robot.
hal::Result<EpuckLink> epuck_link(std::string_view text, const LinkTerms& terms = {});

}  // namespace tandem::bridges::epuck
