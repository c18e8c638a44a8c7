// Buttons on a robot, by which people tell it something.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "hal/port.hpp"

namespace tandem::hal {

/// Which buttons are pressed, in the order that the robot's part tells.
struct Buttons : Reading {
  static constexpr std::string_view kName = "buttons";
  static constexpr std::string_view kDoc = "Buttons that are pressed.";
  static constexpr std::size_t kCapacity = 8;

  std::uint32_t count = 0;
  std::array<bool, kCapacity> pressed{};

  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Real, "number of buttons");
    f.add("pressed", pressed, unit::none, Frame::Body, Fusion::Real, "true while it is pressed").used_by = "count";
  }
};

/// Buttons. Those of a simulated robot are never pressed.
struct ButtonsPart {
  static constexpr std::string_view kName = "buttons";
  static constexpr std::string_view kDoc = "Buttons.";
  std::int64_t count = 1;
  std::string source = {};  ///< and their order

  void describe(ParamVisitor& v) {
    v.integer("count", count, {1, static_cast<double>(Buttons::kCapacity)}, "How many it has.");
    v.text("source", source, "How this is known, and their order.");
  }
};

}  // namespace tandem::hal
