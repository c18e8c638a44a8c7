// Opens message links from LINK texts: tcp:ROBOT:33333, serial:/dev/ttymxc4@921600, can:can0,
// slcan:/dev/ttyACM0@1000000.
#pragma once
#include <cstdint>
#include <string_view>

#include "bridges/aseba/message_link.hpp"
#include "bridges/link/link_terms.hpp"

namespace tandem::bridges::aseba {

inline constexpr std::uint16_t kAsebaPort = 33333;  ///< [Dashel's and asebaswitch's default]

/// An opener for the link that the text names. The port of `tcp:` is 33333 where none is written; addresses of IPv6
/// stand in brackets: tcp:[::1]:33333.
/// Errors: not a link; one that carries no ASEBA messages; no host; not a port. Errors of the device or the network
/// come from the opener.
hal::Result<MessageLinkOpener> message_link_opener(std::string_view text, const LinkTerms& terms = {});

}  // namespace tandem::bridges::aseba
