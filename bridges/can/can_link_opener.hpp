// Opens CAN links from LINK texts: can:can0, slcan:/dev/ttyACM0@1000000.
#pragma once
#include "bridges/can/socketcan_link.hpp"
#include "bridges/link/link_text.hpp"

namespace tandem::bridges {

/// An opener for a link that carries CAN frames. `filters` are the kernel's work where it has a part in it; slcan
/// adapters pass everything, and users must judge frames anyway. The serial line of an slcan adapter is opened at
/// 3 Mbaud, which USB adapters ignore.
/// Errors: any other scheme. Errors of the device itself come from the opener.
hal::Result<CanOpener> can_link_opener(const LinkAddress& address, std::vector<CanFilter> filters = {},
                                       const LinkTerms& terms = {});

}  // namespace tandem::bridges
