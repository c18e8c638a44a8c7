// The robot, a controller for it, and the plug-in.
#include "buggy.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"

namespace buggy {
namespace {

using namespace tandem;

/// Drives circles. Does not know whether its robot is real.
class Patrol final : public hal::Controller {
 public:
  explicit Patrol(hal::Robot& robot)
      : encoders_(robot.sensor<hal::WheelEncoders>()), wheels_(robot.actuator<hal::WheelSpeeds>()) {
    robot.publish("rolled", rolled_m_);
  }
  void step() override {
    rolled_m_ = 0.5 * (encoders_.left_m + encoders_.right_m);
    wheels_.set(0.1, 0.14);
  }

 private:
  const hal::WheelEncoders& encoders_;
  hal::WheelSpeeds& wheels_;
  double rolled_m_ = 0.0;
};

/// Leaves the wheels to an emulator, whose body the simulated robot then is.
class Puppet final : public hal::Controller {
 public:
  explicit Puppet(hal::Robot& robot) {
    robot.sensor<hal::WheelEncoders>();
    robot.actuator<hal::WheelSpeeds>();
  }
  void step() override {}
};

void register_all(hal::Registrar& registrar) {
  registrar.add(kind());
  registrar.add_controller<Puppet>("buggy_puppet", "The body of an emulator.");
  registrar.add_controller<Patrol>("patrol", "Drives circles.");
  register_bridge(registrar);
  register_emulator(registrar);
}

}  // namespace

const hal::RobotKind& kind() {
  static const hal::RobotKind made = [] {
    hal::RobotKind kind;
    kind.name = kName;
    kind.summary = "A toy robot on two wheels.";
    kind.body = {.radius_m = 0.08, .height_m = 0.1, .mass_kg = 0.4, .source = "measured"};
    kind.locomotion = hal::DifferentialDrive{.wheel_radius_m = 0.03,
                                             .wheel_base_m = 0.12,
                                             .max_speed_m_s = 0.3,
                                             .force_N = 2.0,
                                             .torque_Nm = 0.1,
                                             .source = "measured"};
    return kind;
  }();
  return made;
}

}  // namespace buggy

TANDEM_PLUGIN(buggy::register_all)
