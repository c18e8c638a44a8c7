// Selector: a rotary switch on the robot, by which people choose what it does.
#pragma once
#include <cstdint>
#include <string>

#include "hal/port.hpp"

namespace tandem::hal {

/// Position of the switch.
struct Selector : Reading {
  static constexpr std::string_view kName = "selector";
  static constexpr std::string_view kDoc = "Position of the rotary switch.";

  std::uint32_t position = 0;

  void describe(FieldList& f) const { f.add("position", position, unit::none, Frame::None, Fusion::Real, "from 0 on"); }
};

/// A rotary switch. A simulated robot's stands where its element says: `selector="3"`.
struct SelectorPart {
  static constexpr std::string_view kName = "selector";
  static constexpr std::string_view kDoc = "A rotary switch.";
  std::int64_t positions = 16;
  std::int64_t position = 0;  ///< of a simulated robot
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.integer("positions", positions, {2, 256}, "How many it has.");
    v.integer("position", position, {0, 255}, "Where it stands on a simulated robot, from 0 on.");
    v.text("source", source, "Where these figures come from.");
  }
  void attributes(ParamVisitor& v) {
    v.integer("selector", position, {0, static_cast<double>(positions - 1)},
              "Position of a simulated robot's selector.");
  }
  std::string flaw() const {
    return position < positions ? "" : "stands at a position that it does not have; give one below `positions`";
  }
};

}  // namespace tandem::hal
