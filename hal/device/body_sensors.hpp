// Sensors of a robot's own state and of the air around it: acceleration, turn rates, sound level,
// battery, clock.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/port.hpp"

namespace tandem::hal {

/// Specific force in the body frame: a robot at rest on level ground reads (0, 0, +9.81).
struct Accelerometer : Reading {
  static constexpr std::string_view kName = "accelerometer";
  static constexpr std::string_view kDoc = "Specific force in the body frame; (0, 0, 9.81) at rest.";

  std::array<float, 3> force_m_s2{};

  void describe(FieldList& f) const {
    f.add("force", force_m_s2, unit::m_s2, Frame::Body, Fusion::Real, "specific force, x forward, y left, z up");
  }
};

/// An accelerometer with three axes.
struct AccelerometerPart {
  static constexpr std::string_view kName = "accelerometer";
  static constexpr std::string_view kDoc = "An accelerometer with three axes.";
  std::string source = {};
  void describe(ParamVisitor& v) { v.text("source", source, "How this is known."); }
};

/// Turn rates in the body frame.
struct Gyroscope : Reading {
  static constexpr std::string_view kName = "gyroscope";
  static constexpr std::string_view kDoc = "Turn rates about the axes of the body.";

  std::array<float, 3> rate_rad_s{};

  void describe(FieldList& f) const {
    f.add("rate", rate_rad_s, unit::rad_s, Frame::Body, Fusion::Real, "about x forward, y left, z up");
  }
};

/// A gyroscope with three axes.
struct GyroscopePart {
  static constexpr std::string_view kName = "gyroscope";
  static constexpr std::string_view kDoc = "A gyroscope with three axes.";
  std::string source = {};
  void describe(ParamVisitor& v) { v.text("source", source, "How this is known."); }
};

/// Sound level at each microphone: 0 silence, 1 full scale.
struct Microphones : Reading {
  static constexpr std::string_view kName = "microphones";
  static constexpr std::string_view kDoc = "Sound level at each microphone, 0 silence to 1 full scale.";
  static constexpr std::size_t kCapacity = 4;

  std::uint32_t count = 0;
  std::array<float, kCapacity> level{};

  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Real, "number of microphones");
    f.add("level", level, unit::none, Frame::Body, Fusion::Larger, "0 silence to 1 full scale").used_by = "count";
  }
};

/// Microphones.
struct MicrophonesPart : MountedSensors<Microphones::kCapacity> {
  static constexpr std::string_view kName = "microphones";
  static constexpr std::string_view kDoc = "Microphones.";
};

/// State of the battery.
struct Battery : Reading {
  static constexpr std::string_view kName = "battery";
  static constexpr std::string_view kDoc = "Charge that is left and voltage of the battery.";

  float charge = 0.0F;  ///< 0 empty to 1 full
  float supply_V = 0.0F;

  void describe(FieldList& f) const {
    f.add("charge", charge, unit::none, Frame::None, Fusion::Real, "0 empty to 1 full");
    f.add("supply", supply_V, unit::V, Frame::None, Fusion::Real, "terminal voltage");
  }
};

/// The battery: voltages when full and empty, and when a real robot is to be stopped for it.
struct BatteryPart {
  static constexpr std::string_view kName = "battery";
  static constexpr std::string_view kDoc = "The battery.";
  double full_V = 0.0;
  double empty_V = 0.0;
  double low_charge = 0.05;  ///< of the full one: it is low at or below this …
  double low_V = 0.0;        ///< … or, where this is not 0, at or below this voltage
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("full", full_V, unit::V, {1e-9, 1e4}, "Voltage when full.");
    v.number("empty", empty_V, unit::V, kNotNegative, "Voltage when empty.");
    v.number("low_charge", low_charge, unit::none, {0.0, 1.0}, "Part of the charge at which a real robot is stopped.");
    v.number("low", low_V, unit::V, kNotNegative, "Voltage at which it is stopped; 0: the charge counts.");
    v.text("source", source, "Where these figures come from.");
  }
  std::string flaw() const {
    return full_V > empty_V ? "" : "is as full when it is empty; give full more volts than empty";
  }
};

/// The run's own time; the same in every world.
struct Clock : Reading {
  static constexpr std::string_view kName = "clock";
  static constexpr std::string_view kDoc = "Time of the run and length of a tick.";

  Tick tick = 0;
  TimeNs now_ns = 0;
  double tick_s = 0.0;

  void describe(FieldList& f) const {
    f.add("tick", tick, unit::none, Frame::None, Fusion::Virtual, "number of this control step");
    f.add("now_ns", now_ns, unit::none, Frame::None, Fusion::Virtual, "nanoseconds since the start of the run");
    f.add("tick_s", tick_s, unit::s, Frame::None, Fusion::Virtual, "length of a control step");
  }
};

}  // namespace tandem::hal
