// An emulated robot's line over TCP, for one host at a time.
#pragma once
#include <memory>
#include <string_view>

#include "bridges/emulation/host_line.hpp"
#include "bridges/link/listener.hpp"

namespace tandem::bridges {

/// A second host gets its connection, and hears nothing until the first has hung up. Bytes that no host is there for
/// are lost.
class TcpPort final : public HostLine {
 public:
  /// As `Listener::open` takes them; `baud` is the robot's.
  static hal::Result<std::unique_ptr<TcpPort>> open(std::string_view scheme, std::string_view host_scheme,
                                                    const std::string& endpoint, unsigned long baud);
  ~TcpPort() override;
  TcpPort(const TcpPort&) = delete;
  TcpPort& operator=(const TcpPort&) = delete;

  int descriptor() const noexcept override { return host_ >= 0 ? host_ : listener_->descriptor(); }
  hal::Result<std::size_t> read(std::span<std::uint8_t> buffer) override;
  std::size_t write(std::span<const std::uint8_t> bytes) override;
  unsigned long host_baud() const override { return baud_; }
  const std::string& path() const noexcept override { return listener_->path(); }
  const std::string& device() const noexcept override { return nothing_; }
  const std::string& link() const noexcept override { return listener_->link(); }

  /// Grows with each host that connects.
  std::uint64_t hosts() const noexcept { return hosts_; }

 private:
  TcpPort(std::unique_ptr<Listener> listener, unsigned long baud) : listener_(std::move(listener)), baud_(baud) {}
  void hang_up() noexcept;

  std::unique_ptr<Listener> listener_;
  unsigned long baud_;
  int host_ = -1;
  std::uint64_t hosts_ = 0;
  std::string nothing_;
};

}  // namespace tandem::bridges
