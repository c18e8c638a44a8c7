// The head that a camera hangs in: the actuator that turns it, and the encoder that tells where it looks.
#include "hal/device/pan_tilt.hpp"

#include "core/device/each_robot.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

constexpr ErrorText kAimErrors{"noise_std_dev", 10 * 1e-3, hal::unit::rad, hal::kNotNegative,
                               "Standard deviation of both angles that the head turns to, drawn every tick."};
using AimErrors = OneError<kAimErrors>;

/// Turns about both axes at once, pan the shorter way round.
class HeadActuator final : public EachActuator<HeadActuator, hal::PanTiltDrive, AimErrors, HeadState> {
 public:
  using Part = hal::HeadPart;

  HeadActuator(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachActuator(setup, errors, columns), part_(*setup.kind.part<Part>()) {}

  void obey(const RobotAt& robot, const hal::PanTiltDrive& told) const noexcept {
    if (led_from_outside(robot.context, robot.i)) return;
    const double most_rad = part_.turn_rad_s * robot.context.tick_s;
    hal::PanTiltDrive drive = obeys(robot.context, robot.i) ? told : hal::PanTiltDrive{};
    if (errors_.amount > 0.0) {
      const auto bits = robot.draw(Stream::HeadNoise);
      const auto error = to_normal(bits[0], bits[1]);
      drive.pan_rad += errors_.amount * error[0];
      drive.tilt_rad += errors_.amount * error[1];
    }
    HeadState& head = kept_[robot.i];
    const double tilt = std::clamp(drive.tilt_rad, -part_.max_tilt_rad, part_.max_tilt_rad);
    head.pan_rad =
        hal::wrapped(head.pan_rad + std::clamp(hal::wrapped(drive.pan_rad - head.pan_rad), -most_rad, most_rad));
    head.tilt_rad += std::clamp(tilt - head.tilt_rad, -most_rad, most_rad);
    head.laser = drive.laser;
  }

 private:
  const hal::HeadPart& part_;
};

// --- encoder ---

constexpr ErrorText kAngleNoise{"noise_range", 10 * 1e-3, hal::unit::rad, hal::kNotNegative,
                                "Uniform noise of +-this on both angles."};
using AngleNoise = OneError<kAngleNoise>;

class HeadEncoderSensor final : public EachSensor<HeadEncoderSensor, hal::PanTiltEncoder, AngleNoise, HeadState> {
 public:
  using Part = hal::HeadPart;
  using EachSensor::EachSensor;

  void read(const RobotAt& robot, hal::PanTiltEncoder& port) const noexcept {
    port.pan_rad = kept_[robot.i].pan_rad;
    port.tilt_rad = kept_[robot.i].tilt_rad;
    if (errors_.amount <= 0.0) return;
    const auto bits = robot.draw(Stream::HeadEncoderNoise);
    port.pan_rad = hal::wrapped(port.pan_rad + errors_.amount * to_symmetric(bits[0]));
    port.tilt_rad += errors_.amount * to_symmetric(bits[1]);
  }
};

}  // namespace

std::vector<DeviceType> pan_tilt_types() {
  std::vector<DeviceType> types;
  add_levels<HeadActuator>(types, "Turns as fast as it can; errors where asked for.", "Turns as fast as it can.",
                           "Turns to angles with an error every tick.");
  add_levels<HeadEncoderSensor>(types, "Both angles; noise where asked for.", "Both angles.",
                                "Both angles, with uniform noise.");
  return types;
}

}  // namespace tandem::core
