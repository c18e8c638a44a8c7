// Controllers that tests need: each does one plain thing.
#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <unistd.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/selector.hpp"
#include "hal/device/time_of_flight.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"
#include "tests/plugins/shown.hpp"

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

/// The same, and its copies have memory of their own.
class OwningDrive final : public Drive {
 public:
  OwningDrive(Robot& robot, const Params& params) : Drive(robot, params), says_(robot.actuator<RangeAndBearingSend>()) {
    says_.size = 1;
  }
  void step() override {
    Drive::step();
    said_.push_back(0);
    says_.payload[0] = static_cast<std::uint8_t>(said_.size());
  }

 private:
  RangeAndBearingSend& says_;
  std::vector<std::uint8_t> said_;
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

/// Drives, and forks a child that outlives the hub and keeps everything open that the hub has.
class Forker final : public Drive {
 public:
  using Drive::Drive;
  void step() override {
    Drive::step();
    if (forked_) return;
    forked_ = true;
    if (::fork() != 0) return;
    ::sleep(20);
    ::_exit(0);
  }

 private:
  bool forked_ = false;
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

struct FlyParams {
  std::array<double, 3> velocity_m_s{};
  double turn_rad_s = 0.0;
  void describe(ParamVisitor& v) {
    v.vector("velocity", velocity_m_s, unit::m_s, "Velocity to fly with.");
    v.number("turn", turn_rad_s, unit::rad_s, kAny, "Turn rate.");
  }
};

/// Flies with a constant velocity, looks around and talks. Throws at the step that it is told to.
class Fly : public Controller {
 public:
  struct Params : FlyParams {
    std::int64_t throw_at = -1;
    void describe(ParamVisitor& v) {
      FlyParams::describe(v);
      v.integer("throw_at", throw_at, kAny, "Step to throw at; negative: never.");
    }
  };
  Fly(Robot& robot, const Params& params)
      : speed_(robot.actuator<QuadrotorSpeed>()), talk_(robot.actuator<RangeAndBearingSend>()), params_(params) {
    robot.sensor<Proximity>();
    robot.sensor<RangeAndBearing>();
    robot.sensor<Positioning>();
    robot.sensor<Battery>();
    robot.sensor<Light>();
  }
  void step() override {
    if (steps_++ == params_.throw_at) throw std::runtime_error("lost my way");
    const auto& v = params_.velocity_m_s;
    speed_.set(v[0], v[1], v[2], params_.turn_rad_s);
    talk_.sending = true;
    talk_.size = 1;
    talk_.payload[0] = 42;
  }

 private:
  QuadrotorSpeed& speed_;
  RangeAndBearingSend& talk_;
  Params params_;
  std::int64_t steps_ = 0;
};

/// Flies around a square with its first corner where it takes off, then hovers over that corner.
class FlySquare final : public Controller {
 public:
  struct Params {
    double side_m = 2.0;
    double height_m = 1.5;
    void describe(ParamVisitor& v) {
      v.number("side", side_m, unit::m, kNotNegative, "Side of the square.");
      v.number("height", height_m, unit::m, kNotNegative, "Height to fly at.");
    }
  };
  FlySquare(Robot& robot, const Params& params)
      : target_(robot.actuator<QuadrotorPosition>()), place_(robot.sensor<Positioning>()), params_(params) {}
  void step() override {
    if (corner_ < 0) start_ = place_.p_WB;
    if (corner_ < 0 || (corner_ < 4 && near())) ++corner_;
    target_.set(goal(0), goal(1), params_.height_m, 0.0);
  }

 private:
  double goal(std::size_t axis) const {
    static constexpr int kCorners[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    return start_[axis] + params_.side_m * kCorners[corner_][axis];
  }
  bool near() const {
    const double dx = goal(0) - place_.p_WB[0];
    const double dy = goal(1) - place_.p_WB[1];
    const double dz = params_.height_m - place_.p_WB[2];
    return dx * dx + dy * dy + dz * dz < 0.05 * 0.05;
  }

  QuadrotorPosition& target_;
  const Positioning& place_;
  Params params_;
  std::array<double, 3> start_{};
  int corner_ = -1;
};

/// Takes both flight commands and one after the other: a place for ten steps, a velocity for ten, what is no number for
/// one of each, then much too fast.
class FlyBoth final : public Controller {
 public:
  explicit FlyBoth(Robot& robot)
      : speed_(robot.actuator<QuadrotorSpeed>()), target_(robot.actuator<QuadrotorPosition>()) {}
  void step() override {
    const int step = steps_++;
    if (step == 0) target_.set(1.0, 0.0, 1.0, 0.5);
    if (step == 10) target_.hover();
    if (step >= 10) speed_.set(0.0, 0.5, 0.0, 0.0);
    if (step == 20) speed_.velocity[1] = std::numeric_limits<double>::quiet_NaN();
    if (step == 21) target_.set(std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0);
    if (step == 22) speed_.set(0.0, 30.0, 40.0, 7.0);
  }

 private:
  QuadrotorSpeed& speed_;
  QuadrotorPosition& target_;
  int steps_ = 0;
};

/// Takes every device of an eye-bot and leaves the commands to the test.
class EyePuppet final : public Controller {
 public:
  explicit EyePuppet(Robot& robot) {
    robot.actuator<QuadrotorSpeed>();
    robot.actuator<FlightTask>();
    robot.actuator<QuadrotorPosition>();
    robot.actuator<QuadrotorAttitude>();
    robot.actuator<RingLeds>();
    robot.actuator<UpperRingLeds>();
    robot.actuator<CameraLed>();
    robot.actuator<PanTiltDrive>();
    robot.actuator<ScannerDrive>();
    robot.actuator<RangeAndBearingSend>();
    robot.sensor<FlightState>();
    robot.sensor<Altimeter>();
    robot.sensor<Positioning>();
    robot.sensor<PanTiltEncoder>();
    robot.sensor<PerspectiveCamera>();
    robot.sensor<DistanceScanner>();
    robot.sensor<RangeAndBearing>();
    robot.sensor<Proximity>();
    robot.sensor<Light>();
    robot.sensor<Battery>();
    robot.sensor<Accelerometer>();
    robot.sensor<Gyroscope>();
    robot.sensor<Clock>();
  }
  void step() override {}
};

/// Takes every device of a foot-bot and leaves the commands to the test.
class Puppet final : public Controller {
 public:
  explicit Puppet(Robot& robot) {
    robot.actuator<WheelSpeeds>();
    robot.actuator<RingLeds>();
    robot.actuator<RangeAndBearingSend>();
    robot.actuator<TurretDrive>();
    robot.actuator<GripperDrive>();
    robot.actuator<ScannerDrive>();
    robot.sensor<Proximity>();
    robot.sensor<Light>();
    robot.sensor<BaseGround>();
    robot.sensor<MotorGround>();
    robot.sensor<WheelEncoders>();
    robot.sensor<Odometry>();
    robot.sensor<Accelerometer>();
    robot.sensor<Gyroscope>();
    robot.sensor<Battery>();
    robot.sensor<Clock>();
    robot.sensor<RangeAndBearing>();
    robot.sensor<Positioning>();
    robot.sensor<TurretEncoder>();
    robot.sensor<Gripper>();
    robot.sensor<DistanceScanner>();
  }
  void step() override {}
};

/// Takes what an e-puck2 has and an e-puck has not, and the wheels, and leaves the commands to the test.
class Epuck2Puppet final : public Controller {
 public:
  explicit Epuck2Puppet(Robot& robot) {
    robot.actuator<WheelSpeeds>();
    robot.sensor<Gyroscope>();
    robot.sensor<TimeOfFlight>();
    robot.sensor<Cliff>();
    robot.sensor<Selector>();
  }
  void step() override {}
};

/// Takes a foot-bot's wheels and ring of sensors alone, and leaves the commands to the test.
class DrivenPuppet final : public Controller {
 public:
  explicit DrivenPuppet(Robot& robot) {
    robot.actuator<WheelSpeeds>();
    robot.sensor<Proximity>();
    robot.sensor<WheelEncoders>();
  }
  void step() override {}
};

/// Takes every camera and light that its robot has, and leaves the commands to the test.
class Watcher final : public Controller {
 public:
  explicit Watcher(Robot& robot) {
    const RobotKind& kind = robot.kind();
    if (kind.part<OmniCameraPart>() != nullptr) robot.sensor<OmnidirectionalCamera>();
    if (kind.part<CameraPart>() != nullptr) robot.sensor<PerspectiveCamera>();
    if (kind.drive() != nullptr) robot.actuator<WheelSpeeds>();
    if (kind.part<TurretPart>() != nullptr) robot.actuator<TurretDrive>();
    if (kind.flies()) robot.actuator<QuadrotorSpeed>();
    robot.actuator<RingLeds>();
    if (kind.part<BodyLedPart>() == nullptr) return;
    robot.actuator<BodyLed>();
    robot.actuator<FrontLed>();
  }
  void step() override {}
};

/// Cannot be made.
class Stillborn final : public Controller {
 public:
  explicit Stillborn(Robot&) { throw std::runtime_error("refuses to be made"); }
  void step() override {}
};

/// Keeps something that has no copy.
class Owner final : public Controller {
 public:
  explicit Owner(Robot& robot) : wheels_(robot.actuator<WheelSpeeds>()), steps_(std::make_unique<int>(0)) {}
  void step() override { wheels_.set(0.01 * (++*steps_ % 5), 0.02); }

 private:
  WheelSpeeds& wheels_;
  std::unique_ptr<int> steps_;
};

/// Shares with its copies what its steps change.
class Sharer final : public Controller {
 public:
  explicit Sharer(Robot& robot) : wheels_(robot.actuator<WheelSpeeds>()), steps_(std::make_shared<int>(0)) {}
  void step() override { wheels_.set(0.01 * (++*steps_ % 5), 0.02); }

 private:
  WheelSpeeds& wheels_;
  std::shared_ptr<int> steps_;
};

/// Owns memory, and says what of it its steps change.
class Rememberer final : public Controller {
 public:
  explicit Rememberer(Robot& robot) : wheels_(robot.actuator<WheelSpeeds>()) {}
  void step() override {
    speeds_.push_back(0.001 * static_cast<double>(speeds_.size() % 50));
    wheels_.set(speeds_.back(), 0.02);
  }
  void remember(Archive& archive) { archive(speeds_); }

 private:
  WheelSpeeds& wheels_;
  std::vector<double> speeds_;
};

/// Drives the left wheel by the number in its robot's id and, where it is on, the right one by its steps: one word
/// holds a parameter and what changes.
class Tagged final : public Controller {
 public:
  struct Params {
    bool on = false;
    void describe(ParamVisitor& v) { v.flag("on", on, "Drives the right wheel."); }
  };
  Tagged(Robot& robot, const Params& params) : wheels_(robot.actuator<WheelSpeeds>()), params_(params) {
    const std::string id(robot.id());
    number_ = std::stoi("0" + id.substr(std::min(id.size(), id.find_first_of("0123456789"))));
  }
  void step() override {
    ++steps_;
    wheels_.set(1e-4 * number_, params_.on ? 1e-4 * steps_ : 0.0);
  }

 private:
  WheelSpeeds& wheels_;
  int number_ = 0;
  Params params_;
  std::uint8_t steps_ = 0;
};

/// Throws when it is copied after its third step.
class Reluctant final : public Controller {
 public:
  explicit Reluctant(Robot&) {}
  Reluctant(const Reluctant& other) : steps_(other.steps_) {
    if (steps_ >= 3) throw std::runtime_error("I am unique");
  }
  void step() override { ++steps_; }

 private:
  int steps_ = 0;
};

/// Takes devices by its robot's id: "light…" also the light sensor, "refuse…" throws after having taken it.
class Picky final : public Controller {
 public:
  explicit Picky(Robot& robot) : wheels_(robot.actuator<WheelSpeeds>()) {
    if (robot.id().starts_with("light") || robot.id().starts_with("refuse")) light_ = &robot.sensor<Light>();
    if (robot.id().starts_with("refuse")) throw std::runtime_error("refuses to be made");
  }
  void step() override { wheels_.set(light_ != nullptr ? 0.05 * static_cast<double>(light_->level[0]) : 0.0, 0.01); }

 private:
  WheelSpeeds& wheels_;
  const Light* light_ = nullptr;
};

void register_all(Registrar& registrar) {
  registrar.add_controller<Drive>("drive", "Constant wheel speeds.");
  registrar.add_controller<CountingDrive>("counting_drive", "Constant wheel speeds; says how often it has stepped.");
  registrar.add_controller<OwningDrive>("owning_drive", "The same; owns memory.");
  registrar.add_controller<Everything>("everything", "Takes every device.");
  registrar.add_controller<Forker>("forker", "Forks a child.");
  registrar.add_controller<Thrower>("thrower", "Throws at tick 3.");
  registrar.add_controller<Careless>("careless", "Commands what is no number.");
  registrar.add_controller<Fly>("fly", "Constant velocity in the air.");
  registrar.add_controller<FlySquare>("fly_square", "Once around a square.");
  registrar.add_controller<FlyBoth>("fly_both", "A place, a velocity, and what is no number.");
  registrar.add_controller<EyePuppet>("eye_puppet", "Takes every device of an eye-bot.");
  registrar.add_controller<Puppet>("puppet", "Takes every device of a foot-bot.");
  registrar.add_controller<Epuck2Puppet>("epuck2_puppet", "Takes what an e-puck2 alone has.");
  registrar.add_controller<DrivenPuppet>("driven_puppet", "Takes a foot-bot's wheels and proximity sensors.");
  registrar.add_controller<Watcher>("watcher", "Takes cameras and lights.");
  registrar.add_controller<Owner>("owner", "Cannot be copied.");
  registrar.add_controller<Sharer>("sharer", "Shares with its copies what its steps change.");
  registrar.add_controller<Rememberer>("rememberer", "Says what it remembers.");
  registrar.add_controller<Tagged>("tagged", "Drives by its id and its steps.");
  registrar.add_controller<Reluctant>("reluctant", "Throws when it is copied after its third step.");
  registrar.add_controller<Picky>("picky", "Takes devices by its robot's id.");
  registrar.add_controller<Stillborn>("stillborn", "Throws when made.");
  registrar.add_controller<tandem::test::Shown>("shown", "Uses all that a robot offers beside its devices.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
