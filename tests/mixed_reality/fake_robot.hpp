// A real robot for tests: a body that drives as it was last told, behind a link that the test cuts and mends.
#pragma once
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "mixed_reality/safety/supervisor.hpp"
#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {

/// The robot itself, which outlives its bridge. As an e-puck, it has no watchdog.
struct FakeBody {
  struct Received {
    hal::TimeNs at_ns;
    hal::WheelSpeeds wheels;
  };

  core::Pose pose;
  double left_m = 0.0, right_m = 0.0;  ///< rolled
  hal::WheelSpeeds wheels;             ///< as last received
  hal::RingLeds leds;
  double real_proximity_m = 0.1;  ///< what all of its sensors see
  std::vector<Received> received;
  bool link_up = true;
  bool confirms_stops = true;
  bool stopped_itself = false;
  bool tells_place = false;  ///< it measures where it is
  bool held_fast = false;    ///< its wheels turn, and it does not move
  hal::TimeNs delay_ns = 0;  ///< from a command to its wheels
  LinkHealth health_when_up = LinkHealth::Active;
  std::string name = "fake";  ///< as it calls itself
  std::uint64_t session = 1;  ///< grows when its device is opened anew
  hal::TimeNs moved_to_ns = 0;

  void obey(hal::TimeNs now_ns, const hal::WheelSpeeds& told) {
    if (delay_ns == 0)
      wheels = told;
    else
      delayed_.push_back({now_ns + delay_ns, told});
  }
  void move_to(hal::TimeNs now_ns) {
    while (!delayed_.empty() && delayed_.front().at_ns <= now_ns) {
      roll_to(delayed_.front().at_ns);
      wheels = delayed_.front().wheels;
      delayed_.pop_front();
    }
    roll_to(now_ns);
  }
  void roll_to(hal::TimeNs now_ns) {
    const double dt_s = hal::to_seconds(now_ns - moved_to_ns);
    moved_to_ns = now_ns;
    const double left = turned_m_s(wheels.left_m_s) * dt_s, right = turned_m_s(wheels.right_m_s) * dt_s;
    left_m += left;
    right_m += right;
    if (!held_fast) pose = rolled(pose, left, right, hal::epuck::kind().drive()->wheel_base_m);
  }
  /// As an e-puck's stepper motors turn [GCtronic's library, e_motors.c].
  static double turned_m_s(double told_m_s) {
    const double step_m = M_PI * 0.041 / 1000.0;
    const long steps_s = std::lround(told_m_s / step_m);
    return steps_s == 0 ? 0.0
                        : std::copysign(10000.0 / static_cast<double>(10000 / std::labs(steps_s)) * step_m, told_m_s);
  }
  bool stands() const { return wheels.left_m_s == 0.0 && wheels.right_m_s == 0.0; }

 private:
  std::deque<Received> delayed_;  // by when they are obeyed
};

/// What a commit asks for is there at the next latch, stamped with the time of the commit.
class FakeRobot final : public bridges::RobotBridge, private hal::Robot {
 public:
  explicit FakeRobot(FakeBody& body) : body_(body) {
    proximity_.count = 8;
    proximity_.range_m = 0.1F;
  }

  hal::Robot& robot() noexcept override { return *this; }
  void* port(const hal::PortType& type) noexcept override {
    void* const data = memory(type);
    if (data != nullptr && std::none_of(taken_.begin(), taken_.end(), [&](const auto& p) { return p.data == data; }))
      taken_.push_back({&type, data});
    return data;
  }
  void* memory(const hal::PortType& type) noexcept {
    if (type.layout == hal::port_type<hal::WheelEncoders>().layout) return &encoders_;
    if (type.layout == hal::port_type<hal::Proximity>().layout) return &proximity_;
    if (type.layout == hal::port_type<hal::WheelSpeeds>().layout) return &wheels_;
    if (type.layout == hal::port_type<hal::RingLeds>().layout) return &leds_;
    if (body_.tells_place && type.layout == hal::port_type<hal::Positioning>().layout) return &place_;
    return nullptr;
  }
  std::vector<bridges::PortView> taken() const override { return taken_; }
  void set_origin(hal::TimeNs origin_ns) noexcept override { origin_ns_ = origin_ns; }
  void start() override { ++starts; }
  void shut_down() override { ++ends; }

  void latch(hal::Tick, hal::TimeNs now) noexcept override {
    if (first_) body_.moved_to_ns = now;
    first_ = false;
    body_.move_to(now);
    health_ = body_.link_up ? body_.health_when_up : LinkHealth::Lost;
    if (!sampled_) return;
    encoders_ = sample_;
    encoders_.taken_ns = sampled_at_ns_ - origin_ns_;
    encoders_.validity = body_.link_up ? hal::Validity::Fresh : hal::Validity::Stale;
    proximity_.distance_m.fill(static_cast<float>(body_.real_proximity_m));
    proximity_.taken_ns = encoders_.taken_ns;
    proximity_.validity = body_.link_up ? hal::Validity::Fresh : hal::Validity::Stale;
    place_ = place_sample_;
    place_.taken_ns = encoders_.taken_ns;
    place_.validity = hal::Validity::Fresh;
  }
  LinkHealth health() const noexcept override { return health_; }
  bool stopped_itself() const noexcept override { return body_.stopped_itself; }
  std::string trouble() const override { return body_.link_up ? "" : "cable out"; }
  std::string advice() const override { return "is it switched on?"; }
  bridges::RobotIdentity identity() const override {
    return {.link = "fake", .device = "fake", .name = body_.name, .session = body_.session};
  }
  bridges::StopMessages stop_messages() const override {
    return {.robot = "fake", .kind = "fake", .link = "fake", .body = "", .version = 1};
  }
  std::uint64_t stop_version() const noexcept override { return body_.session; }

  void commit(hal::TimeNs now) noexcept override {
    if (!body_.link_up) return;
    body_.move_to(now);
    const hal::WheelSpeeds obeyed = stopped_ ? hal::WheelSpeeds{} : wheels_;
    body_.obey(now, obeyed);
    body_.leds = leds_;
    body_.received.push_back({now, obeyed});
    sample_.left_m = body_.left_m;
    sample_.right_m = body_.right_m;
    const double half_rad = 0.5 * body_.pose.heading_rad();
    place_sample_.p_WB = {body_.pose.x_m, body_.pose.y_m, body_.pose.z_m};
    place_sample_.q_WB = {std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
    sampled_at_ns_ = now;
    sampled_ = true;
  }
  void stop(hal::TimeNs now) noexcept override {
    ++stops;
    stopped_ = true;
    wheels_ = {};
    commit(now);
  }
  void resume() noexcept override { stopped_ = false; }
  bool at_rest() const noexcept override { return stops > 0 && body_.link_up && body_.confirms_stops; }
  bridges::LinkReport report() const override { return {.questions = body_.received.size()}; }
  void describe(bridges::StatusVisitor& visitor) const override { visitor.text("state", "fake"); }

  int starts = 0;
  int stops = 0;
  int ends = 0;

 private:
  std::string_view id() const noexcept override { return "fake"; }
  const hal::RobotKind& kind() const noexcept override { return hal::epuck::kind(); }
  std::uint64_t run_seed() const noexcept override { return 0; }
  void* take(const hal::PortType& type) override {
    void* data = port(type);
    if (data == nullptr) throw hal::DeviceError("a fake robot has no '" + std::string(type.name) + "'");
    return data;
  }

  FakeBody& body_;
  std::vector<bridges::PortView> taken_;
  hal::TimeNs origin_ns_ = 0;
  bool first_ = true;
  bool sampled_ = false;
  hal::TimeNs sampled_at_ns_ = 0;
  LinkHealth health_ = LinkHealth::Connecting;
  hal::WheelEncoders encoders_, sample_;
  hal::Proximity proximity_;
  hal::Positioning place_, place_sample_;
  hal::WheelSpeeds wheels_;
  hal::RingLeds leds_;
  bool stopped_ = false;
};

}  // namespace tandem::mixed_reality
