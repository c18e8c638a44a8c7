// CAN interfaces of the Linux kernel.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bridges/can/can_link.hpp"

namespace tandem::bridges {

/// Lets data frames pass whose (id & mask) equals (filter's id & mask), standard and extended ones apart.
struct CanFilter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0;
  bool extended = false;
};

/// A raw socket on one interface. Remote frames pass only where there is no filter. Own frames do not come back, those
/// of other programs on this machine do.
class SocketCanLink final : public CanLink {
 public:
  /// `filters`: at most 512; none: everything passes.
  /// Errors, each with what to do: kernel without CAN, no such interface, no CAN interface, interface down, no
  /// permission.
  static hal::Result<std::unique_ptr<CanLink>> open(const std::string& interface,
                                                    const std::vector<CanFilter>& filters = {});
  ~SocketCanLink() override;

  Sent send(const CanFrame& frame) noexcept override;
  bool receive(CanFrame& frame) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  int descriptor() const noexcept override { return socket_; }
  BusState state() const noexcept override { return record_.state(); }
  CanStatistics statistics() const noexcept override { return record_.counts; }
  std::string name() const override { return "can:" + interface_; }

 private:
  SocketCanLink(std::string interface, int socket) : interface_(std::move(interface)), socket_(socket) {}
  void note_failure(int error) noexcept;
  void look_whether_up() noexcept;

  std::string interface_;
  int socket_;
  BusRecord record_;
  std::uint32_t kernel_drops_ = 0;  // as the kernel counts them, wrapping
};

}  // namespace tandem::bridges
