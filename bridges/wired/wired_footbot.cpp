#include <deque>
#include <utility>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/footbot/driver.hpp"
#include "bridges/footbot/map_file.hpp"
#include "bridges/footbot_emulator/body.hpp"
#include "bridges/footbot_emulator/footbot.hpp"
#include "bridges/wired/wired_line.hpp"
#include "hal/element.hpp"

namespace tandem::bridges::wired {
namespace {

constexpr hal::TimeNs kHandshake_ns = 5 * hal::kNsPerSecond;
constexpr hal::TimeNs kStep_ns = hal::kNsPerMs / 4;

/// Frames on their way.
struct Bus {
  std::deque<CanFrame> to_robot, to_host;
};

class HostEnd final : public CanLink {
 public:
  explicit HostEnd(Bus& bus) : bus_(bus) {}
  Sent send(const CanFrame& frame) noexcept override {
    bus_.to_robot.push_back(frame);
    return Sent::Taken;
  }
  bool receive(CanFrame& frame) noexcept override {
    if (bus_.to_host.empty()) return false;
    frame = bus_.to_host.front();
    bus_.to_host.pop_front();
    return true;
  }
  bool wait(hal::TimeNs) noexcept override { return !bus_.to_host.empty(); }
  BusState state() const noexcept override { return BusState::Active; }
  CanStatistics statistics() const noexcept override { return {}; }
  std::string name() const override { return "memory bus"; }

 private:
  Bus& bus_;
};

class WiredFootbot final : public WiredLine<footbot::FootbotDriver, footbot::RobotState::Active> {
 public:
  WiredFootbot(const WiredRequest& request, footbot::FootbotMap map)
      : WiredLine(request, kHandshake_ns, kStep_ns),
        modules_({}, body_, {}),
        driver_(settings_of(request, std::move(map)), messages_) {}

  SharedPorts& body() noexcept override { return ports_; }
  std::string trouble() const override { return driver_.trouble(); }

 private:
  static footbot::DriverSettings settings_of(const WiredRequest& request, footbot::FootbotMap map) {
    footbot::DriverSettings s;
    s.map = std::move(map);
    set_robot(s, request, kHandshake_ns);
    return s;
  }

  footbot::FootbotDriver& driver() noexcept override { return driver_; }
  void power_on() override { modules_.power_on(0); }
  void turn(hal::TimeNs now) override {
    driver_.pump(now);
    for (const CanFrame& f : std::exchange(bus_.to_robot, {}))
      modules_.receive({static_cast<std::uint16_t>(f.id), f.size, f.data}, now);
    modules_.run_until(now);
    sent_.clear();
    modules_.take_sent(sent_);
    for (const auto& [frame, at] : sent_)
      bus_.to_host.push_back({.id = frame.id, .size = frame.size, .data = frame.data, .at_ns = now});
  }

  SharedPorts ports_{footbot_emulator::body_ports()};
  footbot_emulator::PortBody body_{ports_};
  footbot_emulator::Footbot modules_;
  Bus bus_;
  aseba::CanMessages messages_{std::make_unique<HostEnd>(bus_), {}, [this] { return now_ns(); }};
  footbot::FootbotDriver driver_;
  std::vector<footbot_emulator::TimedFrame> sent_;
};

}  // namespace

MadeWiredRobot make_wired_footbot(const WiredRequest& request) {
  if (const hal::Status good = WiredTime::check(request.tick_ns); !good.ok()) return good.error();
  if (request.what.empty())
    return hal::Error{"the link names no map of the foot-bot's variables; write emulated:footbot_map.xml"};
  auto map = footbot::footbot_map_for(request.robot, hal::path_beside(request.what, request.file));
  if (!map.ok()) return map.error();
  return std::unique_ptr<WiredRobot>(std::make_unique<WiredFootbot>(request, std::move(map).value()));
}

}  // namespace tandem::bridges::wired
