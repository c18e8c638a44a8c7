// A TCP connection as a byte link: what asebaswitch and simulated robots listen on.
#pragma once
#include <memory>
#include <string>

#include "bridges/link/link.hpp"

namespace tandem::bridges::aseba {

inline constexpr std::uint16_t kAsebaPort = 33333;  ///< [Dashel's and asebaswitch's default]

/// A connection made by this side, without delays for small packets, and with keep-alive so that a peer that lost its
/// power is noticed.
class TcpLink final : public ByteLink {
 public:
  /// Blocks for the look-up of the name, and at most `timeout_ns` for the connection.
  /// Errors, each with what to do: unknown host, refused, no route, no answer.
  static hal::Result<std::unique_ptr<ByteLink>> connect(const std::string& host, std::uint16_t port,
                                                        hal::TimeNs timeout_ns = 3 * hal::kNsPerSecond);
  ~TcpLink() override;

  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept override;
  Received read(std::span<std::uint8_t> buffer) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  int descriptor() const noexcept override { return socket_; }
  LinkState state() const noexcept override { return open_ ? LinkState::Open : LinkState::HungUp; }
  LinkStatistics statistics() const noexcept override { return statistics_; }
  std::string name() const override { return name_; }

 private:
  TcpLink(std::string name, int socket) : name_(std::move(name)), socket_(socket) {}
  void hang_up() noexcept;

  std::string name_;
  int socket_;
  bool open_ = true;
  LinkStatistics statistics_;
};

}  // namespace tandem::bridges::aseba
