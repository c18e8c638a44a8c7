#include "mixed_reality/replay/replay.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/space/fingerprint.hpp"
#include "core/space/mechanisms.hpp"
#include "core/space/stores.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr std::size_t kNamesShown = 4;

const void* no_reading(const hal::PortType&) {
  return nullptr;
}

std::string text_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kNamesShown); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kNamesShown) text += " and " + std::to_string(names.size() - kNamesShown) + " more";
  return text;
}

/// The latched reading of this class; null: the controller took none, or nothing was measured.
template <class Port>
const Port* reading_of(const PortFusion& fusion) {
  for (std::size_t i = 0; i < fusion.size(); ++i) {
    if (fusion.type(i).layout != hal::port_type<Port>().layout) continue;
    const auto* const port = static_cast<const Port*>(fusion.reading(i));
    return port->validity == hal::Validity::Absent ? nullptr : port;
  }
  return nullptr;
}

}  // namespace

Replay::Replay(core::World& world, RecordedInputs recorded, const ReplayOptions& options)
    : world_(world), recorded_(std::move(recorded)), from_(recorded_.ticks()), log_(options.log) {
  if (options.from) from_ = std::min(from_, *options.from);
}

hal::Result<std::unique_ptr<Replay>> Replay::make(core::World& world, const std::string& record,
                                                  const ReplayOptions& options) {
  auto recorded = RecordedInputs::open(record);
  if (!recorded.ok()) return recorded.error();
  std::unique_ptr<Replay> replay(new Replay(world, std::move(recorded).value(), options));
  if (const hal::Status added = replay->add_robots(); !added.ok())
    return hal::Error{"record '" + record + "': " + added.error().message};
  world.set_external(replay.get());
  return replay;
}

hal::Status Replay::add_robots() {
  core::Space& space = world_.space();
  for (const std::string& id : recorded_.robots()) {
    const core::RobotId robot = space.find_robot(id);
    if (!robot.valid()) return hal::Error{"robot '" + id + "' took part as a real one, and is not in the experiment"};
    auto entity = std::make_unique<TwinEntity>(space, robot, &no_reading);
    entity->list(inputs_);
    InputWriter writer(*entity, id);
    robots_.push_back({id, std::move(entity), std::move(writer), 0});
  }
  const RecordedTick* const before = recorded_.read(-1);
  if (before == nullptr) return hal::Error{"it does not say how the real robots began"};
  if (const hal::Status applied = apply(*before); !applied.ok()) return applied;
  for (Robot& robot : robots_) {
    robot.entity->latch();
    if (const auto missing = robot.writer.missing(); !missing.empty() && robot.entity->takes_part())
      log_.warning("robot '" + robot.id + "' reads what the record does not hold: " + text_of(missing) +
                   "; the real robot's part of it is absent");
  }
  return {};
}

hal::Status Replay::apply(const RecordedTick& tick) {
  for (const core::RecordRows& rows : tick.inputs) {
    for (Robot& robot : robots_) {
      if (const hal::Status written = robot.writer.write(rows); !written.ok()) return written;
    }
  }
  return {};
}

/// The robot goes on from where the real one was.
void Replay::continue_simulated(Robot& robot) {
  TwinEntity& entity = *robot.entity;
  if (!entity.takes_part()) return;
  core::Space& space = world_.space();
  const core::RobotId id = entity.robot();
  entity.latch();  // as the real one was in this tick, as far as it is known
  entity.state().takes_part = false;
  entity.latch();
  entity.state().takes_part = true;  // again what the record says of the real one
  robot.deviation = deviations_.size();
  deviations_.emplace_back(robot.id);
  if (!space.contains(id)) return;
  core::SpaceStores& stores = space.stores();
  const std::size_t row = stores.row_of(id);
  if (const auto* wheels = reading_of<hal::WheelEncoders>(entity.fusion()); wheels != nullptr) {
    stores.bodies.left_m[row] = wheels->left_m;
    stores.bodies.right_m[row] = wheels->right_m;
  }
  if (const auto* battery = reading_of<hal::Battery>(entity.fusion()); battery != nullptr)
    (void)space.set_battery(id, std::clamp(static_cast<double>(battery->charge), 0.0, 1.0));
}

void Replay::latch(core::World& world) {
  const hal::Tick tick = world.tick();
  const RecordedTick* const now = tick < recorded_.ticks() ? recorded_.read(tick) : nullptr;
  if (now != nullptr && failure_.empty()) {
    if (const hal::Status applied = apply(*now); !applied.ok()) {
      failure_ = "tick " + std::to_string(tick) + ": " + applied.error().message;
      log_.error(failure_ + "; the robots are simulated from here on");
      from_ = std::min(from_, tick);
    }
  }
  if (tick < from_) {
    for (Robot& robot : robots_) robot.entity->latch();
    return;
  }
  if (!simulated_) {
    simulated_ = true;
    for (Robot& robot : robots_) {
      const bool takes_part = robot.entity->takes_part();
      if (takes_part) continue_simulated(robot);
    }
  }
  if (now != nullptr) note_deviations(tick);
}

/// Where the robots stand at the beginning of the tick, and where the real ones did.
void Replay::note_deviations(hal::Tick tick) {
  for (Deviation& deviation : deviations_) {
    const auto robot =
        std::find_if(robots_.begin(), robots_.end(), [&](const Robot& r) { return r.id == deviation.robot(); });
    if (robot == robots_.end() || !world_.space().contains(robot->entity->robot())) continue;
    const TwinState& real = robot->entity->state();
    if (real.takes_part) deviation.note(tick, world_.space().pose(robot->entity->robot()), real.pose());
  }
}

void Replay::after_sense(core::World&) {
  for (Robot& robot : robots_) robot.entity->after_sense();
}

std::string Replay::difference() {
  const hal::Tick tick = world_.tick() - 1;
  const RecordedTick* const then = recorded_.read(tick);
  std::uint32_t fields = 0, robots = 0;
  if (then == nullptr || then->checks.size() < sizeof fields + sizeof robots) return {};
  const char* at = then->checks.data();
  std::memcpy(&fields, at, sizeof fields);
  std::memcpy(&robots, at + sizeof fields, sizeof robots);
  at += sizeof fields + sizeof robots;
  const core::StateView view = world_.state_view();
  const core::StateChecks now = core::checks_of(view);
  if (then->checks.size() != 8 + std::size_t{fields} + robots) return {};
  const auto differs = [&](std::size_t i, std::uint8_t value) { return static_cast<std::uint8_t>(at[i]) != value; };
  std::vector<std::string> whose, what;
  if (robots != now.robots.size()) {
    whose.push_back("other robots are there");
  } else {
    const core::Space& space = world_.space();
    for (std::size_t i = 0; i < robots; ++i) {
      const core::RobotId id{static_cast<std::uint32_t>(i), view.stores.robots[i].generation};
      if (differs(fields + i, now.robots[i])) whose.push_back("robot '" + space.robot_name(id) + "'");
    }
  }
  if (fields != now.fields.size()) {
    what.push_back("other fields are there");
  } else {
    const std::vector<std::string> names = core::field_names(view);
    for (std::size_t i = 0; i < fields; ++i) {
      if (differs(i, now.fields[i])) what.push_back(names[i]);
    }
  }
  if (whose.empty()) return text_of(what);
  return text_of(whose) + (what.empty() ? "" : " in " + text_of(what));
}

}  // namespace tandem::mixed_reality
