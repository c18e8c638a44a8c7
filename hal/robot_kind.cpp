#include "hal/robot_kind.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "hal/elementary.hpp"
#include "hal/open_params.hpp"

namespace tandem::hal {
namespace {

// Wide enough for every robot, and narrow enough that no square or quotient of them leaves the numbers.
constexpr Range kExtent_m{0.001, 100.0};
constexpr Range kPlace_m{-100.0, 100.0};
constexpr Range kTurns_rad{-4.0 * std::numbers::pi, 4.0 * std::numbers::pi};
constexpr Range kAboveZero{1e-9, 1e6};
constexpr double kLargestRing = 1000;
constexpr std::string_view kDarkColor = "#23272d";

/// A described value whose class is not known here.
struct Erased {
  AnyPart& part;
  void describe(ParamVisitor& v) { part.describe(v); }
};

/// Collects the names of what robots' elements may say, and finds what cannot be told apart.
class AttributeNames final : public ParamVisitor {
 public:
  void visit(const Param& param) override {
    if (!is_no_attribute(param.name)) add(param.name);
  }

  std::string flaw;

 private:
  void add(std::string_view name) {
    if (!flaw.empty()) return;
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto fits = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; };
    if (name.empty() || !letter(name.front()) || !std::all_of(name.begin(), name.end(), fits))
      flaw = "lets its robots say '" + std::string(name) + "', which is no name of an attribute; choose another";
    else if (!names_.insert(std::string(name)).second)
      flaw = "has two parts that let its robots say '" + std::string(name) +
             "'; leave one of them out, or name it otherwise";
  }

  std::set<std::string> names_{"id"};
};

}  // namespace

void Mount::describe(ParamVisitor& v) {
  v.number("bearing", bearing_rad, unit::deg, kTurns_rad, "Where it looks, counter-clockwise from forward.");
  v.number("x", x_m, unit::m, kPlace_m, "Forward of the axis.");
  v.number("y", y_m, unit::m, kPlace_m, "Left of the axis.");
  v.number("z", z_m, unit::m, kPlace_m, "Above the ground.");
}

void Mount::add_to(std::vector<Mount>& mounts, ParamVisitor& v) {
  Mount first;
  double radius_m = 0.0;
  std::int64_t count = 1;
  first.describe(v);
  v.number("radius", radius_m, unit::m, {0.0, kPlace_m.max}, "Moves it from x and y that far along its bearing.");
  v.integer("count", count, {1, kLargestRing},
            "A ring of so many: the others follow counter-clockwise, evenly spread around the axis.");
  const double x_m = first.x_m + radius_m * cos(first.bearing_rad);
  const double y_m = first.y_m + radius_m * sin(first.bearing_rad);
  for (std::int64_t i = 0; i < count; ++i) {
    const double turn_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double c = cos(turn_rad), s = sin(turn_rad);
    mounts.push_back({first.bearing_rad, x_m, y_m, first.z_m});
    if (i == 0) continue;
    mounts.back().bearing_rad = std::remainder(first.bearing_rad + turn_rad, 2.0 * std::numbers::pi);
    mounts.back().x_m = c * x_m - s * y_m;
    mounts.back().y_m = s * x_m + c * y_m;
  }
}

void Body::describe(ParamVisitor& v) {
  v.number("radius", radius_m, unit::m, kExtent_m, "Of the cylinder.");
  v.number("height", height_m, unit::m, kExtent_m, "Of the cylinder.");
  v.number("mass", mass_kg, unit::kg, {1e-6, 1e6}, "Of the whole robot.");
  v.text("source", source, "Where these figures come from.");
}

void DifferentialDrive::describe(ParamVisitor& v) {
  v.number("wheel_radius", wheel_radius_m, unit::m, kExtent_m, "Of each wheel.");
  v.number("wheel_base", wheel_base_m, unit::m, kExtent_m, "Distance between the wheels' contact points.");
  v.number("max_speed", max_speed_m_s, unit::m_s, {1e-6, 1000.0}, "Of a wheel, at its rim.");
  v.number("force", force_N, unit::none, kAboveZero, "In N, that the wheels together can push with.");
  v.number("torque", torque_Nm, unit::none, kAboveZero, "In Nm, that they can turn the body with.");
  v.text("source", source, "Where these figures come from.");
}

void DifferentialDrive::attributes(ParamVisitor& v) {
  v.number("max_speed", max_speed_m_s, unit::m_s, {1e-6, 1000.0},
           "Limit of a wheel's speed, at its rim; 100 m/s or more: none.");
}

void Quadrotor::describe(ParamVisitor& v) {
  v.number("max_speed", max_speed_m_s, unit::m_s, {1e-6, 1000.0}, "In any direction.");
  v.number("max_acceleration", max_acceleration_m_s2, unit::m_s2, kAboveZero,
           "Beyond what holds it up, in any direction.");
  v.number("max_turn", max_turn_rad_s, unit::rad_s, kAboveZero, "Fastest turn about the vertical axis.");
  v.number("max_lean", max_lean_rad, unit::deg, kAboveZero, "Lean that it obeys.");
  v.number("max_thrust", max_thrust, unit::none, kAboveZero, "Of all rotors together, in parts of its weight.");
  v.number("climb", climb_m_s, unit::m_s, kAboveZero, "When it takes off, unless told otherwise.");
  v.number("sink", sink_m_s, unit::m_s, kAboveZero, "When it lands, unless told otherwise.");
  v.number("take_off", take_off_m, unit::m, kAboveZero, "Height to which it takes off.");
  v.number("inertia", inertia_kg_m2, unit::none, kAboveZero, "Moment of inertia about each axis, in kg m2.");
  v.number("rotor_arm", rotor_arm_m, unit::m, kExtent_m, "From the axis to each of the four rotors.");
  v.number("rotor_lag", rotor_lag_s, unit::s, kAboveZero, "In which a rotor's thrust covers 63 % of a change.");
  v.number("rotor_torque", rotor_torque_m, unit::m, kAboveZero, "Drag torque for each newton of a rotor's thrust.");
  v.text("source", source, "Where these figures come from.");
}

void AnyPart::describe(ParamVisitor& v) {
  table_->describe(data_.get(), v);
}

void AnyPart::attributes(ParamVisitor& v) {
  table_->attributes(data_.get(), v);
}

void RobotKind::attributes(ParamVisitor& v) {
  if (auto* const wheels = std::get_if<DifferentialDrive>(&locomotion)) wheels->attributes(v);
  for (AnyPart& part : parts_) part.attributes(v);
}

namespace {

/// Four rotors on two beams, guarded by rings, around a core that stands on a foot.
void add_rotors(const Body& body, double arm_m, Appearance& look) {
  const double r = body.radius_m, h = body.height_m, deck_m = 0.32 * h, rotor_m = 0.48 * arm_m;
  look.links.push_back(round_piece("cylinder", "#3b4048", 0.0, 0.0, 0.26 * r, 0.1 * h, 0.55 * h));
  look.links.push_back(round_piece("cylinder", "", 0.0, 0.0, 0.3 * r, 0.55 * h, 0.62 * h));
  look.links.push_back(piece("arrow", kDarkColor, {-0.1 * r, -0.13 * r, 0.62 * h}, {0.24 * r, 0.13 * r, 0.63 * h}));
  look.links.push_back(round_piece("cylinder", "#59616c", 0.0, 0.0, 0.2 * r, 0.0, 0.1 * h));
  for (const double turned_deg : {45.0, 135.0}) {
    look.links.push_back(
        piece("box", "#4a515b", {-arm_m, -0.05 * arm_m, deck_m}, {arm_m, 0.05 * arm_m, deck_m + 0.06 * arm_m}));
    look.links.back().turned_rad = turned_deg / 180.0 * std::numbers::pi;
  }
  for (const double x : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      const double x_m = x * arm_m * std::numbers::sqrt2 / 2, y_m = y * arm_m * std::numbers::sqrt2 / 2;
      look.links.push_back(round_piece("ring", x > 0.0 ? "#c0392b" : kDarkColor, x_m, y_m, 1.06 * rotor_m, deck_m,
                                       deck_m + 0.16 * arm_m));
      look.links.push_back(
          round_piece("cylinder", "#aab2bd", x_m, y_m, 0.96 * rotor_m, deck_m + 0.09 * arm_m, deck_m + 0.11 * arm_m));
      look.links.push_back(round_piece("cylinder", kDarkColor, x_m, y_m, 0.12 * arm_m, deck_m, deck_m + 0.15 * arm_m));
    }
  }
}

/// A drum with an arrow on its lid; over wheels its lower half is cut flat, so that they are seen.
void add_drum(const Body& body, const DifferentialDrive* drive, Appearance& look) {
  const double r = body.radius_m, h = body.height_m, split_m = 0.55 * h;
  double cut_m = 0.97 * r;
  if (drive != nullptr && drive->wheel_radius_m > 0.0) {
    const double wide_m = std::min(0.5 * drive->wheel_radius_m, 0.2 * r), wheel_m = drive->wheel_radius_m;
    for (const double side : {1.0, -1.0}) {
      const double y_m = 0.5 * side * drive->wheel_base_m;
      look.links.push_back(piece("wheel", kDarkColor, {-wheel_m, y_m - 0.5 * wide_m, 0.0},
                                 {wheel_m, y_m + 0.5 * wide_m, 2.0 * wheel_m}));
    }
    cut_m = std::clamp(0.5 * (drive->wheel_base_m - 1.2 * wide_m), 0.3 * r, cut_m);
  }
  const double foot_m = drive != nullptr ? 0.1 * h : 0.0;
  look.links.push_back(piece("cylinder", "#5b626c", {-0.97 * r, -cut_m, foot_m}, {0.97 * r, cut_m, split_m}));
  look.links.push_back(round_piece("cylinder", "", 0.0, 0.0, 0.97 * r, split_m, 0.98 * h));
  look.links.back().on = look.upper;
  look.links.push_back(piece("arrow", kDarkColor, {-0.35 * r, -0.45 * r, 0.98 * h}, {0.8 * r, 0.45 * r, h}));
}

}  // namespace

void RobotKind::appear(Appearance& look) const {
  if (look.whole) return;
  if (flies())
    add_rotors(body, flight()->rotor_arm_m, look);
  else
    add_drum(body, drive(), look);
  look.whole = true;
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
  AttributeNames names;
  RobotKind(*this).attributes(names);
  return names.flaw;
}

std::string mounts_flaw(const std::vector<Mount>& mounts, std::size_t capacity) {
  if (mounts.empty()) return "has no mounts; give it at least one";
  if (mounts.size() <= capacity) return {};
  return "has " + std::to_string(mounts.size()) + " mounts, where a reading or command holds " +
         std::to_string(capacity) + "; leave some out";
}

}  // namespace tandem::hal
