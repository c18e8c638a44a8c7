#include "bridges/aseba_emulation/host_line.hpp"
#include "bridges/footbot_emulator/assembler.hpp"
#include "bridges/footbot_emulator/host_side.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

/// The translator between bus and serial line on the robot, and the switch that serves the line's messages to any
/// number of hosts.
class SwitchSide final : public HostSide {
 public:
  explicit SwitchSide(std::unique_ptr<aseba_emulation::HostLine> line) : line_(std::move(line)) {}

  void add_polls(std::vector<pollfd>& polls) const override { line_->add_polls(polls); }

  hal::Status take(hal::TimeNs now, std::vector<Frame>& to_bus) override {
    std::vector<Message> from_hosts;
    if (const hal::Status taken = line_->take(now, from_hosts); !taken.ok()) return taken;
    for (const Message& message : from_hosts) {
      const auto frames = to_frames(message);
      to_bus.insert(to_bus.end(), frames.begin(), frames.end());
    }
    return {};
  }

  void tell(const Frame& frame, hal::TimeNs now) override {
    if (const auto message = assembler_.push(frame)) line_->tell(*message, now);
  }

  void flush(hal::TimeNs now) override { line_->flush(now); }
  const std::string& path() const override { return line_->path(); }
  const std::string& link() const override { return line_->link(); }

 private:
  std::unique_ptr<aseba_emulation::HostLine> line_;
  Assembler assembler_;
};

}  // namespace

hal::Result<std::unique_ptr<HostSide>> open_switch(const std::string& endpoint, const EventSink& sink) {
  auto line = aseba_emulation::open_tcp_line(endpoint, sink);
  if (!line.ok()) return line.error();
  return std::unique_ptr<HostSide>(std::make_unique<SwitchSide>(std::move(line).value()));
}

}  // namespace tandem::bridges::footbot_emulator
