// A foot-bot that is driven by hand, over the network.
#pragma once
#include <memory>
#include <string>

#include "controllers/footbot_manual/datagrams.hpp"
#include "controllers/footbot_manual/order.hpp"
#include "hal/controller.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// Does what datagrams say that come to a UDP port: each holds an order, or one a line (see `Order`). Orders are
/// obeyed in the order of arrival, from the next tick on. When none has come for a while, wheels and a turret that was
/// ordered to turn stop, so that a viewer that dies leaves no robot driving: drivers repeat the order. Claws stay as
/// they are, not to drop what they hold, and so does a turret that was told where to look.
///
/// What is not understood, or needs a device that the configuration does not list, is answered with `error: …`; what is
/// understood with nothing. Who may send is who reaches the port: on this machine alone unless `address` says more.
/// Orders come from outside of the run: the same seed gives the same run only where the same orders come in the same
/// ticks.
class FootbotManual final : public hal::Controller {
 public:
  struct Params {
    std::int64_t port = 5005;
    std::string address = "127.0.0.1";
    double silence_s = 0.5;
    void describe(hal::ParamVisitor& v) {
      v.integer("port", port, {1, 65535}, "UDP port that orders come to; each robot needs its own.");
      v.text("address", address,
             "IPv4 address to listen at: 127.0.0.1 this machine alone, 0.0.0.0 the network as well.");
      v.number("silence", silence_s, hal::unit::s, {0.01, 3600.0}, "When nothing has come for so long it stops.");
    }
  };

  /// Takes the wheels and the clock, and gripper and turret where they are listed.
  /// @throws std::runtime_error when the port cannot be had
  FootbotManual(hal::Robot& robot, const Params& params);

  void step() override;

 private:
  void obey(std::string_view line);
  hal::Status carry_out(const Order& order);
  void drive(const Drive& order) noexcept;
  hal::Status turn_turret(const Order& order) noexcept;

  const hal::Clock& clock_;
  hal::WheelSpeeds& wheels_;
  hal::TurretDrive* turret_ = nullptr;    // null: not listed
  hal::GripperDrive* gripper_ = nullptr;  // null: not listed
  double wheel_base_m_;
  double fastest_m_s_;
  hal::TimeNs silence_ns_;
  hal::TimeNs heard_ns_;                  // when the last order came
  std::shared_ptr<Datagrams> datagrams_;  // shared by copies: the robot has one port, and copies never step together
};

}  // namespace tandem::controllers
