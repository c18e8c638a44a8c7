// A real robot for tests: a body that drives as it was last told, behind a link that the test cuts and mends.
#pragma once
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/spec/epuck.hpp"
#include "mixed_reality/tracking/odometry.hpp"
#include "mixed_reality/twin/real_robot.hpp"

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
  LinkHealth health_when_up = LinkHealth::Active;
  hal::TimeNs moved_to_ns = 0;

  void move_to(hal::TimeNs now_ns) {
    const double dt_s = hal::to_seconds(now_ns - moved_to_ns);
    moved_to_ns = now_ns;
    left_m += wheels.left_m_s * dt_s;
    right_m += wheels.right_m_s * dt_s;
    pose = rolled(pose, wheels.left_m_s * dt_s, wheels.right_m_s * dt_s, hal::epuck::kWheelBase_m);
  }
  bool stands() const { return wheels.left_m_s == 0.0 && wheels.right_m_s == 0.0; }
};

/// What a commit asks for is there at the next latch, stamped with the time of the commit.
class FakeRobot final : public RealRobot {
 public:
  explicit FakeRobot(FakeBody& body) : body_(body) {
    proximity_.count = 8;
    proximity_.range_m = 0.1F;
  }

  void latch(const Moment& now) noexcept override {
    if (first_) body_.moved_to_ns = now.monotonic_ns;
    first_ = false;
    body_.move_to(now.monotonic_ns);
    health_ = body_.link_up ? body_.health_when_up : LinkHealth::Lost;
    if (!sampled_) return;
    encoders_ = sample_;
    encoders_.taken_ns = now.to_run(sampled_at_ns_);
    encoders_.validity = hal::Validity::Fresh;
    proximity_.distance_m.fill(static_cast<float>(body_.real_proximity_m));
    proximity_.taken_ns = encoders_.taken_ns;
    proximity_.validity = body_.link_up ? hal::Validity::Fresh : hal::Validity::Stale;
  }
  LinkHealth health() const noexcept override { return health_; }
  std::string trouble() const override { return body_.link_up ? "" : "cable out"; }

  const void* reading(const hal::PortType& type) const noexcept override {
    if (type.layout == hal::port_type<hal::WheelEncoders>().layout) return &encoders_;
    if (type.layout == hal::port_type<hal::Proximity>().layout) return &proximity_;
    return nullptr;
  }
  bool command(const hal::PortType& type, const void* port) noexcept override {
    if (type.layout == hal::port_type<hal::WheelSpeeds>().layout)
      return std::memcpy(&wheels_, port, type.size) != nullptr;
    if (type.layout == hal::port_type<hal::RingLeds>().layout) return std::memcpy(&leds_, port, type.size) != nullptr;
    return false;
  }
  void commit(const Moment& now) noexcept override {
    if (!body_.link_up) return;
    body_.move_to(now.monotonic_ns);
    body_.wheels = wheels_;
    body_.leds = leds_;
    body_.received.push_back({now.monotonic_ns, wheels_});
    sample_.left_m = body_.left_m;
    sample_.right_m = body_.right_m;
    sampled_at_ns_ = now.monotonic_ns;
    sampled_ = true;
  }
  void stop(const Moment& now) noexcept override {
    ++stops;
    wheels_ = {};
    commit(now);
  }
  bool stopped() const noexcept override { return stops > 0 && body_.link_up && body_.confirms_stops; }
  LinkReport report() const override { return {.packets = body_.received.size()}; }

  int stops = 0;

 private:
  FakeBody& body_;
  bool first_ = true;
  bool sampled_ = false;
  hal::TimeNs sampled_at_ns_ = 0;
  LinkHealth health_ = LinkHealth::Connecting;
  hal::WheelEncoders encoders_, sample_;
  hal::Proximity proximity_;
  hal::WheelSpeeds wheels_;
  hal::RingLeds leds_;
};

}  // namespace tandem::mixed_reality
