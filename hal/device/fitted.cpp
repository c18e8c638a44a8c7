#include "hal/device/fitted.hpp"

#include <array>

namespace tandem::hal {

std::span<const ModelField<WheelModel>> WheelModel::fields() {
  static constexpr Range kPart{0.05, 20.0};
  static const std::array<ModelField<WheelModel>, 7> kFields = {{
      {&WheelModel::left, "left", &unit::none, kPart, "What the left wheel rolls on the floor, of what it should."},
      {&WheelModel::right, "right", &unit::none, kPart, "What the right wheel rolls on the floor, of what it should."},
      {&WheelModel::base, "base", &unit::none, kPart, "The wheel base that the robot turns by, of its kind's."},
      {&WheelModel::counted_left, "counted_left", &unit::none, kPart,
       "What the left encoder counts, of what it should."},
      {&WheelModel::counted_right, "counted_right", &unit::none, kPart,
       "What the right encoder counts, of what it should."},
      {&WheelModel::noise_sqrt_m,
       "noise",
       &unit::none,
       {0.0, 1.0},
       "Standard deviation of each wheel's way after 1 m, in m; it grows with the root of the way."},
      {&WheelModel::delay_s, "delay", &unit::s, {0.0, 10.0}, "From the tick of a command until the wheels obey it."},
  }};
  return kFields;
}

std::span<const ModelField<ProximityModel>> ProximityModel::fields() {
  static const std::array<ModelField<ProximityModel>, 5> kFields = {{
      {&ProximityModel::gain,
       "gain",
       &unit::none,
       {0.05, 20.0},
       "g in R g (d / R)^e + o, what is read of the distance d by a sensor of range R."},
      {&ProximityModel::exponent, "exponent", &unit::none, {0.1, 10.0}, "e in it."},
      {&ProximityModel::offset_m, "offset", &unit::m, {-10.0, 10.0}, "o in it."},
      {&ProximityModel::noise_m, "noise", &unit::m, {0.0, 10.0}, "Standard deviation of a reading."},
      {&ProximityModel::delay_s, "delay", &unit::s, {0.0, 10.0}, "Age of a reading when the controller gets it."},
  }};
  return kFields;
}

}  // namespace tandem::hal
