#include "bridges/wired/wired_footbot.hpp"

#include "bridges/aseba/can_messages.hpp"
#include "bridges/can/memory_bus.hpp"
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
    CanFrame in;
    while (robots_end_->receive(in)) modules_.receive({static_cast<std::uint16_t>(in.id), in.size, in.data}, now);
    modules_.run_until(now);
    sent_.clear();
    modules_.take_sent(sent_);
    for (const footbot_emulator::TimedFrame& f : sent_)
      (void)robots_end_->send(make_frame(f.frame.id, std::span(f.frame.data).first(f.frame.size)));
  }

  MemoryBus bus_{[this] { return now_ns(); }};
  std::unique_ptr<CanLink> robots_end_ = bus_.attach();
  SharedPorts ports_{footbot_emulator::body_ports()};
  footbot_emulator::PortBody body_{ports_};
  footbot_emulator::Footbot modules_;
  aseba::CanMessages messages_{bus_.attach(), {}, [this] { return now_ns(); }};
  footbot::FootbotDriver driver_;
  std::vector<footbot_emulator::TimedFrame> sent_;
};

}  // namespace

MadeWiredRobot make_wired_footbot(const WiredRequest& request) {
  if (const hal::Status good = WiredTime::check(request.tick_ns); !good.ok()) return good.error();
  if (request.what.empty())
    return hal::Error{"the link names no map of the foot-bot's variables; write emulated:footbot_map.xml"};
  hal::Problems problems;
  auto map = footbot::read_footbot_map(hal::path_beside(request.what, request.file), problems);
  if (map) return std::unique_ptr<WiredRobot>(std::make_unique<WiredFootbot>(request, std::move(*map)));
  std::string message = "the map of the foot-bot '" + request.robot + "' cannot be used";
  for (const hal::Problem& p : problems) message += "\n" + to_text(p);
  return hal::Error{message};
}

}  // namespace tandem::bridges::wired
