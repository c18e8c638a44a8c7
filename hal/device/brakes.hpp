// How fast a robot's wheels follow a new command: what safety counts on.
#pragma once
#include <string>

#include "hal/params.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::hal {

/// A part of robots on wheels. Those without are taken to have the default.
struct BrakesPart {
  static constexpr std::string_view kName = "brakes";
  static constexpr std::string_view kDoc = "How fast its wheels stop.";
  double deceleration_m_s2 = 1.0;  ///< of each wheel's rim, at least; both wheels alike
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("deceleration", deceleration_m_s2, unit::m_s2, {1e-3, 1e4},
             "Of each wheel's rim, from when a command has come, at least; both wheels alike.");
    v.text("source", source, "Where these figures come from.");
  }
};

}  // namespace tandem::hal
