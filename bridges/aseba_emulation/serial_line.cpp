#include <array>

#include "bridges/aseba_emulation/host_line.hpp"
#include "bridges/aseba_emulation/stream.hpp"
#include "bridges/emulation/serial_port.hpp"

namespace tandem::bridges::aseba_emulation {
namespace {

constexpr std::size_t kMostUnsent = 64 * 1024;  // bytes that the robot can keep

/// The byte stream on a serial line, as USB shows the robot's. Where a host has said what no message is, everything up
/// to a pause is forgotten.
class SerialLine final : public HostLine {
 public:
  SerialLine(std::unique_ptr<SerialPort> port, std::string link, EventSink sink)
      : port_(std::move(port)), link_(std::move(link)), sink_(std::move(sink)) {}

  void add_polls(std::vector<pollfd>& polls) const override {
    const short room = unsent_.empty() ? 0 : POLLOUT;
    polls.push_back({port_->descriptor(), static_cast<short>(POLLIN | room), 0});
  }

  hal::Status take(hal::TimeNs now, std::vector<Message>& from_hosts) override {
    std::array<std::uint8_t, 1024> buffer{};
    const auto count = port_->read(buffer);
    if (!count.ok()) return count.error();
    if (count.value() == 0 && reader_.broken()) {
      sink_(now, "ignored", {{"why", "a message was announced that is too long"}});
      reader_ = {};
    }
    reader_.push(std::span(buffer).first(count.value()));
    while (auto message = reader_.next()) from_hosts.push_back(std::move(*message));
    return {};
  }

  void tell(const Message& message, hal::TimeNs now) override {
    const std::vector<std::uint8_t> bytes = to_bytes(message);
    if (unsent_.size() + bytes.size() > kMostUnsent) {  // a host that does not read loses the newest
      sink_(now, "overflow", {{"bytes", bytes.size()}});
      return;
    }
    unsent_.insert(unsent_.end(), bytes.begin(), bytes.end());
  }

  void flush(hal::TimeNs /*now*/) override {
    const std::size_t gone = port_->write(unsent_);
    unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(gone));
  }

  const std::string& path() const override { return port_->path(); }
  const std::string& link() const override { return link_; }

 private:
  std::unique_ptr<SerialPort> port_;
  std::string link_;
  EventSink sink_;
  StreamReader reader_;
  std::vector<std::uint8_t> unsent_;
};

}  // namespace

hal::Result<std::unique_ptr<HostLine>> open_serial_line(const std::string& link, const std::string& robot,
                                                        unsigned long baud, const EventSink& sink) {
  auto port = SerialPort::open(link, robot, baud);
  if (!port.ok()) return port.error();
  return std::unique_ptr<HostLine>(std::make_unique<SerialLine>(std::move(port).value(), link, sink));
}

hal::Result<std::unique_ptr<HostLine>> open_host_line(const std::string& link, const std::string& robot,
                                                      unsigned long baud, const EventSink& sink) {
  constexpr std::string_view kListen = "tcp-listen:";
  if (link.starts_with(kListen)) return open_tcp_line(link.substr(kListen.size()), sink);
  if (link.starts_with("pty:") || link.starts_with("serial:")) return open_serial_line(link, robot, baud, sink);
  return hal::Error{"link '" + link + "': " + robot + " takes pty:NAME, serial:DEVICE@" + std::to_string(baud) +
                    " or tcp-listen:PORT"};
}

}  // namespace tandem::bridges::aseba_emulation
