#include "bridges/emulation/serial_port.hpp"
#include "bridges/footbot_emulator/host_side.hpp"
#include "bridges/footbot_emulator/slcan_adapter.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr unsigned long kBaud = 1'000'000;
constexpr std::size_t kMostUnsent = 64 * 1024;  // characters that the adapter can keep

/// An slcan adapter behind a serial line.
class AdapterSide final : public HostSide {
 public:
  AdapterSide(std::unique_ptr<SerialPort> port, const EventSink& sink)
      : port_(std::move(port)), adapter_(sink), sink_(sink) {}

  void add_polls(std::vector<pollfd>& polls) const override {
    const short room = unsent_.empty() ? 0 : POLLOUT;
    polls.push_back({port_->descriptor(), static_cast<short>(POLLIN | room), 0});
  }

  hal::Status take(hal::TimeNs now, std::vector<Frame>& to_bus) override {
    std::array<std::uint8_t, 4096> buffer{};
    const auto count = port_->read(buffer);
    if (!count.ok()) return count.error();
    adapter_.receive(std::span(buffer).first(count.value()), now, to_bus);
    flush(now);
    return {};
  }

  void tell(const Frame& frame, hal::TimeNs now) override {
    adapter_.show(frame, now);
    flush(now);
  }

  // A host that does not read loses the newest.
  void flush(hal::TimeNs now) override {
    unsent_ += adapter_.take_output();
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(unsent_.data());
    unsent_.erase(0, port_->write({bytes, unsent_.size()}));
    if (unsent_.size() <= kMostUnsent) return;
    sink_(now, "overflow", {{"bytes", unsent_.size() - kMostUnsent}});
    unsent_.resize(kMostUnsent);
  }

  const std::string& path() const override { return port_->path(); }
  const std::string& link() const override { return port_->link(); }

 private:
  std::unique_ptr<SerialPort> port_;
  SlcanAdapter adapter_;
  EventSink sink_;
  std::string unsent_;
};

}  // namespace

hal::Result<std::unique_ptr<HostSide>> open_adapter(const std::string& link, const EventSink& sink) {
  auto port = SerialPort::open(link, "an emulated foot-bot's adapter", kBaud);
  if (!port.ok()) return port.error();
  return std::unique_ptr<HostSide>(std::make_unique<AdapterSide>(std::move(port).value(), sink));
}

hal::Result<std::unique_ptr<HostSide>> open_host_side(const std::string& link, const EventSink& sink) {
  const auto rest = [&](std::string_view scheme) { return link.substr(scheme.size()); };
  if (link.starts_with("can:")) return open_socketcan(rest("can:"), sink);
  if (link.starts_with("tcp-listen:")) return open_switch(rest("tcp-listen:"), sink);
  if (link.starts_with("pty:") || link.starts_with("serial:")) return open_adapter(link, sink);
  return hal::Error{"link '" + link +
                    "': an emulated foot-bot takes pty:NAME, serial:DEVICE@1000000, can:INTERFACE or tcp-listen:PORT"};
}

}  // namespace tandem::bridges::footbot_emulator
