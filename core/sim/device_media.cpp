#include "core/sim/device_media.hpp"

#include "core/device/device.hpp"

namespace tandem::core {
namespace {

/// Hands on what the medium says and the device leaves open.
void inherit(const MediumConfig& medium, const DeviceType& type, Element& options) {
  Element known;
  ElementWriter writer(known);
  type.describe(writer);
  for (const Element::Attribute& option : known.attributes) {
    const std::string* said = medium.options.attribute(option.name);
    if (said != nullptr && options.attribute(option.name) == nullptr)
      options.attributes.push_back({option.name, *said, medium.line});
  }
}

}  // namespace

void name_media(Scenario& scenario, const hal::Catalog& catalog, Problems& problems) {
  const auto name_one = [&](DeviceChoice& choice, hal::Role role) {
    const DeviceType* type = find_device(catalog, choice.device, role, choice.implementation);
    const std::string* wanted = choice.options.attribute("medium");
    if (type == nullptr || type->medium.empty() || wanted == nullptr) return;
    const auto number = medium_number(scenario.media, type->medium, *wanted);
    if (!number.ok()) {
      if (choice.grown) return;  // told of the one before it
      problems.push_back(problem_at(choice.options, "medium", number.error().message));
      return;
    }
    choice.medium = number.value();
    if (choice.medium != 0) inherit(scenario.media[choice.medium - 1U], *type, choice.options);
  };
  for (ControllerConfig& config : scenario.controllers) {
    for (DeviceChoice& choice : config.sensors) name_one(choice, hal::Role::Sensor);
    for (DeviceChoice& choice : config.actuators) name_one(choice, hal::Role::Actuator);
  }
}

}  // namespace tandem::core
