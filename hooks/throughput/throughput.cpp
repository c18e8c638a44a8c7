#include "hooks/throughput/throughput.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "hal/device/gripper.hpp"
#include "hal/unit.hpp"

namespace tandem::hooks {
namespace {

constexpr int kRings = 3;  // of places around the middle of the source

bool held(const core::Space& space, const core::Object& object) {
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::RobotId robot = space.robot(i);
    if (!space.holding(robot)) continue;
    const core::Pose pose = space.pose(robot);
    const hal::RobotKind& kind = space.kind(robot);
    const auto* const gripper = kind.part<hal::GripperPart>();
    const double claws_m = gripper != nullptr ? gripper->reach_m : 0.0;
    const double most_m = kind.body.radius_m + claws_m + object.reach_m();
    if (std::hypot(pose.x_m - object.x_m, pose.y_m - object.y_m) <= most_m) return true;
  }
  return false;
}

bool is_free(const core::Space& space, std::size_t number, double x_m, double y_m) {
  const double reach_m = space.objects()[number].reach_m();
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::Pose pose = space.pose(space.robot(i));
    const double radius_m = space.kind(space.robot(i)).body.radius_m;
    if (std::hypot(pose.x_m - x_m, pose.y_m - y_m) < radius_m + reach_m + 0.01) return false;
  }
  for (std::size_t i = 0; i < space.objects().size(); ++i) {
    const core::Object& other = space.objects()[i];
    if (i == number || !other.alive || !other.movable) continue;
    if (std::hypot(other.x_m - x_m, other.y_m - y_m) < other.reach_m() + reach_m + 0.01) return false;
  }
  return true;
}

hal::Tick ticks_of(double time_s, const core::HookContext& context) {
  return static_cast<hal::Tick>(std::llround(time_s * static_cast<double>(context.ticks_per_second)));
}

}  // namespace

void Throughput::after_step(core::HookContext& context) {
  core::Space& space = context.space;
  for (std::size_t i = 0; i < space.objects().size(); ++i) {
    const core::Object& object = space.objects()[i];
    if (!object.alive || !object.movable || object.x_m >= params_.nest_x_m || held(space, object)) continue;
    if (!put_back(space, i)) continue;  // the source is crowded: in the next step again
    state_.recent.push_back(context.tick);
    ++state_.brought;
  }
  const hal::Tick done = context.tick + 1;
  while (!state_.recent.empty() && state_.recent.front() < done - ticks_of(params_.window_s, context))
    state_.recent.pop_front();
  context.measures.set("throughput", static_cast<double>(state_.recent.size()));
  context.measures.set("brought", static_cast<double>(state_.brought));
  const hal::Tick every = std::max<hal::Tick>(1, ticks_of(params_.every_s, context));
  if (done % every != 0) return;
  state_.samples.push_back({static_cast<double>(done) / static_cast<double>(context.ticks_per_second),
                            state_.recent.size(), state_.brought});
}

/// The middle of the source, or a place on the rings around it.
bool Throughput::put_back(core::Space& space, std::size_t number) const {
  for (int ring = 0; ring <= kRings; ++ring) {
    const int places = std::max(1, 6 * ring);
    for (int k = 0; k < places; ++k) {
      const double angle_rad = 2.0 * std::numbers::pi * k / places;
      core::Object moved = space.objects()[number];
      moved.x_m = params_.source_m[0] + ring * params_.spacing_m * std::cos(angle_rad);
      moved.y_m = params_.source_m[1] + ring * params_.spacing_m * std::sin(angle_rad);
      if (!is_free(space, number, moved.x_m, moved.y_m)) continue;
      const core::ObjectId id = space.object(number);
      if (!space.set_object(id, moved).ok()) continue;
      return space.set_object_velocity(id, {}).ok();
    }
  }
  return false;
}

std::optional<double> Throughput::floor(double x_m, double /*y_m*/) {
  return x_m < params_.nest_x_m ? 0.0 : 1.0;
}

void Throughput::after_run(core::HookContext&) {
  if (params_.output.empty()) return;
  std::ofstream out(params_.output);
  out << "time_s,throughput,brought\n";
  for (const Sample& s : state_.samples)
    out << hal::format_number(s.time_s) << ',' << s.throughput << ',' << s.brought << '\n';
  out.flush();
  if (!out)
    throw std::runtime_error(params_.output + ": cannot be written; is there such a folder, and room on the disk?");
}

}  // namespace tandem::hooks
