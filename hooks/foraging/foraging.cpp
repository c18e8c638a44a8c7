#include "hooks/foraging/foraging.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "hal/device/leds.hpp"
#include "hal/unit.hpp"

namespace tandem::hooks {
namespace {

constexpr double kBlack = 0.0, kGrey = 0.5, kWhite = 1.0;

/// In [low, high); the same numbers with every standard library.
double between(std::mt19937_64& chance, double low, double high) {
  return low + (high - low) * static_cast<double>(chance() >> 11) * 0x1p-53;
}

}  // namespace

void Foraging::before_run(core::HookContext& context) {
  state_.chance.seed(context.seed);
  state_.items.resize(static_cast<std::size_t>(params_.items));
  for (Item& item : state_.items) appear(item);
  context.space.repaint_floor();
}

void Foraging::appear(Item& item) {
  item.taken = false;
  item.x_m = between(state_.chance, params_.food_min_m[0], params_.food_max_m[0]);
  item.y_m = between(state_.chance, params_.food_min_m[1], params_.food_max_m[1]);
}

void Foraging::controls(core::HookContext& context, hal::Controls& controls) {
  if (controls.number("radius", params_.radius_m, hal::unit::cm, {0.01, 0.5}, "Of an item on the floor."))
    context.space.repaint_floor();
  if (!controls.button("scatter", "Puts all items that lie on the floor elsewhere.")) return;
  for (Item& item : state_.items) {
    if (!item.taken) appear(item);
  }
  context.space.repaint_floor();
}

Foraging::Item* Foraging::item_of(core::RobotId robot) noexcept {
  for (Item& item : state_.items) {
    if (item.taken && item.bearer == robot) return &item;
  }
  return nullptr;
}

void Foraging::treat(core::Space& space, core::RobotId robot) {
  const core::Pose pose = space.pose(robot);
  const bool home = pose.x_m < params_.nest_x_m;
  if (!home) ++state_.robot_ticks_outside;
  Item* item = item_of(robot);
  if (item != nullptr) {
    if (!home) return;
    ++state_.collected;
    appear(*item);
    return space.repaint_floor();
  }
  const auto* leds = space.port<hal::RingLeds>(robot);
  const auto* const mounted = space.kind(robot).part<hal::LedsPart>();
  if (home || leds == nullptr || mounted == nullptr || leds->color(mounted->beacon_led()) != hal::kGreen) return;
  for (Item& there : state_.items) {
    if (there.taken || std::hypot(there.x_m - pose.x_m, there.y_m - pose.y_m) > params_.radius_m) continue;
    there.taken = true;
    there.bearer = robot;
    return space.repaint_floor();
  }
}

void Foraging::after_step(core::HookContext& context) {
  core::Space& space = context.space;
  for (Item& item : state_.items) {  // of robots that are gone
    if (!item.taken || space.contains(item.bearer)) continue;
    appear(item);
    space.repaint_floor();
  }
  Line line;
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    treat(space, space.robot(i));
    ++(space.pose(space.robot(i)).x_m < params_.nest_x_m ? line.inside : line.outside);
  }
  const double rate_hz = static_cast<double>(context.ticks_per_second);
  const double energy_J = params_.energy_per_item_J * static_cast<double>(state_.collected) -
                          params_.power_outside_W * static_cast<double>(state_.robot_ticks_outside) / rate_hz;
  context.measures.set("collected", static_cast<double>(state_.collected));
  context.measures.set("energy_J", energy_J);
  context.measures.set("outside", static_cast<double>(line.outside));
  const hal::Tick done = context.tick + 1;
  if (done % std::max<hal::Tick>(1, std::llround(params_.every_s * rate_hz)) != 0) return;
  line.time_s = static_cast<double>(done) / rate_hz;
  line.bringing = static_cast<std::size_t>(
      std::count_if(state_.items.begin(), state_.items.end(), [](const Item& item) { return item.taken; }));
  line.collected = state_.collected;
  line.energy_J = energy_J;
  state_.lines.push_back(line);
}

std::optional<double> Foraging::floor(double x_m, double y_m) {
  if (x_m < params_.nest_x_m) return kGrey;
  for (const Item& item : state_.items) {
    if (!item.taken && std::hypot(item.x_m - x_m, item.y_m - y_m) <= params_.radius_m) return kBlack;
  }
  return kWhite;
}

void Foraging::after_run(core::HookContext&) {
  if (params_.output.empty()) return;
  std::ofstream out(params_.output);
  out << "time_s,outside,inside,bringing,collected,energy_J\n";
  for (const Line& l : state_.lines)
    out << hal::format_number(l.time_s) << ',' << l.outside << ',' << l.inside << ',' << l.bringing << ','
        << l.collected << ',' << hal::format_number(l.energy_J) << '\n';
  out.flush();
  if (!out)
    throw std::runtime_error(params_.output + ": cannot be written; is there such a folder, and room on the disk?");
}

}  // namespace tandem::hooks
