#include <algorithm>
#include <deque>
#include <vector>

#include "bridges/epuck/driver.hpp"
#include "bridges/epuck_emulator/body.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
#include "bridges/link/link.hpp"
#include "bridges/wired/wired_line.hpp"

namespace tandem::bridges::wired {
namespace {

constexpr hal::TimeNs kHandshake_ns = 4 * hal::kNsPerSecond;
constexpr hal::TimeNs kStep_ns = hal::kNsPerMs / 2;

/// The host's end of the line.
class HostEnd final : public ByteLink {
 public:
  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs) noexcept override {
    written.emplace_back(bytes.begin(), bytes.end());
    return bytes.size();
  }
  Received read(std::span<std::uint8_t> buffer) noexcept override {
    if (arrived.empty()) return {};
    const epuck_emulator::SentByte first = arrived.front();
    arrived.pop_front();
    buffer[0] = first.byte;
    return {1, first.at};
  }
  bool wait(hal::TimeNs) noexcept override { return !arrived.empty(); }
  LinkState state() const noexcept override { return LinkState::Open; }
  LinkStatistics statistics() const noexcept override { return {}; }
  std::string name() const override { return "memory"; }

  std::deque<std::vector<std::uint8_t>> written;  // by the host, and not yet on the line
  std::deque<epuck_emulator::SentByte> arrived;
};

class WiredEpuck final : public WiredLine<epuck::EpuckDriver, epuck::SessionState::Active> {
 public:
  WiredEpuck(const WiredRequest& request, epuck_emulator::Variant variant)
      : WiredLine(request, kHandshake_ns, kStep_ns),
        firmware_(options_of(variant), body_, {}),
        driver_(settings_of(request), request.log) {}

  SharedPorts& body() noexcept override { return ports_; }
  std::string trouble() const override { return driver_.session().trouble(); }

 private:
  static epuck_emulator::Firmware::Options options_of(epuck_emulator::Variant variant) {
    epuck_emulator::Firmware::Options options;
    options.variant = variant;
    return options;
  }
  static epuck::DriverSettings settings_of(const WiredRequest& request) {
    epuck::DriverSettings s;
    set_robot(s, request, kHandshake_ns);
    return s;
  }

  epuck::EpuckDriver& driver() noexcept override { return driver_; }
  void power_on() override { firmware_.power_on(0); }
  /// Every byte takes its time.
  void turn(hal::TimeNs now) override {
    driver_.pump(host_, now);
    if (!host_.written.empty()) {
      for (const std::uint8_t byte : host_.written.front()) {
        line_free_ns_ = std::max(line_free_ns_, now) + epuck_emulator::kByteNs;
        pending_.push_back({byte, line_free_ns_});
      }
      host_.written.pop_front();
    }
    while (!pending_.empty() && pending_.front().at <= now) {
      firmware_.receive(pending_.front().byte, pending_.front().at);
      pending_.pop_front();
    }
    firmware_.run_until(now);
    sent_.clear();
    firmware_.take_sent(now, sent_);
    for (const epuck_emulator::SentByte& b : sent_) host_.arrived.push_back({b.byte, now});
  }

  hal::TimeNs line_free_ns_ = 0;
  SharedPorts ports_{epuck_emulator::body_ports()};
  epuck_emulator::PortBody body_{ports_};
  epuck_emulator::Firmware firmware_;
  epuck::EpuckDriver driver_;
  HostEnd host_;
  std::deque<epuck_emulator::SentByte> pending_;
  std::vector<epuck_emulator::SentByte> sent_;
};

}  // namespace

MadeWiredRobot make_wired_epuck(const WiredRequest& request) {
  if (const hal::Status good = WiredTime::check(request.tick_ns); !good.ok()) return good.error();
  const auto variant = epuck_emulator::variant_from(request.what.empty() ? "gctronic" : request.what);
  if (!variant.ok()) return variant.error();
  return std::unique_ptr<WiredRobot>(std::make_unique<WiredEpuck>(request, variant.value()));
}

}  // namespace tandem::bridges::wired
