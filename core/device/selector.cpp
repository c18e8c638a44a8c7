// Selector: stands where the robot's element says.
#include "hal/device/selector.hpp"

#include "core/device/types.hpp"

namespace tandem::core {
namespace {

class SelectorSensor final : public Sensor {
 public:
  explicit SelectorSensor(std::uint32_t position) : position_(position) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* selectors = static_cast<hal::Selector*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      stamp(context, selectors[i]);
      selectors[i].position = position_;
    }
  }

 private:
  std::uint32_t position_;
};

BlockFactory<Sensor> make_selector(const Element& element, Problems& problems, const DeviceSetup& setup) {
  (void)read_options<NoOptions>(element, problems);
  const auto position = static_cast<std::uint32_t>(setup.kind.part<hal::SelectorPart>()->position);
  return [position](const BlockColumns&) { return std::make_unique<SelectorSensor>(position); };
}

}  // namespace

std::vector<DeviceType> selector_types() {
  std::vector<DeviceType> types;
  for (const std::string_view implementation : {"default", "ideal"}) {
    types.push_back(sensor_type(hal::Selector::kName, implementation, "Stands where the robot's element says.",
                                &has<hal::SelectorPart>, &make_selector, &describe_options<NoOptions>));
  }
  return types;
}

}  // namespace tandem::core
