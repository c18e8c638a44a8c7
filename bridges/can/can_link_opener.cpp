#include "bridges/can/can_link_opener.hpp"

#include "bridges/can/slcan_link.hpp"
#include "bridges/link/serial_link.hpp"

namespace tandem::bridges {
namespace {

constexpr std::uint32_t kAdapterBaud = 3'000'000;  // a full bus of 1 Mbit/s needs more than 2 Mbaud as text

}  // namespace

hal::Result<CanOpener> can_link_opener(const LinkAddress& address, std::vector<CanFilter> filters) {
  switch (address.scheme) {
    case LinkScheme::Can:
      return CanOpener([interface = address.target, filters] { return SocketCanLink::open(interface, filters); });
    case LinkScheme::Slcan:
      return CanOpener([address]() -> hal::Result<std::unique_ptr<CanLink>> {
        auto line = SerialLink::open({LinkScheme::Serial, address.target, kAdapterBaud});
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
