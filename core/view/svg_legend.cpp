#include "core/view/svg_legend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/view/svg_robots.hpp"
#include "core/view/svg_text.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

using Shows = std::function<bool(const Drawing::Robot&)>;
using Add = std::function<void(std::string symbol, std::string text)>;

/// "10,000"
std::string grouped(std::size_t n) {
  std::string digits = std::to_string(n);
  for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
    digits.insert(static_cast<std::size_t>(i), ",");
  return digits;
}

std::string ring_symbol(std::string_view color, std::string_view more) {
  return "<circle r=\"7.5\" fill=\"none\" stroke=\"" + std::string(color) + "\" stroke-width=\"2.5\"" +
         std::string(more) + "/>";
}

/// The nearest of eight names.
std::string_view name_of(hal::Rgb c) {
  constexpr std::array<std::pair<hal::Rgb, std::string_view>, 8> kNames = {{{{255, 0, 0}, "red"},
                                                                            {{0, 255, 0}, "green"},
                                                                            {{0, 0, 255}, "blue"},
                                                                            {{255, 255, 0}, "yellow"},
                                                                            {{255, 140, 0}, "orange"},
                                                                            {{0, 255, 255}, "cyan"},
                                                                            {{255, 0, 255}, "magenta"},
                                                                            {{255, 255, 255}, "white"}}};
  const auto far = [c](const auto& named) {
    const int r = named.first.r - c.r, g = named.first.g - c.g, b = named.first.b - c.b;
    return r * r + g * g + b * b;
  };
  return std::min_element(kNames.begin(), kNames.end(), [&](const auto& a, const auto& b) { return far(a) < far(b); })
      ->second;
}

/// How many robots show LEDs of which colour, by the names of colours.
void add_lamps(const Drawing& d, const Shows& shows, const Add& add) {
  struct Lit {
    std::string_view name;
    hal::Rgb color;
    std::size_t robots = 0, last = std::numeric_limits<std::size_t>::max();
  };
  std::vector<Lit> all;
  for (std::size_t i = 0; i < d.robots.size(); ++i) {
    if (!shows(d.robots[i])) continue;
    for (std::uint32_t k = 0; k < d.robots[i].lights; ++k) {
      const hal::Rgb color = d.lit[d.robots[i].first_light + k].color;
      const std::string_view name = name_of(color);
      auto found = std::find_if(all.begin(), all.end(), [name](const Lit& lit) { return lit.name == name; });
      if (found == all.end()) found = all.insert(all.end(), Lit{name, color});
      if (std::exchange(found->last, i) != i) ++found->robots;
    }
  }
  for (const Lit& lit : all) {
    add("<circle r=\"4.5\" fill=\"" + hex(lit.color) + "\" stroke=\"" + hex(lit.color) +
            "\" stroke-opacity=\"0.3\" stroke-width=\"5\"/>",
        grouped(lit.robots) + " with " + std::string(lit.name) + " LEDs");
  }
}

void add_heights(const Drawing& d, const Shows& shows, const Add& add) {
  double low_m = std::numeric_limits<double>::infinity(), high_m = 0.0;
  for (const Drawing::Robot& r : d.robots) {
    if (r.z_m <= kInTheAir_m || !shows(r)) continue;
    low_m = std::min(low_m, r.z_m);
    high_m = std::max(high_m, r.z_m);
  }
  if (high_m == 0.0) return;
  const std::string low = height_text(low_m), high = height_text(high_m);
  add("<path d=\"M0 7V-7M-4 -3L0 -7L4 -3\" fill=\"none\" stroke=\"#68707b\" stroke-width=\"1.6\"/>",
      "flying at " + (low == high ? low : low + " to " + high));
}

}  // namespace

std::string height_text(double z_m) {
  return hal::format_number(std::round(100.0 * z_m) / 100.0) + " m";
}

bool any_objects(const Drawing& drawing, bool movable) {
  const auto is = [movable](const auto& object) { return object.movable == movable; };
  return std::any_of(drawing.objects.begin(), drawing.objects.end(), is);
}

std::vector<LegendEntry> legend_of(const Drawing& d, const PictureLook& look, bool full_detail, const Shows& shows) {
  std::vector<LegendEntry> entries;
  const auto add = [&entries](std::string symbol, std::string text) {
    entries.push_back({std::move(symbol), std::move(text)});
  };
  std::vector<std::size_t> count(d.kinds.size(), 0);
  std::size_t halted = 0;
  for (const Drawing::Robot& r : d.robots) {
    if (!shows(r)) continue;
    ++count[r.kind];
    halted += r.halted ? 1 : 0;
  }
  for (std::size_t k = 0; k < d.kinds.size(); ++k) {
    if (count[k] > 0)
      add(full_detail ? robot_symbol(k, 8.0, 8.0) : dot_symbol(k), grouped(count[k]) + " × " + d.kinds[k].name);
  }
  if (!d.real.empty()) {
    std::size_t troubled = 0;
    for (const Drawing::RealRobot& real : d.real) troubled += real.state.empty() ? 0 : 1;
    add(ring_symbol(kRealColor, ""), grouped(d.real.size()) + " real");
    if (troubled > 0)
      add(ring_symbol(kTroubleColor, " stroke-dasharray=\"4 3\""), grouped(troubled) + " real in trouble");
  }
  if (halted > 0) add(halted_mark(9.0), grouped(halted) + " stopped");
  if (look.height_px == 0) {  // of films the first frame would tell how high the legend is
    add_lamps(d, shows, add);
    add_heights(d, shows, add);
  }
  if (!d.trails.empty())
    add("<path d=\"M-9 4C-3 -9 3 9 9 -4\" fill=\"none\" stroke=\"" +
            std::string(body_colors(d.robots[d.trails.front().robot].kind).edge) +
            "\" stroke-width=\"1.6\" stroke-opacity=\"0.55\"/>",
        look.trails_s > 0.0 ? "path of the last " + hal::format_number(look.trails_s) + " s" : "path");
  if (!d.lights.empty()) {
    add("<circle r=\"5\" fill=\"" + hex(d.lights.front().color) + "\" stroke=\"#7a5c00\"/>",
        grouped(d.lights.size()) + " × light");
  }
  const std::string block = "<rect x=\"-8\" y=\"-6\" width=\"16\" height=\"12\" fill=\"";
  if (any_objects(d, false)) add(block + std::string(kWallColor) + "\"/>", "obstacle");
  if (any_objects(d, true)) add(block + std::string(kMovableColor) + "\"/>", "movable");
  const auto is_wall = [](const Drawing::Border& b) { return b.wall; };
  const std::string line = "<line x1=\"-9\" x2=\"9\" stroke=\"" + std::string(kBorderColor) + "\" stroke-width=\"2\"";
  if (std::any_of(d.borders.begin(), d.borders.end(), is_wall)) add(line + "/>", "wall of a region");
  if (!std::all_of(d.borders.begin(), d.borders.end(), is_wall))
    add(line + " stroke-dasharray=\"5 4\"/>", "gate of a region");
  return entries;
}

}  // namespace tandem::core
