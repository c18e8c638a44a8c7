// Two controllers.
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem::hal;

struct Forward final : Controller {
  explicit Forward(Robot& robot) : wheels(robot.actuator<WheelSpeeds>()) {}
  void step() override { wheels.set(0.05, 0.05); }
  WheelSpeeds& wheels;
};

struct Spin final : Controller {
  explicit Spin(Robot& robot) : wheels(robot.actuator<WheelSpeeds>()) {}
  void step() override { wheels.set(-0.05, 0.05); }
  WheelSpeeds& wheels;
};

void register_all(Registrar& registrar) {
  registrar.add_controller<Forward>("forward", "Drives straight.");
  registrar.add_controller<Spin>("spin", "Turns on the spot.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
