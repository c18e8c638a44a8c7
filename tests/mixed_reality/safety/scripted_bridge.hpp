// A bridge whose robot is what the test says.
#pragma once
#include <string>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {

class ScriptedBridge final : public bridges::RobotBridge, private hal::Robot {
 public:
  hal::Robot& robot() noexcept override { return *this; }
  void* port(const hal::PortType& type) noexcept override {
    if (type.layout == hal::port_type<hal::WheelSpeeds>().layout) return &wheels;
    if (type.layout == hal::port_type<hal::WheelEncoders>().layout) return &encoders;
    if (type.layout == hal::port_type<hal::Battery>().layout) return &battery;
    return nullptr;
  }
  std::vector<bridges::PortView> taken() const override { return taken_; }
  void set_origin(hal::TimeNs origin) noexcept override { origin_ns = origin; }
  void start() override {}
  void shut_down() override {}
  void latch(hal::Tick, hal::TimeNs now) noexcept override {
    encoders.validity = answers ? hal::Validity::Fresh : hal::Validity::Absent;
    encoders.taken_ns = now - 10 * hal::kNsPerMs - origin_ns;
    battery.validity = hal::Validity::Fresh;
  }
  void commit(hal::TimeNs) noexcept override { sent = wheels; }
  void stop(hal::TimeNs) noexcept override {}
  void land(hal::TimeNs) noexcept override { landing = true; }
  void resume() noexcept override { landing = false; }
  bridges::LinkHealth health() const noexcept override { return link_health; }
  bool stopped_itself() const noexcept override { return restarted; }
  bool at_rest() const noexcept override { return true; }
  std::string trouble() const override { return {}; }
  std::string advice() const override { return {}; }
  bridges::RobotIdentity identity() const override { return who; }
  bridges::StopMessages stop_messages() const override { return {}; }
  std::uint64_t stop_version() const noexcept override { return version; }
  bridges::LinkReport report() const override { return {}; }
  void describe(bridges::StatusVisitor&) const override {}

  hal::WheelSpeeds wheels, sent;
  hal::WheelEncoders encoders;
  hal::Battery battery;
  bridges::LinkHealth link_health = bridges::LinkHealth::Active;
  bool answers = true, restarted = false, landing = false;
  hal::TimeNs origin_ns = 0;
  bridges::RobotIdentity who = {.link = "fake", .device = "fake", .session = 1};
  std::uint64_t version = 0;  ///< to be raised with every change of `who`

 private:
  std::string_view id() const noexcept override { return "ep0"; }
  const hal::RobotKind& kind() const noexcept override { return kind_; }
  std::uint64_t run_seed() const noexcept override { return 0; }
  void* take(const hal::PortType& type) override {
    void* data = port(type);
    if (data == nullptr) throw hal::DeviceError("there is no " + std::string(type.name));
    taken_.push_back({&type, data});
    return data;
  }
  hal::RobotKind kind_;
  std::vector<bridges::PortView> taken_;
};

}  // namespace tandem::mixed_reality
