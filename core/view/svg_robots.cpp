#include "core/view/svg_robots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tandem::core {
namespace {

constexpr double kTinyRobot_px = 2.0;
constexpr std::size_t kDotsPerPath = 2'000;  // viewers slow down on longer ones
/// The colours of kinds in the window [Okabe and Ito 2008], lighter within and darker at the edge.
constexpr std::array<BodyColors, 6> kBodyColors = {{{"#9fd3f2", "#1f6f9f"},
                                                    {"#8fd6bf", "#00664b"},
                                                    {"#e5b8d2", "#8d4a72"},
                                                    {"#f6cf7f", "#8f6200"},
                                                    {"#8fc1e3", "#004a75"},
                                                    {"#cccccc", "#5c5c5c"}}};

/// One robot with all that sits on it.
class Pieces {
 public:
  Pieces(const Drawing& drawing, const Drawing::Robot& robot)
      : d_(drawing), r_(robot), kind_(drawing.kinds[robot.kind]), look_(kind_.look) {}

  std::string draw() {
    Svg place;
    place << "translate(" << r_.x_m << " " << r_.y_m << ") rotate(" << degrees(r_.heading_rad) << ")";
    const std::string use = "<use href=\"#kind" + std::to_string(r_.kind) + "\"", transform = place.take();
    const auto fine = [](const hal::Appearance::Link& link) { return link.fine; };
    if (r_.lights == 0 && !r_.halted && std::all_of(look_.links.begin(), look_.links.end(), fine))
      return use + " transform=\"" + transform + "\"/>\n";
    svg_ << "<g transform=\"" << transform << "\">" << use << "/>";
    on(hal::Appearance::kBody);
    if (r_.halted) svg_ << halted_mark(kind_.radius_m);
    svg_ << "</g>\n";
    return svg_.take();
  }

 private:
  double value(std::size_t driver) const { return d_.values[r_.first_value + driver]; }

  /// What sits on a joint, or on the body.
  void on(int joint) {
    std::size_t held = look_.joints.size();
    for (const hal::Appearance::Link& link : look_.links) {
      const bool holds = !link.held.row.empty() && value(held++) != 0.0;
      if (link.joint == joint && !link.fine) this->link(link, holds);
    }
    for (int next = joint + 1; next < static_cast<int>(look_.joints.size()); ++next) {
      if (look_.joints[static_cast<std::size_t>(next)].parent == joint) moved(next);
    }
    for (std::uint32_t i = 0; i < r_.lights; ++i) {
      const Drawing::LitLamp& lit = d_.lit[r_.first_light + i];
      if (look_.lamps[lit.lamp].joint == joint) lamp(look_.lamps[lit.lamp].at_m, hex(lit.color));
    }
  }

  /// Seen from above, so turns about other axes than the vertical one are not to be seen.
  void moved(int number) {
    const hal::Appearance::Joint& joint = look_.joints[static_cast<std::size_t>(number)];
    const double by = joint.scale * value(static_cast<std::size_t>(number));
    const bool carries =
        std::any_of(look_.links.begin(), look_.links.end(),
                    [number](const hal::Appearance::Link& link) { return link.joint == number && !link.fine; });
    if (!carries && by == 0.0) return on(number);
    svg_ << "<g class=\"" << escaped(joint.name) << "\" transform=\"";
    if (joint.slides) {
      svg_ << "translate(" << by * joint.axis[0] << " " << by * joint.axis[1] << ")";
    } else {
      svg_ << "rotate(" << (std::fabs(joint.axis[2]) > 0.5 ? degrees(std::copysign(1.0, joint.axis[2]) * by) : 0.0);
      if (joint.at_m[0] != 0.0 || joint.at_m[1] != 0.0) svg_ << " " << joint.at_m[0] << " " << joint.at_m[1];
      svg_ << ")";
    }
    svg_ << "\">";
    on(number);
    svg_ << "</g>";
  }

  /// White, or of its own colour; of the colour of the kind's edge while it holds something.
  void link(const hal::Appearance::Link& link, bool holds) {
    const std::string_view edge = body_colors(r_.kind).edge;
    const double wide = link.high_m[0] - link.low_m[0], deep = link.high_m[1] - link.low_m[1];
    if (link.shape == "cylinder") {
      svg_ << "<circle class=\"" << escaped(link.name) << "\" cx=\"" << link.low_m[0] + 0.5 * wide << "\" cy=\""
           << link.low_m[1] + 0.5 * deep << "\" r=\"" << 0.5 * wide;
    } else {
      svg_ << "<rect class=\"" << escaped(link.name) << "\" x=\"" << link.low_m[0] << "\" y=\"" << link.low_m[1]
           << "\" width=\"" << wide << "\" height=\"" << deep;
    }
    svg_ << "\" fill=\""
         << (holds                ? edge
             : link.color.empty() ? std::string_view("#ffffff")
                                  : link.color)
         << "\" stroke=\"" << edge << "\" stroke-width=\"" << 0.08 * kind_.radius_m << "\"/>";
  }

  void lamp(const hal::Appearance::Point& at_m, const std::string& color) {
    svg_ << "<circle class=\"led\" cx=\"" << at_m[0] << "\" cy=\"" << at_m[1] << "\" r=\"" << 0.24 * kind_.radius_m
         << "\" fill=\"" << color << "\" stroke=\"" << color << "\" stroke-opacity=\"0.3\" stroke-width=\""
         << 0.26 * kind_.radius_m << "\"/>";
  }

  const Drawing& d_;
  const Drawing::Robot& r_;
  const Drawing::Kind& kind_;
  const hal::Appearance& look_;
  Svg svg_;
};

}  // namespace

const BodyColors& body_colors(std::size_t kind) {
  return kBodyColors[kind % kBodyColors.size()];
}

std::string robot_symbol(std::size_t kind, double radius, double radius_px) {
  const BodyColors& c = body_colors(kind);
  Svg s;
  if (radius_px < kTinyRobot_px) {
    s << "<circle r=\"" << radius << "\" fill=\"" << c.edge << "\"/>";
    return s.take();
  }
  s << "<circle r=\"" << 0.94 * radius << "\" fill=\"" << c.fill << "\" stroke=\"" << c.edge << "\" stroke-width=\""
    << 0.12 * radius << "\"/><path d=\"M" << 0.88 * radius << " 0L" << -0.38 * radius << " " << 0.5 * radius << "L"
    << -0.12 * radius << " 0L" << -0.38 * radius << " " << -0.5 * radius << "Z\" fill=\"" << c.edge << "\"/>";
  return s.take();
}

std::string dot_symbol(std::size_t kind) {
  return "<circle r=\"4\" fill=\"" + std::string(body_colors(kind).edge) + "\"/>";
}

std::string halted_mark(double radius) {
  const double h = 0.62 * radius;
  Svg s;
  s << "<path class=\"halted\" d=\"M" << -h << " " << -h << "L" << h << " " << h << "M" << -h << " " << h << "L" << h
    << " " << -h << "\" stroke=\"" << kTroubleColor << "\" stroke-width=\"" << 0.24 * radius
    << "\" stroke-linecap=\"round\"/>";
  return s.take();
}

// Thousands of discs in one path: a line of no length with round ends each.
std::string robot_dots(const Drawing& d) {
  Svg svg;
  std::map<std::pair<std::uint32_t, std::string>, std::vector<std::size_t>> colors;
  for (std::size_t i = 0; i < d.robots.size(); ++i) {
    const Drawing::Robot& r = d.robots[i];
    colors[{r.kind, r.lights > 0 ? hex(d.lit[r.first_light].color) : std::string(body_colors(r.kind).edge)}].push_back(
        i);
  }
  svg << "<g class=\"dots\" fill=\"none\" stroke-linecap=\"round\">\n";
  for (const auto& [key, members] : colors) {
    for (std::size_t begin = 0; begin < members.size(); begin += kDotsPerPath) {
      svg << "<path stroke=\"" << key.second << "\" stroke-width=\"" << 2.0 * d.kinds[key.first].radius_m << "\" d=\"";
      const std::size_t end = std::min(members.size(), begin + kDotsPerPath);
      for (std::size_t i = begin; i < end; ++i)
        svg << "M" << d.robots[members[i]].x_m << " " << d.robots[members[i]].y_m << "h.0001";
      svg << "\"/>\n";
    }
  }
  svg << "</g>\n";
  return svg.take();
}

std::string robot_body(const Drawing& drawing, const Drawing::Robot& robot) {
  return Pieces(drawing, robot).draw();
}

}  // namespace tandem::core
