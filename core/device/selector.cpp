// Selector: stands where the robot's element says.
#include "hal/device/selector.hpp"

#include "core/device/each_robot.hpp"
#include "core/device/types.hpp"

namespace tandem::core {
namespace {

class SelectorSensor final : public EachSensor<SelectorSensor, hal::Selector, NoOptions> {
 public:
  using Part = hal::SelectorPart;

  SelectorSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachSensor(setup, errors, columns), position_(static_cast<std::uint32_t>(setup.kind.part<Part>()->position)) {}

  void read(const RobotAt&, hal::Selector& port) const noexcept { port.position = position_; }

 private:
  std::uint32_t position_;
};

}  // namespace

std::vector<DeviceType> selector_types() {
  constexpr std::string_view kSummary = "Stands where the robot's element says.";
  return {device_type<SelectorSensor, Level::Default>("default", kSummary),
          device_type<SelectorSensor, Level::Ideal>("ideal", kSummary)};
}

}  // namespace tandem::core
