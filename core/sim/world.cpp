#include "core/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/sim/world_impl.hpp"
#include "core/space/fingerprint.hpp"
#include "hal/check.hpp"
#include "hal/rounded.hpp"
#include "hal/unit.hpp"

namespace tandem::core {

// --- the step ---

bool World::step() {
  Impl& w = *impl_;
  if (w.state != RunState::Running) return true;
  w.stores().sketch.clear();
  w.call_hooks("before_step", [](Hook& hook, HookContext& c) { hook.before_step(c); });
  w.paint_fields();
  if (w.external != nullptr) w.external->latch(*this);
  w.act();
  w.physics();
  w.before_sense();
  w.in_controllers = true;
  if (w.external == nullptr) {
    w.sense_and_control();
  } else {
    w.each_block(w.sensing, [&w](std::size_t block) { w.sense(block); });
    w.external->after_sense(*this);
    w.each_block(w.controlling, [&w](std::size_t block) { w.control(block); });
    const bool whole = w.external->after_control(*this);
    w.each_block(w.controlling, [&w](std::size_t block) { w.limit(block); });
    if (whole) w.external->after_filter(*this);
    if (!whole) {
      w.in_controllers = false;
      w.report_messages();
      return false;
    }
  }
  w.in_controllers = false;
  w.report_messages();
  w.report_trouble();
  w.call_hooks("after_step", [](Hook& hook, HookContext& c) { hook.after_step(c); });
  ++w.tick;
  bool done = false;
  w.call_hooks("is_done", [&done](Hook& hook, HookContext& c) { done = hook.is_done(c) || done; });
  if (done && w.state == RunState::Running) w.state = RunState::Done;
  do_requests(false);
  return true;
}

void World::Impl::act() {
  SpaceStores& s = stores();
  pool->run(s.blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      const DeviceContext context = device_context(block);
      const auto& actuators = devices.blocks[block].actuators;
      for (std::size_t i = 0; i < actuators.size(); ++i) {
        if (actuators[i] != nullptr) actuators[i]->act(context, s, s.blocks[block].ports[i]);
      }
      for (const auto& coupling : couplings) coupling->drive(context, s);
    }
  });
}

template <class Work>
void World::Impl::each_block(MeasuredPhase& phase, Work&& work) {
  phase.run(*pool, stores().blocks.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) work(block);
  });
}

/// The hooks' turn between physics and sensing; what sensors look into follows their changes.
void World::Impl::before_sense() {
  SpaceStores& s = stores();
  const bool changed_before = std::exchange(s.bodies_changed, false);
  call_hooks("before_sense", [](Hook& hook, HookContext& c) { hook.before_sense(c); });
  paint_fields();
  const bool changed = std::exchange(s.bodies_changed, s.bodies_changed || changed_before);
  if (!changed && indexed_version == s.immovables_version) return;
  settle_changes();
  rebuild_index();
  index_movables();
  media.index(s);
}

void World::Impl::sense_and_control() {
  // A block's ports stay in the cache from its sensing to its control.
  each_block(controlling, [this](std::size_t block) {
    sense(block);
    control(block);
    limit(block);
  });
}

void World::Impl::sense(std::size_t block) {
  const DeviceContext context = device_context(block);
  const auto& sensors = devices.blocks[block].sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i] != nullptr) sensors[i]->sense(context, context.block.ports[i]);
  }
}

void World::Impl::control(std::size_t index) {
  RobotBlock& block = stores().blocks[index];
  const hal::ControllerType& type = *stores().groups[block.group].controller;
  hal::PluginCall call(&name_step, this, index);
  std::array<std::uint8_t, kBlockRows> memory;
  const std::uint8_t* const skipped = not_stepped(index, memory);
  std::size_t next = 0;
  while (next < block.used) {
    next = type.step_row(block.controllers, block.controller_stride, next, block.used, skipped, call.fault());
    if (next == block.used) break;
    note_thrown(index, next, std::move(call.fault().message));
    ++next;
  }
}

/// By slot, not 0: halted, or its controller steps elsewhere. In `memory` where the two differ.
const std::uint8_t* World::Impl::not_stepped(std::size_t index,
                                             std::array<std::uint8_t, kBlockRows>& memory) const noexcept {
  const SpaceStores& s = space.stores();
  const RobotBlock& block = s.blocks[index];
  const std::uint8_t* skipped = block.halted.data();
  for (const RobotId robot : elsewhere) {
    if (!s.contains(robot) || s.robots[robot.index].block != index) continue;
    if (skipped != memory.data()) memory = block.halted;
    skipped = memory.data();
    memory[s.robots[robot.index].slot] = 1;
  }
  return skipped;
}

/// Reported, and its actuators made safe, after the phase.
void World::Impl::note_thrown(std::size_t index, std::size_t slot, std::string what) {
  faults[index].emplace_back(slot, hal::shortened(what, hal::kLongestMessage / 2));  // more is said of it
  stores().blocks[index].halted[slot] = kThrewInThisTick;
  block_trouble[index] = 1;
}

void World::Impl::limit(std::size_t index) {
  RobotBlock& block = stores().blocks[index];
  const RobotGroup& group = stores().groups[block.group];
  hal::Limited what;
  for (std::size_t p = 0; p < group.ports.size(); ++p) {
    const hal::PortType& type = *group.ports[p];
    if (type.limit == nullptr) continue;
    for (std::size_t i = 0; (i = type.limit(block.ports[p], i, block.used, *group.kind, what)) < block.used; ++i)
      note_limited(index, i, what);
  }
}

void World::Impl::note_limited(std::size_t index, std::size_t slot, const hal::Limited& what) {
  RobotBlock& block = stores().blocks[index];
  if (what.result == hal::LimitResult::Clamped) {
    ++clamped[index];
    note_excess(index, slot, what);
  } else {
    ++not_finite[index];
    block_trouble[index] = 1;
    stores().bodies.flags[block.first_row + slot] |= kNotFinite;
  }
}

void World::limit_commands() {
  Impl& w = *impl_;
  w.fit_ledgers();  // robots may have come since the last step
  for (std::size_t block = 0; block < w.stores().blocks.size(); ++block) w.limit(block);
  w.report_trouble();
}

/// Remembers the first robot of the block that asks for much more than it can do, to be named after the phase; one of a
/// group is named.
void World::Impl::note_excess(std::size_t index, std::size_t slot, const hal::Limited& what) {
  const RobotBlock& block = stores().blocks[index];
  if (what.asked_m_s <= kBeyond * what.most_m_s || excess_named[block.group] != 0 || excess[index].most_m_s > 0.0)
    return;
  excess[index] = {slot, what.asked_m_s, what.most_m_s};
  block_trouble[index] = 1;
}

void World::Impl::report_excess(std::size_t index) {
  const Excess found = std::exchange(excess[index], {});
  const RobotBlock& block = stores().blocks[index];
  if (found.most_m_s == 0.0 || std::exchange(excess_named[block.group], std::uint8_t{1}) != 0) return;
  const std::uint32_t entity = stores().bodies.entity[block.first_row + found.slot];
  incidents.note(number_of(entity), controller_of(entity),
                 " commanded " + hal::rounded(found.asked_m_s) + " m/s" + at_tick() + ", where " +
                     hal::rounded(found.most_m_s) + " m/s is the most that it can do" +
                     (found.asked_m_s > kUnlikely * found.most_m_s ? "; did you mean cm/s? Speeds are in m/s"
                                                                   : ": that is what it drives; a parameter without a "
                                                                     "unit has that of its class (`tandem describe`)"));
}

/// A command of this robot that is no finite number. A robot may do that in every tick: texts are made once.
void World::Impl::report_not_finite(std::uint32_t entity, const RobotGroup& group) {
  const bool more = std::any_of(group.ports.begin(), group.ports.end(), [](const hal::PortType* port) {
    return port->limit != nullptr && port->slow_down == nullptr;  // than what moves it
  });
  const auto [what, outcome] =
      group.kind->flies() ? std::pair(" commanded a flight that is not a finite number", ": it hovers for this tick")
      : more ? std::pair(" commanded something that is not a finite number", ": that device is off for this tick")
             : std::pair(" commanded a wheel speed that is not a finite number", ": wheels stopped for this tick");
  if (incidents.note_again(number_of(entity), what)) return;
  incidents.note(number_of(entity), controller_of(entity), what + at_tick() + outcome);
}

void World::Impl::report_thrown(std::uint32_t entity, const std::string& why) {
  space.set_halted({entity, stores().robots[entity].generation}, true, HaltOwner::Controller);
  ++incidents.controllers_thrown;
  incidents.note(number_of(entity), controller_of(entity),
                 " threw" + at_tick() + ": " + why + "; the robot is stopped");
}

void World::Impl::report_trouble() {
  for (std::size_t index = 0; index < block_trouble.size(); ++index) {
    if (block_trouble[index] == 0) continue;
    block_trouble[index] = 0;
    report_excess(index);
    RobotBlock& block = stores().blocks[index];
    for (std::size_t i = 0; i < block.used; ++i) {
      const std::size_t row = block.first_row + i;
      const std::uint32_t entity = stores().bodies.entity[row];
      std::uint8_t& flags = stores().bodies.flags[row];
      if ((flags & kNotFinite) != 0) {
        flags = static_cast<std::uint8_t>(flags & ~kNotFinite);
        report_not_finite(entity, stores().groups[block.group]);
      }
      if ((block.halted[i] & kThrewInThisTick) == 0) continue;
      block.halted[i] = static_cast<std::uint8_t>(block.halted[i] & ~kThrewInThisTick);
      const auto fault = std::ranges::find(faults[index], i, &std::pair<std::size_t, std::string>::first);
      report_thrown(entity, fault == faults[index].end() ? std::string() : fault->second);
    }
    faults[index].clear();
  }
  incidents.tell(options.log, false);
}

void World::Impl::write(std::uint32_t robot, hal::Severity severity, std::string_view text,
                        std::uint32_t left_out) noexcept {
  const std::string name = space.robot_name({robot, stores().robots[robot].generation});
  if (last_errors && severity == hal::Severity::Error)
    return last_errors->note(number_of(robot), "robot '" + name + "'", at_tick() + ": " + std::string(text));
  take_message(robot, {severity, hal::message_of(name, tick, text, left_out)});
}

void World::Impl::keep(std::uint32_t robot, hal::Severity severity, std::string_view text) noexcept {
  const std::uint32_t generation = stores().robots[robot].generation;
  take_message(robot, {severity, hal::message_of(space.robot_name({robot, generation}), tick, text, 0), true});
}

void World::Impl::take_message(std::uint32_t robot, Message message) {
  if (!in_controllers) return report(message);
  said[stores().robots[robot].block].push_back(std::move(message));
  any_said.store(true, std::memory_order_relaxed);
}

void World::Impl::report(const Message& message) const {
  (message.excess ? options.excess_log : options.log).write(message.severity, message.text);
}

/// In the order of blocks and slots, for any number of threads.
void World::Impl::report_messages() {
  if (!any_said.exchange(false, std::memory_order_relaxed)) return;
  for (std::vector<Message>& block : said) {
    for (const Message& message : block) report(message);
    block.clear();
  }
}

void World::Impl::paint_fields() {
  for (const Fields::Entry& entry : stores().fields.all()) {
    if (!entry.field->painted_by_hooks() || !entry.field->unpainted()) continue;
    hook_phase = entry.name.c_str();
    std::size_t who = 0;
    const Painter painter = [&, name = std::string_view(entry.name)](double x, double y, double painted) {
      for (who = 0; who < hooks.size(); ++who) {
        const hal::PluginCall marked(&name_hook, this, who);
        painted = hooks[who]->field(name, x, y).value_or(painted);
      }
      return painted;
    };
    if (const auto why = thrown([&] { entry.field->paint(painter); }))
      fail("hook '" + hook_names.at(who) + "' threw in " + entry.name + at_tick() + *why);
  }
}

void World::Impl::name_step(const void* impl, std::size_t block, std::size_t index, hal::FixedText& out) noexcept {
  const Impl& w = *static_cast<const Impl*>(impl);
  w.factory->name_controller(block, index, out);
  out << " at tick " << w.tick;
}

void World::Impl::name_hook(const void* impl, std::size_t hook, std::size_t /*index*/, hal::FixedText& out) noexcept {
  const Impl& w = *static_cast<const Impl*>(impl);
  out << "hook '" << w.hook_names[hook] << "' (library '" << w.scenario.hooks[hook].library << "') in " << w.hook_phase
      << " at tick " << w.tick;
}

template <class Call>
void World::Impl::call_hooks(const char* phase, Call&& call) {
  for (std::size_t i = 0; i < hooks.size(); ++i) {
    HookContext context = hook_context();
    const std::string why = asked(i, phase, [&](Hook& hook) { call(hook, context); });
    if (!why.empty()) fail(why);
  }
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

World::~World() {
  Impl& w = *impl_;
  w.last_errors.emplace();
  destroy_controllers(w.stores());
  w.last_errors->tell(w.options.log, true, hal::Severity::Error);
  w.last_errors.reset();
  w.hook_phase = "its destructor";
  for (std::size_t i = 0; i < w.hooks.size(); ++i) {
    const hal::PluginCall marked(&Impl::name_hook, &w, i);
    w.hooks[i].reset();
  }
}

void World::start() {
  impl_->call_hooks("before_run", [](Hook& hook, HookContext& c) { hook.before_run(c); });
  do_requests(true);
}

void World::finish() {
  impl_->incidents.tell(impl_->options.log, true);
  impl_->call_hooks("after_run", [](Hook& hook, HookContext& c) { hook.after_run(c); });
}

/// What hooks asked for while they were called.
void World::do_requests(bool before_first_step) {
  KeptCheckpoints& checkpoints = impl_->kept_checkpoints;
  const std::vector<KeptCheckpoints::Request> requests = std::exchange(checkpoints.requests, {});
  for (const KeptCheckpoints::Request& request : requests) {
    if (impl_->state == RunState::Failed) return;
    if (request.kind == KeptCheckpoints::Request::Kind::Reset) {
      if (before_first_step)
        return impl_->fail("a hook asked in before_run for a reset, which would come to before_run again");
      if (const hal::Status begun = reset(request.seed); !begun.ok()) impl_->fail("reset: " + begun.error().message);
      return;  // what else was asked for is gone with the run
    }
    if (request.kind == KeptCheckpoints::Request::Kind::Save) {
      hal::Result<Snapshot> kept = snapshot();
      if (!kept.ok()) {
        checkpoints.forget(request.name);
        return impl_->fail("checkpoint '" + request.name + "': " + kept.error().message);
      }
      checkpoints.kept.insert_or_assign(request.name, std::move(kept.value()));
    } else {
      const hal::Status gone_back = restore(Snapshot(checkpoints.kept.at(request.name)));
      if (!gone_back.ok()) return impl_->fail("checkpoint '" + request.name + "': " + gone_back.error().message);
    }
  }
}

std::size_t World::hooks() const noexcept {
  return impl_->hooks.size();
}
const std::string& World::hook_name(std::size_t hook) const noexcept {
  return impl_->hook_names[hook];
}

namespace {

/// An error for people of what `thrown` gave.
hal::Status told_of(const std::optional<std::string>& why) {
  if (!why) return {};
  return hal::Error{why->empty() ? "it threw what is no std::exception" : why->substr(2)};  // behind the colon
}

}  // namespace

hal::Status World::visit_controls(std::size_t hook, hal::Controls& controls) {
  Impl& w = *impl_;
  if (hook >= w.hooks.size()) return hal::Error{"there is no such hook"};
  w.hook_phase = "controls";
  const hal::PluginCall marked(&Impl::name_hook, &w, hook);
  HookContext context = w.hook_context();
  return told_of(thrown([&] { w.hooks[hook]->controls(context, controls); }));
}

hal::Status World::visit_controls(RobotId robot, hal::Controls& controls) {
  Impl& w = *impl_;
  SpaceStores& s = w.stores();
  if (!s.contains(robot)) return hal::Error{"there is no such robot any more"};
  const RobotEntity& entity = s.robots[robot.index];
  const RobotBlock& block = s.blocks[entity.block];
  const hal::ControllerType& type = *s.groups[block.group].controller;
  if (block.constructed[entity.slot] == 0 || type.controls == nullptr) return {};
  const hal::PluginCall marked(&Impl::name_step, &w, entity.block, entity.slot);
  return told_of(thrown([&] { type.controls(block.controller(entity.slot), controls); }));
}

void World::set_log(const hal::Log& log) {
  impl_->options.log = log;
}
void World::set_external(ExternalRobots* external) noexcept {
  impl_->external = external;
}
void World::set_steps_elsewhere(RobotId robot, bool elsewhere) {
  std::erase_if(impl_->elsewhere, [&](RobotId other) { return other == robot || !impl_->space.contains(other); });
  if (elsewhere) impl_->elsewhere.push_back(robot);
}
void World::controller_threw(RobotId robot, std::string what) {
  const SpaceStores& s = impl_->stores();
  if (!s.contains(robot)) return;
  const RobotEntity& entity = s.robots[robot.index];
  impl_->note_thrown(entity.block, entity.slot, std::move(what));
}
void World::fail(std::string why) {
  impl_->fail(std::move(why));
}
RunState World::state() const noexcept {
  return impl_->state;
}
const std::string& World::failure() const noexcept {
  return impl_->failure;
}
hal::Tick World::tick() const noexcept {
  return impl_->tick;
}
std::int64_t World::ticks_per_second() const noexcept {
  return impl_->scenario.ticks_per_second;
}
std::uint64_t World::seed() const noexcept {
  return impl_->seed;
}
std::int64_t World::threads() const noexcept {
  return static_cast<std::int64_t>(impl_->pool->size());
}
const Scenario& World::scenario() const noexcept {
  return impl_->scenario;
}
Space& World::space() noexcept {
  return impl_->space;
}
const Space& World::space() const noexcept {
  return impl_->space;
}

const Incidents& World::incidents() const noexcept {
  Incidents& i = impl_->incidents;
  i.commands_clamped = 0;
  i.commands_not_finite = 0;
  for (const std::uint64_t n : impl_->clamped) i.commands_clamped += n;
  for (const std::uint64_t n : impl_->not_finite) i.commands_not_finite += n;
  return i;
}

const Measures& World::measures() const noexcept {
  return impl_->measures;
}

PhysicsAccuracy World::accuracy() const {
  PhysicsAccuracy all = impl_->accuracy_before;
  for (const auto& engine : impl_->engines) all.add(engine->accuracy());
  return all;
}

std::uint64_t World::state_hash() const noexcept {
  return fingerprint(state_view());
}

StateView World::state_view() const noexcept {
  return {impl_->stores(), impl_->seed, impl_->tick};
}

}  // namespace tandem::core
