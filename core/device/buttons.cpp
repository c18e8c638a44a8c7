// Buttons and speakers: nobody presses the ones of simulated robots, and nobody hears the others.
#include "hal/device/buttons.hpp"

#include "core/device/types.hpp"
#include "hal/device/speaker.hpp"

namespace tandem::core {
namespace {

class ButtonSensor final : public Sensor {
 public:
  explicit ButtonSensor(std::uint32_t count) : count_(count) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* buttons = static_cast<hal::Buttons*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      stamp(context, buttons[i]);
      buttons[i].count = count_;
      buttons[i].pressed = {};
    }
  }

 private:
  std::uint32_t count_;
};

/// What is commanded stays in the port, for hooks and views.
class SilentSpeaker final : public Actuator {
 public:
  void act(const DeviceContext& /*context*/, SpaceStores& /*stores*/, const void* /*ports*/) noexcept override {}
};

BlockFactory<Sensor> make_buttons(const Element& element, Problems& problems, const DeviceSetup& setup) {
  (void)read_options<NoOptions>(element, problems);
  const auto count = static_cast<std::uint32_t>(setup.kind.part<hal::ButtonsPart>()->count);
  return [count](const BlockColumns&) { return std::make_unique<ButtonSensor>(count); };
}

BlockFactory<Actuator> make_speaker(const Element& element, Problems& problems, const DeviceSetup& /*setup*/) {
  (void)read_options<NoOptions>(element, problems);
  return [](const BlockColumns&) { return std::make_unique<SilentSpeaker>(); };
}

}  // namespace

std::vector<DeviceType> button_types() {
  std::vector<DeviceType> types;
  for (const std::string_view implementation : {"default", "ideal"}) {
    types.push_back(sensor_type(hal::Buttons::kName, implementation, "Nobody presses them.", &has<hal::ButtonsPart>,
                                &make_buttons, &describe_options<NoOptions>));
  }
  for (const std::string_view implementation : {"default", "ideal"}) {
    types.push_back(actuator_type(hal::Speaker::kName, implementation, "Nobody hears it.", &has<hal::SpeakerPart>,
                                  &make_speaker, &describe_options<NoOptions>));
  }
  return types;
}

}  // namespace tandem::core
