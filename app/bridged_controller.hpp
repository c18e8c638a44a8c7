// A controller that is not one of a simulated row.
#pragma once
#include <cstddef>
#include <new>
#include <string>

#include "hal/controller.hpp"
#include "hal/plugin_call.hpp"

namespace tandem::app {

/// One controller made for a real robot, in memory of its own.
class BridgedController {
 public:
  BridgedController(const hal::ControllerType& type, hal::Robot& robot, const void* params)
      : type_(type), memory_(::operator new (type.size, std::align_val_t{type.align})) {
    const hal::PluginCall call(&name, &type_);
    try {
      type.construct(memory_, robot, params);
    } catch (...) {
      ::operator delete (memory_, std::align_val_t{type.align});
      throw;
    }
  }
  ~BridgedController() {
    const hal::PluginCall call(&name, &type_);
    type_.destroy(memory_);
    ::operator delete (memory_, std::align_val_t{type_.align});
  }
  BridgedController(const BridgedController&) = delete;
  BridgedController& operator=(const BridgedController&) = delete;

  /// False when it threw; `why` then says what.
  bool step(std::string& why) {
    const std::uint8_t running = 0;
    hal::PluginCall call(&name, &type_);
    if (type_.step_row(static_cast<std::byte*>(memory_), type_.size, 0, 1, &running, call.fault()) == 1) return true;
    why = call.fault().message;
    return false;
  }

 private:
  static void name(const void* type, std::size_t /*part*/, std::size_t /*index*/, hal::FixedText& out) noexcept {
    out << "controller '" << static_cast<const hal::ControllerType*>(type)->name << "'";
  }

  const hal::ControllerType& type_;
  void* memory_;
};

}  // namespace tandem::app
