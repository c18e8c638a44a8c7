#include "compat/argos3/control/adapter.hpp"

#include <optional>

#include "compat/argos3/facade/configuration.hpp"
#include "hal/open_params.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::compat::argos3 {

void Adapter::Params::describe(hal::ParamVisitor& v) {
  std::string xml;
  hal::describe_element(v, xml, "Handed to the controller's Init, children too.");
  hal::Problems problems;
  if (xml.empty()) xml = "<params/>";
  if (const auto element = hal::read_xml_text(xml, "params", problems))
    node = to_node(*element, false);  // lines of the text
}

Adapter::Adapter(hal::Robot& robot, const Params& params) {
  const std::string id(robot.id());
  kept_ = std::dynamic_pointer_cast<Kept>(kept_controller(id));
  if (kept_ != nullptr)
    kept_->reset(robot);
  else
    kept_ = std::make_shared<Kept>(robot, *params.registration, *params.node);
  enter_controller(id, kept_);
}

Adapter::~Adapter() {
  if (!leave_controller(kept_->id(), *kept_)) kept_->end();
}

bool Adapter::reset(hal::Robot& robot) {
  const std::string id(robot.id());
  if (id != kept_->id() && controllers_are_held()) {
    keep_controller(id);
    const auto other = std::dynamic_pointer_cast<Kept>(kept_controller(id));
    if (other == nullptr) return false;  // the constructor makes one
    leave_controller(kept_->id(), *kept_);
    kept_ = other;
  }
  kept_->reset(robot);
  enter_controller(id, kept_);
  return true;
}

}  // namespace tandem::compat::argos3
