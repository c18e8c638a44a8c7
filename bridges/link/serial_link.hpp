// Serial ports: USB adapters, Bluetooth's /dev/rfcommN, pseudo-terminals.
#pragma once
#include <memory>

#include "bridges/link/descriptor_link.hpp"
#include "bridges/link/link_text.hpp"

namespace tandem::bridges {

/// A serial port, 8 data bits, no parity, 1 stop bit, no flow control, raw. LibSerial opens and configures it; reading
/// and writing are done here on its descriptor, because its own calls sleep and spin. A second SerialLink, and others
/// who lock devices before they use them, are told that it is busy. The kernel's own exclusive mode is left off: it
/// would keep out our guardian while this program is frozen.
class SerialLink final : public DescriptorLink {
 public:
  /// Blocks while the kernel does, for seconds on Bluetooth.
  /// Errors, each with what to do: no such device, no permission, busy, not a terminal, Bluetooth peer down, not
  /// configurable.
  /// `beside`: another holder of the port does not matter.
  static hal::Result<std::unique_ptr<ByteLink>> open(const LinkAddress& address, bool beside = false);
  ~SerialLink() override;

  Received read(std::span<std::uint8_t> buffer) noexcept override;
  std::string name() const override { return to_text(address_); }

 private:
  class Port;
  SerialLink(LinkAddress address, std::unique_ptr<Port> port);
  ssize_t put(std::span<const std::uint8_t> bytes) noexcept override;

  LinkAddress address_;
  std::unique_ptr<Port> port_;
};

}  // namespace tandem::bridges
