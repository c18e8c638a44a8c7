// Cliff sensors: whether there is floor beneath the rim, before a wheel gets there.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/port.hpp"

namespace tandem::hal {

/// Infrared light that the floor beneath each sensor sends back: 0 none (no floor, or a black one), 1 white floor.
struct Cliff : Reading {
  static constexpr std::string_view kName = "cliff";
  static constexpr std::string_view kDoc =
      "Light that comes back from the floor beneath the rim, 0 none (an edge, or black floor) to 1 white floor.";
  static constexpr std::size_t kCapacity = 8;

  std::uint32_t count = 0;
  std::array<float, kCapacity> reflectance{};

  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Real, "number of sensors");
    f.add("reflectance", reflectance, unit::none, Frame::Sensor, Fusion::Nearer, "0 none to 1 white floor").used_by =
        "count";
  }
};

/// Sensors that look for the floor's edge.
struct CliffPart : MountedSensors<Cliff::kCapacity> {
  static constexpr std::string_view kName = "cliff";
  static constexpr std::string_view kDoc = "Sensors that look for the edge of the floor.";
};

}  // namespace tandem::hal
