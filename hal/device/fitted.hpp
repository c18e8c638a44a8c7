// Fitted parameters: how real robots differ from what their kind says, as parts of a kind. Simulated devices work by
// them; `tandem fit` writes them.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/params.hpp"

namespace tandem::hal {

/// A parameter of a model.
template <class Model>
struct ModelField {
  double Model::*member;
  std::string_view name;
  const Unit* unit;
  Range range;
  std::string_view doc;
};

/// How wheels roll, compared with the kind and the command.
struct WheelModel {
  double left = 1.0;   ///< way on the floor, as a part of the way commanded
  double right = 1.0;  ///< the same
  double base = 1.0;   ///< the wheel base that the robot turns by, as a part of its kind's
  double counted_left = 1.0;
  double counted_right = 1.0;  ///< what encoders count, as a part of the way commanded
  double noise_sqrt_m = 0.0;   ///< standard deviation of each wheel's way after 1 m; it grows with the way's root
  double delay_s = 0.0;        ///< from the tick whose command it is until the wheels turn

  static std::span<const ModelField<WheelModel>> fields();
};

/// How infrared proximity sensors read a distance d within their range R:
/// R * gain * (d / R)^exponent + offset, and noise; of where the robot was `delay_s` ago.
struct ProximityModel {
  double gain = 1.0;
  double exponent = 1.0;
  double offset_m = 0.0;
  double noise_m = 0.0;  ///< standard deviation
  double delay_s = 0.0;

  static std::span<const ModelField<ProximityModel>> fields();
};

/// A model with all values 0: nothing differs.
template <class Model>
Model no_spread() {
  Model none;
  for (const ModelField<Model>& f : Model::fields()) none.*f.member = 0.0;
  return none;
}

/// The values of a model, described by their fields.
template <class Model>
struct ModelValues {
  Model of;
  void describe(ParamVisitor& v) {
    for (const ModelField<Model>& f : Model::fields()) v.number(f.name, of.*f.member, *f.unit, f.range, f.doc);
  }
};

/// Standard deviations of the values of a model.
template <class Model>
struct ModelDeviations {
  Model of = no_spread<Model>();
  void describe(ParamVisitor& v) {
    for (const ModelField<Model>& f : Model::fields())
      v.number(f.name, of.*f.member, *f.unit, kNotNegative, "Standard deviation of the value of that name.");
  }
};

/// What was found for one robot, each value with its standard error.
template <class Model>
struct FittedRobot {
  std::string id = {};
  ModelValues<Model> value = {};
  ModelDeviations<Model> error = {};

  void describe(ParamVisitor& v) {
    v.text("id", id, "Of the robot.");
    value.describe(v);
    v.group("error", error, "The standard error of each value.");
  }
};

/// A part of fitted parameters. A robot that was measured has its own values; others those of `mean`. In a
/// pseudo-reality (`reality` is not 0) values are drawn instead, by that number and the robot: for one that was
/// measured around its own with their standard errors, for others around `mean` with `spread`.
template <class Model>
struct FittedPart {
  std::int64_t reality = 0;  ///< set by the experiment (`<fitted reality="…">`), for all of its models
  ModelValues<Model> mean = {};
  ModelDeviations<Model> spread = {};
  std::vector<FittedRobot<Model>> robots = {};
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.group("mean", mean, "The values of a robot that was not measured.");
    v.group("spread", spread, "How much robots differ from one another.");
    v.list("robot", robots, "A robot that was measured.");
    v.text("source", source, "Where these figures come from.");
  }
};

/// How the wheels of robots roll that were measured.
struct FittedWheels : FittedPart<WheelModel> {
  static constexpr std::string_view kName = "fitted_wheels";
  static constexpr std::string_view kDoc = "How wheels roll, as measured: scale, noise, delay.";
};

/// How the proximity sensors of robots read that were measured.
struct FittedProximity : FittedPart<ProximityModel> {
  static constexpr std::string_view kName = "fitted_proximity";
  static constexpr std::string_view kDoc = "How proximity sensors read, as measured: curve, noise, delay.";
};

}  // namespace tandem::hal
