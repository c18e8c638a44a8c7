// Buttons and speakers: nobody presses the ones of simulated robots, and nobody hears the others.
#include "hal/device/buttons.hpp"

#include "core/device/each_robot.hpp"
#include "core/device/types.hpp"
#include "hal/device/speaker.hpp"

namespace tandem::core {
namespace {

class ButtonSensor final : public EachSensor<ButtonSensor, hal::Buttons, NoOptions> {
 public:
  using Part = hal::ButtonsPart;

  ButtonSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachSensor(setup, errors, columns), count_(static_cast<std::uint32_t>(setup.kind.part<Part>()->count)) {}

  void read(const RobotAt&, hal::Buttons& port) const noexcept {
    port.count = count_;
    port.pressed = {};
  }

 private:
  std::uint32_t count_;
};

/// What is commanded stays in the port, for hooks and views.
class SilentSpeaker final : public Actuator {
 public:
  using Port = hal::Speaker;
  using Part = hal::SpeakerPart;
  using Errors = NoOptions;
  SilentSpeaker(const DeviceSetup&, const Errors&, const BlockColumns&) {}

  void act(const DeviceContext& /*context*/, SpaceStores& /*stores*/, const void* /*ports*/) noexcept override {}
};

}  // namespace

std::vector<DeviceType> button_types() {
  return {device_type<ButtonSensor, Level::Default>("default", "Nobody presses them."),
          device_type<ButtonSensor, Level::Ideal>("ideal", "Nobody presses them."),
          device_type<SilentSpeaker, Level::Default>("default", "Nobody hears it."),
          device_type<SilentSpeaker, Level::Ideal>("ideal", "Nobody hears it.")};
}

}  // namespace tandem::core
