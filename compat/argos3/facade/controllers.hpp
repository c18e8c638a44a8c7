// ARGoS controllers of this process by the ids of their robots. They live longer than their wrappers: users keep
// pointers to them across resets.
#pragma once
#include <memory>
#include <string>

namespace argos {
class CCI_Controller;
}

namespace tandem::compat::argos3 {

/// A controller with its devices.
class KeptController {
 public:
  virtual ~KeptController() = default;
  virtual ::argos::CCI_Controller& controller() = 0;
  /// Calls CCI_Controller::Destroy; nothing else is called after it.
  virtual void end() = 0;
};

/// Of a robot that was just made. An earlier one of that id ends, where nothing steps it.
void enter_controller(const std::string& robot, const std::shared_ptr<KeptController>& kept);
/// While a robot is made: the controller that robot had before a reset, when `keep_controller` was called for it; it is
/// to be given the new robot's ports, and reset. Null: a new one is to be made.
std::shared_ptr<KeptController> kept_controller(const std::string& robot);
/// Whether loop functions of ARGoS' hold the controllers of this process; then a robot that begins again under another
/// id takes over the controller of that id.
bool controllers_are_held();
/// Its wrapper is gone. @returns whether it is held until loop functions end it; else the caller ends it
bool leave_controller(const std::string& robot, const KeptController& kept);

// --- for loop functions ---
/// From now on controllers are held, or no longer.
void hold_controllers(bool on);
/// Null: the robot has no ARGoS controller, or never was.
::argos::CCI_Controller* controller_of(const std::string& robot);
void keep_controller(const std::string& robot);
void end_controller(const std::string& robot);
/// Those that nothing steps any more.
void end_left_controllers();

}  // namespace tandem::compat::argos3
