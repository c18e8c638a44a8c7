// Controllers that tests need: each does one plain thing.
#include <limits>
#include <stdexcept>

#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem::hal;

struct DriveParams {
  double left_m_s = 0.0, right_m_s = 0.0;
  void describe(ParamVisitor& v) {
    v.number("left", left_m_s, unit::m_s, kAny, "Speed of the left wheel.");
    v.number("right", right_m_s, unit::m_s, kAny, "Speed of the right wheel.");
  }
};

/// Drives with constant wheel speeds.
class Drive : public Controller {
 public:
  using Params = DriveParams;
  Drive(Robot& robot, const Params& params) : wheels_(robot.actuator<WheelSpeeds>()), params_(params) {}
  void step() override { wheels_.set(params_.left_m_s, params_.right_m_s); }

 private:
  WheelSpeeds& wheels_;
  Params params_;
};

/// Drives with constant wheel speeds, and says how often it has stepped: at most 255.
class CountingDrive final : public Drive {
 public:
  CountingDrive(Robot& robot, const Params& params)
      : Drive(robot, params), says_(robot.actuator<RangeAndBearingSend>()) {
    says_.size = 1;
  }
  void step() override {
    Drive::step();
    if (steps_ < 255) ++steps_;
    says_.payload[0] = steps_;
  }

 private:
  RangeAndBearingSend& says_;
  std::uint8_t steps_ = 0;
};

/// Takes every device of an e-puck, drives, shines and talks.
class Everything final : public Controller {
 public:
  using Params = DriveParams;
  Everything(Robot& robot, const Params& params)
      : wheels_(robot.actuator<WheelSpeeds>()),
        leds_(robot.actuator<RingLeds>()),
        talk_(robot.actuator<RangeAndBearingSend>()),
        heard_(robot.sensor<RangeAndBearing>()),
        clock_(robot.sensor<Clock>()),
        params_(params) {
    robot.sensor<Proximity>();
    robot.sensor<Light>();
    robot.sensor<Ground>();
    robot.sensor<WheelEncoders>();
    robot.sensor<Accelerometer>();
    robot.sensor<Microphones>();
    robot.sensor<Battery>();
    robot.actuator<BodyLed>().on = true;
    robot.actuator<FrontLed>();
  }
  void step() override {
    wheels_.set(params_.left_m_s, params_.right_m_s * (heard_.count % 2 == 0 ? 1.0 : 0.9));
    leds_.set(static_cast<std::size_t>(clock_.tick % 8), kRed);
    talk_.sending = true;
    talk_.size = 5;  // an e-puck's board sends two
    talk_.payload = {1, 2, 3, 4, 5};
  }

 private:
  WheelSpeeds& wheels_;
  RingLeds& leds_;
  RangeAndBearingSend& talk_;
  const RangeAndBearing& heard_;
  const Clock& clock_;
  Params params_;
};

/// Drives, and throws at tick 3.
class Thrower final : public Controller {
 public:
  explicit Thrower(Robot& robot) : wheels_(robot.actuator<WheelSpeeds>()) {}
  void step() override {
    wheels_.set(0.05, 0.05);
    if (steps_++ == 3) throw std::runtime_error("lost my way");
  }

 private:
  WheelSpeeds& wheels_;
  int steps_ = 0;
};

/// Writes what is no number, and at every fifth step far too much.
class Careless final : public Controller {
 public:
  explicit Careless(Robot& robot) : wheels_(robot.actuator<WheelSpeeds>()) {}
  void step() override {
    if (steps_++ % 5 == 4)
      wheels_.set(3.0, 1.5);
    else
      wheels_.set(std::numeric_limits<double>::quiet_NaN(), 0.1);
  }

 private:
  WheelSpeeds& wheels_;
  int steps_ = 0;
};

/// Cannot be made.
class Stillborn final : public Controller {
 public:
  explicit Stillborn(Robot&) { throw std::runtime_error("refuses to be made"); }
  void step() override {}
};

void register_all(Registrar& registrar) {
  registrar.add_controller<Drive>("drive", "Constant wheel speeds.");
  registrar.add_controller<CountingDrive>("counting_drive", "Constant wheel speeds; says how often it has stepped.");
  registrar.add_controller<Everything>("everything", "Takes every device.");
  registrar.add_controller<Thrower>("thrower", "Throws at tick 3.");
  registrar.add_controller<Careless>("careless", "Commands what is no number.");
  registrar.add_controller<Stillborn>("stillborn", "Throws when made.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
