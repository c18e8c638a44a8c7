#include "bridges/can/can_link_opener.hpp"

#include "bridges/can/permitted_can_link.hpp"
#include "bridges/can/slcan_link.hpp"

namespace tandem::bridges {
namespace {

constexpr std::uint32_t kAdapterBaud = 3'000'000;  // a full bus of 1 Mbit/s needs more than 2 Mbaud as text

}  // namespace

hal::Result<CanOpener> can_link_opener(const LinkAddress& address, std::vector<CanFilter> filters,
                                       const LinkTerms& terms) {
  switch (address.scheme) {
    case LinkScheme::Can:
      return permitted([interface = address.target, filters] { return SocketCanLink::open(interface, filters); },
                       terms.permit);
    case LinkScheme::Slcan:
      // The line, and not the frames: at its end an adapter is told to close its channel.
      return CanOpener([address, terms]() -> hal::Result<std::unique_ptr<CanLink>> {
        auto line = byte_link_opener({LinkScheme::Serial, address.target, kAdapterBaud}, terms).value()();
        if (!line) return line.error();
        SlcanSettings settings;
        settings.bits_per_s = address.rate;
        return SlcanLink::open(std::move(line).value(), settings);
      });
    default:
      return hal::Error{"link '" + to_text(address) +
                        "' does not carry CAN frames; use can:INTERFACE or slcan:DEVICE@BITRATE"};
  }
}

}  // namespace tandem::bridges
