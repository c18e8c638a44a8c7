// A plug-in that brings a real robot: a kind, its bridge, and what stops it when its hub is gone. The robot is a file:
// a line for all that it was told, and by whom.
#include <chrono>
#include <fcntl.h>
#include <memory>
#include <thread>
#include <unistd.h>

#include "bridges/bridge_type.hpp"
#include "bridges/bridged_robot.hpp"
#include "bridges/guardian/stopper.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"
#include "hal/robot/epuck.hpp"

#ifdef TANDEM_TEST_THREADED
/// A thread that starts while the library is loaded.
static std::jthread early([](const std::stop_token& stop) {
  while (!stop.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
});
#endif

namespace {

using namespace tandem;

constexpr std::string_view kKind = "crawler";
constexpr std::string_view kScheme = "file:";

/// An e-puck's body under another name.
const hal::RobotKind& crawler() {
  static const hal::RobotKind kind = [] {
    hal::RobotKind s = hal::epuck::kind();
    s.name = kKind;
    return s;
  }();
  return kind;
}

std::string path_of(const std::string& link) {
  return link.substr(kScheme.size());
}

void tell(const std::string& link, const std::string& what) {
  const int fd = ::open(path_of(link).c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
  const std::string line = what + "\n";
  if (fd >= 0) (void)!::write(fd, line.data(), line.size());
  if (fd >= 0) ::close(fd);
}

/// Has no thread: a file answers at once.
class CrawlerBridge final : public bridges::RobotBridge {
 public:
  explicit CrawlerBridge(const bridges::BridgeRequest& request)
      : request_(request), robot_(kKind, crawler(), settings_of(request), types()) {}
  ~CrawlerBridge() override { CrawlerBridge::shut_down(); }
  CrawlerBridge(const CrawlerBridge&) = delete;
  CrawlerBridge& operator=(const CrawlerBridge&) = delete;

  hal::Robot& robot() noexcept override { return robot_; }
  void* port(const hal::PortType& type) noexcept override { return robot_.find(type); }
  std::vector<bridges::PortView> taken() const override { return robot_.taken(); }
  void set_origin(hal::TimeNs origin_ns) noexcept override { robot_.set_origin(origin_ns); }
  void start() override { started_ = true; }
  void shut_down() override {
    if (started_) stop(0);
    started_ = false;
  }
  void latch(hal::Tick /*tick*/, hal::TimeNs now) noexcept override {
    const double s = latched_ns_ == 0 || !moves_ ? 0.0 : hal::to_seconds(now - latched_ns_);
    latched_ns_ = now;
    auto& encoders = robot_.port<hal::WheelEncoders>();
    encoders.left_m += s * robot_.port<hal::WheelSpeeds>().left_m_s;
    encoders.right_m += s * robot_.port<hal::WheelSpeeds>().right_m_s;
    robot_.stamp(encoders, now, request_.tick_ns, now);
  }
  void commit(hal::TimeNs /*now*/) noexcept override {
    if (!started_ || stopped_) return;
    const auto& wheels = robot_.port<hal::WheelSpeeds>();
    const bool moves = wheels.left_m_s != 0.0 || wheels.right_m_s != 0.0;
    if (moves != moves_ && request_.permit.granted()) tell(request_.link, moves ? "drive" : "stand");
    moves_ = moves;
  }
  void stop(hal::TimeNs /*now*/) noexcept override {
    if (!stopped_ && request_.permit.granted()) tell(request_.link, "stopped by its hub");
    stopped_ = true;
    moves_ = false;
  }
  void resume() noexcept override { stopped_ = false; }
  bridges::LinkHealth health() const noexcept override {
    return started_ ? bridges::LinkHealth::Active : bridges::LinkHealth::Connecting;
  }
  bool at_rest() const noexcept override { return stopped_; }
  std::string trouble() const override { return ""; }
  std::string advice() const override { return "is the disk full?"; }
  bridges::RobotIdentity identity() const override {
    return {.link = request_.link, .device = path_of(request_.link), .session = 1};
  }
  bridges::StopMessages stop_messages() const override {
    return {.robot = request_.robot,
            .kind = std::string(kKind),
            .link = request_.link,
            .body = "stand",
            .version = 1,
            .identity = identity()};
  }
  std::uint64_t stop_version() const noexcept override { return 1; }
  bridges::LinkReport report() const override { return {}; }
  void describe(bridges::StatusVisitor& visitor) const override { visitor.text("state", "a file"); }

 private:
  static bridges::RobotSettings settings_of(const bridges::BridgeRequest& request) {
    bridges::RobotSettings settings;
    settings.id = request.robot;
    settings.seed = request.seed;
    settings.tick_ns = request.tick_ns;
    settings.actuators = request.actuators;
    return settings;
  }
  static std::span<const hal::PortType* const> types() {
    static const std::vector<const hal::PortType*> all = bridges::port_types_of<hal::WheelSpeeds, hal::WheelEncoders>();
    return all;
  }

  bridges::BridgeRequest request_;
  bridges::BridgedRobot robot_;
  hal::TimeNs latched_ns_ = 0;
  bool started_ = false, stopped_ = false, moves_ = false;
};

/// Runs in the guardian process.
class CrawlerStopper final : public bridges::guardian::Stopper {
 public:
  explicit CrawlerStopper(bridges::StopMessages messages) : messages_(std::move(messages)) {}
  bridges::guardian::StopState step(hal::TimeNs /*now*/) override {
    if (!told_) tell(messages_.link, "told to " + messages_.body + " by its guardian");
    told_ = true;
    return bridges::guardian::StopState::Confirmed;
  }
  std::string trouble() const override { return "the file cannot be written"; }

 private:
  bridges::StopMessages messages_;
  bool told_ = false;
};

hal::Status check(const bridges::BridgeRequest& request) {
  if (request.link.starts_with(std::string(kScheme) + "/")) return {};
  return hal::Error{"a crawler's link is file:/PATH, not '" + request.link + "'"};
}

const bridges::BridgeType kBridge{
    .name = kKind,
    .summary = "file:/PATH",
    .make = [](const bridges::BridgeRequest& request, const hal::Log&) -> bridges::MadeBridge {
      if (const hal::Status good = check(request); !good.ok()) return good.error();
      return std::unique_ptr<bridges::RobotBridge>(std::make_unique<CrawlerBridge>(request));
    },
    .check = &check};

const bridges::guardian::StopperType kStopper{
    kKind,
    [](const bridges::StopMessages& messages, bridges::guardian::StopCause)
        -> std::unique_ptr<bridges::guardian::Stopper> { return std::make_unique<CrawlerStopper>(messages); }};

void register_all(hal::Registrar& registrar) {
  registrar.add(crawler());
  registrar.add(kBridge);
  registrar.add(kStopper);
}

}  // namespace

TANDEM_PLUGIN(register_all)
