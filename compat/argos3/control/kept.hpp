// A controller of ARGoS' with its devices, which outlives its wrapper where loop functions hold it.
#pragma once
#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/plugins/factory.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compat/argos3/control/device.hpp"
#include "compat/argos3/facade/context.hpp"
#include "compat/argos3/facade/controllers.hpp"
#include "hal/robot.hpp"

namespace tandem::compat::argos3 {

class Kept final : public KeptController, public Context {
 public:
  /// Makes the controller and calls Init. @throws its exceptions
  Kept(hal::Robot& robot, const argos::tandem_detail::SRegistration& registration, ticpp::Element& params);
  ~Kept() override;
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;

  argos::CCI_Controller& controller() override { return *controller_; }
  void end() override;
  const std::string& id() const noexcept { return controller_->GetId(); }
  /// Takes over the readings of the sensors that the controller has asked for, then calls ControlStep.
  void step();
  /// Gives it this robot's ports, then calls Reset.
  void reset(hal::Robot& robot);
  /// The port of a device that the configuration lists and that no class of ARGoS' is for; null: there is no such.
  const hal::PortType* unclassed(std::string_view written, hal::Role role) const;

 private:
  void tell(bool error, std::string_view text) override;
  void take(hal::Robot& robot);

  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<hal::ListedDevice> unclassed_;
  std::vector<std::pair<argos::CCI_Sensor*, Device*>> sensors_;
  std::unique_ptr<argos::CCI_Controller> controller_;
  hal::RobotLog log_;
  bool ended_ = false;
};

}  // namespace tandem::compat::argos3
