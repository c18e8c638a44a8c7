#include "controllers/lua_controller/lua_controller.hpp"

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "controllers/lua_controller/sources.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::controllers::lua {

namespace {

hal::DeviceList& list_of(hal::Robot& robot) {
  auto* const list = dynamic_cast<hal::DeviceList*>(&robot);
  if (list == nullptr) throw hal::DeviceError("is in a world that does not tell which devices its configuration lists");
  return *list;
}

}  // namespace

/// The interpreters of one configuration: a new one begins where a robot's controller does not lie in the same block.
/// They run the configuration's present script, but those of robots whose controllers have not got it yet.
class Interpreters {
 public:
  /// The script that new robots get.
  std::shared_ptr<const Script> present(const LuaController::Params& params) {
    const std::lock_guard hold(lock_);
    if (present_ == nullptr) present_ = read(params);
    return present_;
  }
  /// True once.
  bool first_use() noexcept { return !used_.exchange(true); }
  void set_present(const std::shared_ptr<const Script>& script) {
    const std::lock_guard hold(lock_);
    present_ = script;
  }
  /// The same script with other files. Robot by robot is handed the same files: they get the same script.
  std::shared_ptr<const Script> changed(const Script& from, const std::vector<hal::SourceFile>& files) {
    auto script = std::make_shared<Script>(from);
    script->files = read_sources(from.path, from.files.front().name, files);
    const std::lock_guard hold(lock_);
    if (present_ != nullptr && hal::packed(present_->files) == hal::packed(script->files)) return present_;
    return script;
  }

  std::shared_ptr<Interpreter> place(const void* controller, const std::shared_ptr<const Script>& script,
                                     const hal::RobotKind& kind, const std::vector<hal::ListedDevice>& devices) {
    const std::lock_guard hold(lock_);
    const auto at = reinterpret_cast<std::uintptr_t>(controller);
    for (Place& place : places_) {
      const bool near = at >= place.first && at < place.first + kReach;
      auto found = place.interpreter.lock();
      if (near && found != nullptr && &found->script() == script.get() && fits(*found, kind, devices)) return found;
    }
    std::erase_if(places_, [](const Place& place) { return place.interpreter.expired(); });
    auto made = std::make_shared<Interpreter>(script, kind, devices);
    places_.push_back({at, made});
    return made;
  }

 private:
  static constexpr std::size_t kReach = 256 * ((sizeof(LuaController) + 63) / 64 * 64);  // a block of the simulation
  struct Place {
    std::uintptr_t first;
    std::weak_ptr<Interpreter> interpreter;
  };

  static std::shared_ptr<const Script> read(const LuaController::Params& params) {
    if (params.script.empty()) throw std::runtime_error("has no script; say which: <params script=\"diffusion.lua\"/>");
    auto script = std::make_shared<Script>();
    script->path = params.script;
    script->files = read_sources(params.script, params.written, {});
    script->strict = params.strict;
    script->argos = params.argos;
    script->allow_io = params.allow_io;
    script->most_instructions = params.most_instructions;
    script->most_memory = static_cast<std::uint64_t>(params.most_memory_MiB) << 20U;
    script->params = params.others;
    script->params.push_back({"script", params.script});
    return script;
  }

  static bool fits(const Interpreter& one, const hal::RobotKind& kind, const std::vector<hal::ListedDevice>& devices) {
    if (&one.kind() != &kind || one.devices().size() != devices.size()) return false;
    for (std::size_t i = 0; i < devices.size(); ++i) {
      if (one.devices()[i].type != devices[i].port || one.devices()[i].written != devices[i].written) return false;
    }
    return true;
  }

  std::mutex lock_;
  std::atomic<bool> used_{false};
  std::shared_ptr<const Script> present_;
  std::vector<Place> places_;
};

LuaController::Params::Params() : interpreters(std::make_shared<Interpreters>()) {}

void LuaController::Params::describe(hal::ParamVisitor& v) {
  v.text("script", script, "The script, in Lua 5.4. Modules that it requires lie beneath its folder.");
  written = script;
  v.text(hal::kPathParam, script, "");
  if (hal::in_argos_file(v)) argos = true;
  v.flag("argos", argos,
         "Readings of an e-puck by its own curve, random.bernoulli as a truth value, random.uniform_int as a float, "
         "bytes of messages that wrap: as ARGoS has them. Left out in an ARGoS file: true.");
  v.flag(
      "allow_io", allow_io,
      "The script has io, os, loadfile and package.path of Lua, and dofile takes any path; its runs need not repeat. "
      "The option --allow-io sets it for all scripts.");
  v.flag("strict", strict, "Reading a global that nothing was assigned to is an error.");
  v.integer(
      "most_instructions", most_instructions, {100'000.0, 1e15},
      "Of one call of a function, where a loop goes on or a function is called; a call that takes more is an error.");
  v.integer("most_memory", most_memory_MiB, {1.0, 1e6},
            "MiB that a robot's variables may hold from step to step; one call may take 16 times as much.");
  hal::describe_others(v, others, "Handed to the script as robot.params.NAME, a text.");
}

/// Takes all devices that the configuration lists.
void LuaController::take(hal::Robot& robot) {
  const std::vector<Device>& devices = shared_->interpreter->devices();
  hal::DeviceList& list = list_of(robot);
  for (std::size_t i = 0; i < devices.size(); ++i) actor_.ports[i] = list.port(*devices[i].type);
  start_outputs();
  actor_.random = first_random_ = robot.random();
  actor_.run_seed = robot.run_seed();
  actor_.log = robot.log();
  actor_.id = robot.id();
}

/// ARGoS' robots send in every step, whatever they say.
void LuaController::start_outputs() {
  const Interpreter& in = *shared_->interpreter;
  for (std::size_t i = 0; i < in.devices().size(); ++i) {
    const hal::PortType& type = *in.devices()[i].type;
    if (in.devices()[i].api == nullptr || type.plain_name() != hal::RangeAndBearingSend::kName ||
        type.role != hal::Role::Actuator)
      continue;
    hal::set_value(actor_.ports[i], *type.field("sending"), 0, 1.0);
    hal::set_value(actor_.ports[i], *type.field("size"), 0,
                   static_cast<double>(hal::message_bytes(in.kind(), type.field("payload")->count)));
  }
}

LuaController::LuaController(hal::Robot& robot, const Params& params)
    : interpreters_(params.interpreters), shared_(std::make_shared<Shared>()) {
  const auto script = interpreters_->present(params);
  try {
    shared_->interpreter = interpreters_->place(this, script, robot.kind(), list_of(robot).devices());
    take(robot);
    if (script->allow_io && interpreters_->first_use())
      actor_.log.warning("its script may use files, the clock and the environment (allow_io): the run need not repeat");
    const std::lock_guard hold(shared_->interpreter->lock());
    shared_->variables = shared_->interpreter->begin(actor_);
  } catch (const std::exception& e) {
    if (length_of_place(e.what()) == 0) throw;  // it goes on from the robot's name
    throw std::runtime_error(std::string("cannot run its script: ") + e.what());
  }
  shared_->active = this;
}

// Whose controllers are copied is or becomes the world, so what they run is what robots get that are added.
LuaController::LuaController(const LuaController& other)
    : hal::Controller(other),
      interpreters_(other.interpreters_),
      shared_(other.shared_),
      actor_(other.actor_),
      first_random_(other.first_random_) {
  interpreters_->set_present(shared_->interpreter->shared_script());
  const std::lock_guard hold(shared_->interpreter->lock());
  Interpreter& in = *shared_->interpreter;
  const bool active = shared_->active == &other;
  kept_ = active ? in.keep(shared_->variables) : in.share(other.kept_);
  account_ = active ? shared_->variables.account : other.account_;
  ++shared_->copies;
}

LuaController::~LuaController() {
  leave();
}

/// Its variables end, where no copy has them.
void LuaController::leave() noexcept {
  const std::shared_ptr<Shared> shared = shared_;
  const std::lock_guard hold(shared->interpreter->lock());
  Interpreter& in = *shared->interpreter;
  in.forget(kept_);
  kept_ = LUA_NOREF;
  if (shared->active == this) {
    shared->active = nullptr;
    if (shared->copies == 1) {
      try {
        in.call(actor_, shared->variables, "destroy");
      } catch (const std::exception& e) {
        actor_.log.error(std::string("in destroy(): ") + e.what());
      }
      finalize(in, *shared);
    }
  }
  if (--shared->copies == 0) in.end(shared->variables);
}

/// Calls `__gc` of the robot's objects, the last one that got it first.
void LuaController::finalize(Interpreter& in, Shared& shared) noexcept {
  for (bool more = true; more;) {
    try {
      more = in.finalize_last(actor_, shared.variables);
    } catch (const std::exception& e) {
      actor_.log.error(std::string("in __gc: ") + e.what());
    }
  }
}

void LuaController::controls(hal::Controls& controls) {
  std::string files = hal::packed(shared_->interpreter->script().files);
  if (controls.text(hal::kSourceFilesControl, files, "The script and its modules.")) begin_anew(hal::unpacked(files));
}

/// Another script takes over, as if this robot were just made, where it can; else all is as it was. Between steps.
void LuaController::begin_anew(const std::vector<hal::SourceFile>& files) {
  const Interpreter& before = *shared_->interpreter;
  const auto script = interpreters_->changed(before.script(), files);
  std::vector<hal::ListedDevice> devices;
  std::vector<std::vector<std::byte>> outputs(before.devices().size());
  for (std::size_t i = 0; i < before.devices().size(); ++i) {
    const Device& device = before.devices()[i];
    devices.push_back({device.type, device.written});
    if (device.type->role != hal::Role::Actuator) continue;
    const auto* const bytes = static_cast<const std::byte*>(actor_.ports[i]);
    outputs[i].assign(bytes, bytes + device.type->size);
    device.type->reset(actor_.ports[i]);
  }
  start_outputs();
  auto fresh = std::make_shared<Shared>();
  Actor actor = actor_;
  actor.random = first_random_;
  actor.omni_on = actor.perspective_on = false;
  try {
    fresh->interpreter = interpreters_->place(this, script, before.kind(), devices);
    const std::lock_guard hold(fresh->interpreter->lock());
    fresh->variables = fresh->interpreter->begin(actor);
  } catch (...) {
    for (std::size_t i = 0; i < outputs.size(); ++i)
      std::copy(outputs[i].begin(), outputs[i].end(), static_cast<std::byte*>(actor_.ports[i]));
    throw;
  }
  interpreters_->set_present(script);
  leave();
  fresh->active = this;
  shared_ = std::move(fresh);
  actor_ = std::move(actor);
}

/// The variables become this copy's. The interpreter is locked.
void LuaController::activate() {
  if (shared_->active == this) return;
  Interpreter& in = *shared_->interpreter;
  if (shared_->active != nullptr) {
    shared_->active->kept_ = in.keep(shared_->variables);
    shared_->active->account_ = shared_->variables.account;
  }
  shared_->active = nullptr;
  in.put_back(shared_->variables, kept_);
  shared_->variables.account = account_;
  in.forget(kept_);
  kept_ = LUA_NOREF;
  shared_->active = this;
}

bool LuaController::reset(hal::Robot& robot) {
  const std::lock_guard hold(shared_->interpreter->lock());
  activate();
  Interpreter& in = *shared_->interpreter;
  if (!in.has(shared_->variables, "reset")) return false;
  actor_ = {};
  take(robot);
  return in.call(actor_, shared_->variables, "reset");
}

/// Robots of a row that have the same interpreter, from one on.
struct LuaController::Row {
  std::byte* first;
  std::size_t stride, count;
  const std::uint8_t* halted;
  hal::StepFault& fault;
  const Shared* shared;  // of the robot that the interpreter is of
  std::size_t next;

  LuaController& at(std::size_t i) const noexcept {
    return *std::launder(reinterpret_cast<LuaController*>(first + i * stride));
  }
  /// What the two that follow will use is on its way to the cache.
  [[gnu::always_inline]] void prefetch() const noexcept {  // not inline, GCC leaves it out: it returns nothing
    if (next + 1 < count) __builtin_prefetch(at(next + 1).shared_.get());
    if (next < count) at(next).shared_->variables.prefetch();
  }
  void skip_halted() noexcept {
    while (next < count && halted[next] != 0) ++next;
  }
};

std::size_t LuaController::step_row(std::byte* first, std::size_t stride, std::size_t begin, std::size_t count,
                                    const std::uint8_t* halted, hal::StepFault& fault) {
  Row row{first, stride, count, halted, fault, nullptr, begin};
  for (row.skip_halted(); row.next < count; row.skip_halted()) {
    __atomic_store_n(&fault.index, row.next, __ATOMIC_RELAXED);
    LuaController& one = row.at(row.next);
    Interpreter& in = *one.shared_->interpreter;
    const std::lock_guard hold(in.lock());
    try {
      one.activate();
    } catch (const std::exception& e) {
      fault.message = e.what();
      fault.index = row.next;
      return row.next;
    }
    row.shared = one.shared_.get();
    std::string why = in.step(
        [](void* job) -> Interpreter::Turn {
          Row& r = *static_cast<Row*>(job);
          r.skip_halted();
          if (r.next == r.count) return {};
          LuaController& turn = r.at(r.next);
          Shared& shared = *turn.shared_;
          if (shared.interpreter.get() != r.shared->interpreter.get() || shared.active != &turn) return {};
          __atomic_store_n(&r.fault.index, r.next, __ATOMIC_RELAXED);
          ++r.next;
          r.prefetch();
          return {&turn.actor_, &shared.variables};
        },
        &row);
    if (why.empty()) continue;
    fault.message = std::move(why);
    fault.index = row.next - 1;
    return row.next - 1;
  }
  return count;
}

void LuaController::step() {
  hal::StepFault fault;
  const std::uint8_t running = 0;
  if (step_row(reinterpret_cast<std::byte*>(this), sizeof *this, 0, 1, &running, fault) == 0)
    throw std::runtime_error(fault.message);
}

}  // namespace tandem::controllers::lua
