// A controller that is not one of a simulated row.
#pragma once
#include <cstddef>
#include <new>
#include <string>

#include "hal/controller.hpp"

namespace tandem::app {

/// One controller made for a real robot, in memory of its own.
class BridgedController {
 public:
  BridgedController(const hal::ControllerType& type, hal::Robot& robot, const void* params)
      : type_(type), memory_(::operator new (type.size, std::align_val_t{type.align})) {
    try {
      type.construct(memory_, robot, params);
    } catch (...) {
      ::operator delete (memory_, std::align_val_t{type.align});
      throw;
    }
  }
  ~BridgedController() {
    type_.destroy(memory_);
    ::operator delete (memory_, std::align_val_t{type_.align});
  }
  BridgedController(const BridgedController&) = delete;
  BridgedController& operator=(const BridgedController&) = delete;

  /// False when it threw; `why` then says what.
  bool step(std::string& why) {
    const std::uint8_t running = 0;
    hal::StepFault fault;
    if (type_.step_row(static_cast<std::byte*>(memory_), type_.size, 0, 1, &running, fault) == 1) return true;
    why = fault.message;
    return false;
  }

 private:
  const hal::ControllerType& type_;
  void* memory_;
};

}  // namespace tandem::app
