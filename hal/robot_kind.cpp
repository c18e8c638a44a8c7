#include "hal/robot_kind.hpp"

#include <limits>

namespace tandem::hal {
namespace {

constexpr Range kPositive{1e-9, std::numeric_limits<double>::infinity()};

/// A described value whose class is not known here.
struct Erased {
  AnyPart& part;
  void describe(ParamVisitor& v) { part.describe(v); }
};

}  // namespace

void Mount::describe(ParamVisitor& v) {
  v.number("bearing", bearing_rad, unit::deg, kAny, "Where it looks, counter-clockwise from forward.");
  v.number("x", x_m, unit::m, kAny, "Forward of the axis.");
  v.number("y", y_m, unit::m, kAny, "Left of the axis.");
  v.number("z", z_m, unit::m, kAny, "Above the ground.");
}

void Body::describe(ParamVisitor& v) {
  v.number("radius", radius_m, unit::m, kPositive, "Of the cylinder.");
  v.number("height", height_m, unit::m, kPositive, "Of the cylinder.");
  v.number("mass", mass_kg, unit::kg, kPositive, "Of the whole robot.");
  v.text("source", source, "Where these figures come from.");
}

void DifferentialDrive::describe(ParamVisitor& v) {
  v.number("wheel_radius", wheel_radius_m, unit::m, kNotNegative, "Of each wheel.");
  v.number("wheel_base", wheel_base_m, unit::m, kPositive, "Distance between the wheels' contact points.");
  v.number("max_speed", max_speed_m_s, unit::m_s, kNotNegative, "Of a wheel, at its rim.");
  v.number("force", force_N, unit::none, kNotNegative, "In N, that the wheels together can push with.");
  v.number("torque", torque_Nm, unit::none, kNotNegative, "In Nm, that they can turn the body with.");
  v.text("source", source, "Where these figures come from.");
}

void Quadrotor::describe(ParamVisitor& v) {
  v.number("max_speed", max_speed_m_s, unit::m_s, kNotNegative, "In any direction.");
  v.number("max_acceleration", max_acceleration_m_s2, unit::m_s2, kNotNegative,
           "Beyond what holds it up, in any direction.");
  v.number("max_turn", max_turn_rad_s, unit::rad_s, kNotNegative, "Fastest turn about the vertical axis.");
  v.number("max_lean", max_lean_rad, unit::deg, kNotNegative, "Lean that it obeys.");
  v.number("max_thrust", max_thrust, unit::none, kNotNegative, "Of all rotors together, in parts of its weight.");
  v.number("climb", climb_m_s, unit::m_s, kNotNegative, "When it takes off, unless told otherwise.");
  v.number("sink", sink_m_s, unit::m_s, kNotNegative, "When it lands, unless told otherwise.");
  v.number("take_off", take_off_m, unit::m, kNotNegative, "Height to which it takes off.");
  v.number("inertia", inertia_kg_m2, unit::none, kNotNegative, "Moment of inertia about each axis, in kg m2.");
  v.number("rotor_arm", rotor_arm_m, unit::m, kNotNegative, "From the axis to each of the four rotors.");
  v.number("rotor_lag", rotor_lag_s, unit::s, kNotNegative, "In which a rotor's thrust covers 63 % of a change.");
  v.number("rotor_torque", rotor_torque_m, unit::m, kNotNegative, "Drag torque for each newton of a rotor's thrust.");
  v.text("source", source, "Where these figures come from.");
}

void AnyPart::describe(ParamVisitor& v) {
  table_->describe(data_.get(), v);
}

void AnyPart::attributes(ParamVisitor& v) {
  table_->attributes(data_.get(), v);
}

void RobotKind::attributes(ParamVisitor& v) {
  for (AnyPart& part : parts_) part.attributes(v);
}

void RobotKind::describe(ParamVisitor& v) {
  v.group(Body::kName, body, Body::kDoc);
  if (auto* drive = std::get_if<DifferentialDrive>(&locomotion))
    v.group(DifferentialDrive::kName, *drive, DifferentialDrive::kDoc);
  if (auto* flight = std::get_if<Quadrotor>(&locomotion)) v.group(Quadrotor::kName, *flight, Quadrotor::kDoc);
  for (AnyPart& part : parts_) {
    Erased erased{part};
    v.group(part.name(), erased, part.doc());
  }
}

std::string RobotKind::flaw() const {
  if (!(body.radius_m > 0.0 && body.height_m > 0.0)) return "has no body; give it a radius and a height above 0";
  if (!(body.mass_kg > 0.0)) return "weighs nothing; give its body a mass above 0";
  if (drive() != nullptr && !(drive()->wheel_base_m > 0.0))
    return "has wheels without a distance between them; give its " + std::string(DifferentialDrive::kName) +
           " a wheel_base above 0";
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::string part = "part '" + std::string(parts_[i].name()) + "'";
    for (std::size_t k = 0; k < i; ++k) {
      if (parts_[k].name() == parts_[i].name())
        return "has a " + part + " twice; leave one of them out, or give it another name";
    }
    if (const std::string flaw = parts_[i].flaw(); !flaw.empty()) return "has a " + part + " that " + flaw;
  }
  return {};
}

std::string mounts_flaw(const std::vector<Mount>& mounts, std::size_t capacity) {
  if (mounts.empty()) return "has no mounts; give it at least one";
  if (mounts.size() <= capacity) return {};
  return "has " + std::to_string(mounts.size()) + " mounts, where a reading or command holds " +
         std::to_string(capacity) + "; leave some out";
}

}  // namespace tandem::hal
