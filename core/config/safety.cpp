// Reads <safety>: where real robots may go, and what they keep from.
#include <map>

#include "core/config/reading.hpp"
#include "core/scenario/polygon.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kMostAreas = 100;

/// Of corners, counted from 1.
std::string text_of(const OutlineFlaw& flaw) {
  const std::string a = std::to_string(flaw.a + 1), b = std::to_string(flaw.b + 1);
  switch (flaw.kind) {
    case OutlineFlaw::Kind::None:
      break;
    case OutlineFlaw::Kind::TooFew:
      return "an area needs at least three corners";
    case OutlineFlaw::Kind::TooMany:
      return "more than " + std::to_string(OutlineFlaw::kMostCorners) + " corners";
    case OutlineFlaw::Kind::SameCorners:
      return "corners " + a + " and " + b + " are the same";
    case OutlineFlaw::Kind::NoArea:
      return "the corners lie on one line";
    case OutlineFlaw::Kind::FoldsBack:
      return "the side from corner " + a + " goes back along the one before it";
    case OutlineFlaw::Kind::SidesMeet:
      return "the sides from corners " + a + " and " + b + " cross or touch";
  }
  return "";
}

class SafetyReader {
 public:
  explicit SafetyReader(Reading& reading) : reading_(reading), out_(reading.out().safety) {}

  void read(Element& e) {
    const auto s = reading_.read<schema::Safety>(e);
    out_.avoid = s.avoid == "none" ? Avoid::Nobody : s.avoid == "all" ? Avoid::All : Avoid::Real;
    out_.apart_m = s.apart_m;
    out_.latency_s = s.latency_s;
    for (Element& c : e.children) {
      if (c.name == schema::FenceElement::kElement.name) fence(c);
      if (c.name == schema::KeepOut::kElement.name) keep_out(c);
      if (c.name == schema::Zone::kElement.name) zone(c);
    }
    if (out_.fences.size() + out_.keep_outs.size() + out_.zones.size() > kMostAreas)
      reading_.error(e, "<safety> holds more than " + std::to_string(kMostAreas) + " areas");
    bool any_real = false;
    for (const RobotItem& robot : reading_.out().robots) {
      if (!robot.bridge) continue;
      any_real = true;
      check_start(robot);
    }
    if (!any_real) reading_.warn(e, "<safety> has no effect: no robot has a <bridge>");
  }

 private:
  SafetyArea area(Element& e, const std::string& id, const std::string& points) {
    SafetyArea made;
    const int number = ++unnamed_[id.empty() ? e.name : ""];
    made.id = !id.empty() ? id : number == 1 ? e.name : e.name + " " + std::to_string(number);
    made.line = e.line;
    bool good = !points.empty();
    for (const std::string& word : words(points)) {
      if (word.empty()) continue;
      const auto point = point_of(word);
      good = good && point;
      if (point) {
        made.corners.push_back(*point);
      } else {
        reading_.error(e, "points", "'" + word + "' must be two lengths, \"x,y\"; corners are separated by spaces");
      }
    }
    const std::string flaw = good ? text_of(flaw_of(made.corners)) : "";
    if (!flaw.empty()) reading_.error(e, "points", flaw);
    if (!flaw.empty() || !good) made.corners.clear();  // judged already
    if (!id.empty()) {
      const auto [first, fresh] = lines_.emplace(id, e.line);
      if (!fresh)
        reading_.error(e, "id", "a second area '" + id + "'; the first is on line " + std::to_string(first->second));
    }
    return made;
  }

  void fence(Element& e) {
    const auto f = reading_.read<schema::FenceElement>(e);
    SafetyArea made = area(e, f.id, f.points);
    made.to_m = f.height_m;
    out_.fences.push_back(std::move(made));
  }

  void keep_out(Element& e) {
    const auto k = reading_.read<schema::KeepOut>(e);
    SafetyArea made = area(e, k.id, k.points);
    made.from_m = k.from_m;
    made.to_m = k.to_m;
    check_heights(e, made);
    out_.keep_outs.push_back(std::move(made));
  }

  void zone(Element& e) {
    const auto z = reading_.read<schema::Zone>(e);
    SafetyArea made = area(e, z.id, z.points);
    made.from_m = z.from_m;
    made.to_m = z.to_m;
    made.max_speed_m_s = z.max_speed_m_s;
    check_heights(e, made);
    out_.zones.push_back(std::move(made));
  }

  void check_heights(const Element& e, const SafetyArea& made) {
    if (!(made.to_m > made.from_m)) reading_.error(e, "to", "must be above 'from'");
  }

  /// A real robot begins inside of every fence and outside of every keep-out, with its whole body.
  void check_start(const RobotItem& robot) {
    const hal::RobotKind* const kind =
        robot.own_kind != nullptr ? robot.own_kind.get() : reading_.catalog().find<hal::RobotKind>(robot.kind);
    if (kind == nullptr || robot.distribute) return;  // a problem of its own
    const double x = robot.placement.p_W[0], y = robot.placement.p_W[1], low_m = robot.placement.p_W[2];
    const double top_m = low_m + kind->body.height_m;
    Element at;
    at.name = robot.kind;
    at.file = reading_.out().file;
    at.line = robot.line;
    for (const SafetyArea& f : out_.fences) {
      if (f.corners.empty()) continue;
      if (!contains(f.corners, x, y) || nearest_on_edge(f.corners, x, y).distance < kind->body.radius_m)
        reading_.error(at, "robot '" + robot.id + "' starts outside of the fence '" + f.id + "' (line " +
                               std::to_string(f.line) + "), or its body stands out of it");
      else if (top_m > f.to_m)
        reading_.error(
            at, "robot '" + robot.id + "' starts above the fence '" + f.id + "' (line " + std::to_string(f.line) + ")");
    }
    for (const SafetyArea& k : out_.keep_outs) {
      if (k.corners.empty() || low_m >= k.to_m || top_m <= k.from_m) continue;
      if (contains(k.corners, x, y) || nearest_on_edge(k.corners, x, y).distance < kind->body.radius_m)
        reading_.error(
            at, "robot '" + robot.id + "' starts in the keep-out '" + k.id + "' (line " + std::to_string(k.line) + ")");
    }
  }

  Reading& reading_;
  SafetyConfig& out_;
  std::map<std::string, int> lines_;    // of areas, by id
  std::map<std::string, int> unnamed_;  // how many so far, by element
};

}  // namespace

void read_safety(Reading& reading, Element& safety) {
  SafetyReader(reading).read(safety);
}

}  // namespace tandem::core
