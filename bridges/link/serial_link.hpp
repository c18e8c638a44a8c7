// Serial ports: USB adapters, Bluetooth's /dev/rfcommN, pseudo-terminals.
#pragma once
#include <atomic>
#include <memory>

#include "bridges/link/link_text.hpp"

namespace tandem::bridges {

/// A serial port, 8 data bits, no parity, 1 stop bit, no flow control, raw. LibSerial opens and configures it; reading
/// and writing are done here on its descriptor, because its own calls sleep and spin. A second SerialLink, and others
/// who lock devices before they use them, are told that it is busy. The kernel's own exclusive mode is left off: it
/// would keep out our guardian while this program is frozen.
class SerialLink final : public ByteLink {
 public:
  /// Blocks while the kernel does, for seconds on Bluetooth.
  /// Errors, each with what to do: no such device, no permission, busy, not a terminal, Bluetooth peer down, not
  /// configurable.
  /// `beside`: whoever holds the port does not matter.
  static hal::Result<std::unique_ptr<ByteLink>> open(const LinkAddress& address, bool beside = false);
  ~SerialLink() override;

  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept override;
  Received read(std::span<std::uint8_t> buffer) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override { return wait_for_input(open_ ? descriptor_ : -1, timeout_ns); }
  int descriptor() const noexcept override { return descriptor_; }
  LinkState state() const noexcept override { return open_ ? LinkState::Open : LinkState::HungUp; }
  LinkStatistics statistics() const noexcept override { return {bytes_in_, bytes_out_, bytes_refused_, errors_}; }
  std::string name() const override { return to_text(address_); }

 private:
  class Port;
  SerialLink(LinkAddress address, std::unique_ptr<Port> port);
  void hang_up() noexcept {
    if (open_.exchange(false)) ++errors_;
  }

  LinkAddress address_;
  std::unique_ptr<Port> port_;
  int descriptor_;
  std::atomic<bool> open_{true};
  std::atomic<std::uint64_t> bytes_in_{0}, bytes_out_{0}, bytes_refused_{0}, errors_{0};
};

}  // namespace tandem::bridges
