#include "hal/appearance.hpp"

#include <algorithm>

#include "hal/robot_kind.hpp"

namespace tandem::hal {
namespace {

constexpr Range kIndex{0, 4095};
constexpr std::string_view kOn = "The joint that it sits on; otherwise it sits on the body.";

}  // namespace

void Driver::describe(ParamVisitor& v) {
  v.text("row", row, "A port with its role, as 'actuator leds', or the name of what is kept for the robot.");
  v.text("field", field, "Of that row.");
  v.integer("index", index, kIndex, "Of the value in the field.");
  v.flag("switch", as_switch, "It counts 1 where it is other than off, else 0.");
  v.number("off", off, unit::none, kAny, "What it is where the switch is off.");
}

void Appearance::Joint::describe(ParamVisitor& v) {
  v.text("name", name, "By which others sit on it.");
  v.flag("slides", slides, "Along the axis; otherwise it turns about it.");
  v.vector("at", at_m, unit::m, "A point of the axis.");
  v.vector("axis", axis, unit::none, "Direction, of length 1.");
  v.group("by", by, "What moves it.");
  v.number("scale", scale, unit::none, kAny, "Metres or radians for each unit of the value.");
  v.text("on", on, kOn);
}

void Appearance::Link::describe(ParamVisitor& v) {
  v.text("name", name, "For people.");
  v.choice("shape", shape, kShapes, "Its form.");
  v.vector("low", low_m, unit::m, "The corner of the box around it that is behind, right and below.");
  v.vector("high", high_m, unit::m, "The opposite corner.");
  v.text("on", on, kOn);
  v.text("color", color, "As #rrggbb; otherwise that of the kind.");
  v.group("held", held, "While it is not 0 the link is drawn dark and filled.");
  v.number("turned", turned_rad, unit::deg, kAny, "Counter-clockwise about the upright line through its middle.");
  v.flag("fine", fine, "Pictures from above leave it out.");
}

void Appearance::Lamp::describe(ParamVisitor& v) {
  v.vector("at", at_m, unit::m, "Its place.");
  v.text("on", on, kOn);
  v.group("by", by, "Its red, which green and blue follow; of one with a color what switches it.");
  v.text("color", color, "As #rrggbb, of one that is only switched.");
}

std::vector<const Driver*> Appearance::drivers() const {
  std::vector<const Driver*> all;
  for (const Joint& joint : joints) all.push_back(&joint.by);
  for (const Link& link : links) {
    if (!link.held.row.empty()) all.push_back(&link.held);
  }
  return all;
}

Appearance::Link piece(std::string_view shape, std::string_view color, Appearance::Point low_m,
                       Appearance::Point high_m) {
  return {.name = {},
          .shape = std::string(shape),
          .low_m = low_m,
          .high_m = high_m,
          .color = std::string(color),
          .fine = true};
}

Appearance::Link round_piece(std::string_view shape, std::string_view color, double x_m, double y_m, double radius_m,
                             double low_m, double high_m) {
  return piece(shape, color, {x_m - radius_m, y_m - radius_m, low_m}, {x_m + radius_m, y_m + radius_m, high_m});
}

Appearance appearance_of(const RobotKind& kind) {
  Appearance look;
  for (const AnyPart& part : kind.parts()) part.appear(kind, look);
  kind.appear(look);
  // Joints behind those that they sit on.
  std::vector<Appearance::Joint> waiting = std::move(look.joints);
  look.joints.clear();
  const auto number_of = [&look](const std::string& name) {
    const auto found = std::find_if(look.joints.begin(), look.joints.end(),
                                    [&name](const Appearance::Joint& joint) { return joint.name == name; });
    return name.empty() || found == look.joints.end() ? Appearance::kBody
                                                      : static_cast<int>(found - look.joints.begin());
  };
  while (!waiting.empty()) {
    const auto waits = [&](const Appearance::Joint& joint) {
      return std::any_of(waiting.begin(), waiting.end(),
                         [&joint](const Appearance::Joint& other) { return other.name == joint.on; });
    };
    auto next = std::find_if_not(waiting.begin(), waiting.end(), waits);
    if (next == waiting.end()) next = waiting.begin();  // they sit on each other: the first is on the body
    next->parent = number_of(next->on);
    look.joints.push_back(std::move(*next));
    waiting.erase(next);
  }
  for (Appearance::Link& link : look.links) link.joint = number_of(link.on);
  for (Appearance::Lamp& lamp : look.lamps) lamp.joint = number_of(lamp.on);
  look.upper_joint = number_of(look.upper);
  return look;
}

bool is_color(std::string_view text) noexcept {
  return text.size() == 7 && text.front() == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string_view::npos;
}

void LookPart::describe(ParamVisitor& v) {
  v.list("joint", joints, "Moves what sits on it.");
  v.list("link", links, "A rigid piece.");
  v.list("lamp", lamps, "A light.");
  v.text("upper", upper, "The joint that turns the upper half of the body.");
  v.flag("whole", whole, "The links are all that is seen: body and wheels or rotors add none.");
  v.text("source", source, "Where this comes from.");
}

std::string LookPart::flaw() const {
  const auto bad = [](const auto& one) { return !one.color.empty() && !is_color(one.color); };
  if (std::any_of(links.begin(), links.end(), bad) || std::any_of(lamps.begin(), lamps.end(), bad))
    return "has a color that is not written as #rrggbb";
  return {};
}

void LookPart::appear(const RobotKind& /*kind*/, Appearance& look) const {
  look.joints.insert(look.joints.end(), joints.begin(), joints.end());
  look.links.insert(look.links.end(), links.begin(), links.end());
  look.lamps.insert(look.lamps.end(), lamps.begin(), lamps.end());
  if (!upper.empty()) look.upper = upper;
  if (whole) look.whole = true;
}

}  // namespace tandem::hal
