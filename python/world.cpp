#include "python/world.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <pybind11/stl.h>

#include "app/experiment/plugin_folders.hpp"
#include "app/process/progress.hpp"
#include "core/config/reader.hpp"
#include "core/hook/hook.hpp"
#include "core/schedule/thread_pool.hpp"
#include "core/space/stores.hpp"
#include "library/open_world.hpp"
#include "python/guests.hpp"

namespace tandem::python {
namespace {

std::string text_of(const core::Problems& problems, bool warnings) {
  std::string text;
  for (const core::Problem& problem : problems) {
    if (problem.warning == warnings) text += (text.empty() ? "" : "\n") + core::to_text(problem);
  }
  return text;
}

void warn(const std::string& text) {
  if (!text.empty() && PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 2) != 0) throw py::error_already_set();
}

/// Calls at times that Python asks for: now and then, not every tick.
class Interrupts {
 public:
  /// With Python's lock held. @throws py::error_already_set for Ctrl-C
  static void look() {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  bool due() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return false;
    next_ = now + std::chrono::milliseconds(50);
    return true;
  }

 private:
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
};

}  // namespace

bool changes_at_reset(const std::string& parameter) {
  const std::string path = parameter.substr(0, parameter.find('='));
  return path.find(".params.") != std::string::npos || path.starts_with("loop_functions") ||
         path == "framework.experiment.length";
}

// --- use ---

Use::Use(World& world, How how) : world_(world) {
  if (world.closed()) throw std::runtime_error("this world was closed; make another one");
  const std::thread::id me = std::this_thread::get_id();
  if (world.uses_ > 0 && world.user_.load() != me) {
    throw std::runtime_error(
        "another thread is using this world: a world is for one thread at a time. Make one world a thread, "
        "or wait until its step returns");
  }
  if (world.uses_ > 0 && how == How::Alone)
    throw std::runtime_error("this cannot be called by a controller, hook or policy while the same world steps");
  world.user_ = me;
  ++world.uses_;
}

Use::~Use() {
  --world_.uses_;
}

// --- making ---

core::Scenario World::read(const std::vector<std::string>& parameters, std::string& warnings) const {
  core::Problems problems;
  auto scenario = library::read_scenario(
      session_->loader,
      {.file = request_.file, .text = request_.text, .parameters = parameters, .plugins = request_.plugins}, problems);
  warnings = text_of(problems, true);
  if (!scenario) throw ExperimentError(text_of(problems, false));
  invite(*scenario);
  return std::move(*scenario);
}

/// Gives Python's controllers and hooks their places.
void World::invite(core::Scenario& scenario) const {
  const auto take = [&](core::ControllerConfig& config, const std::string& label, const std::string& key) {
    const auto add_key = [&](core::Element& params) {
      if (!key.empty()) params.attributes.push_back({kKey, key, 0});
    };
    const auto at = static_cast<std::size_t>(&config - scenario.controllers.data());
    config.library = std::string(hal::Catalog::kInside);
    config.label = label;
    if (key.empty()) config.params.attributes.clear();
    add_key(config.params);
    for (core::RobotItem& robot : scenario.robots) {
      if (robot.controller != at || !robot.params) continue;
      if (key.empty())
        robot.params.reset();
      else
        add_key(*robot.params);
    }
  };
  const auto find = [&](const std::string& id) -> core::ControllerConfig& {
    std::vector<std::string> known;
    for (core::ControllerConfig& config : scenario.controllers) {
      if (config.id == id) return config;
      known.push_back(config.id);
    }
    throw ExperimentError(request_.file + ": there is no controller '" + id + "'; there are: " + core::listed(known) +
                          core::did_you_mean(id, known));
  };
  for (const std::string& id : request_.driven) {
    if (id == "*") {
      for (core::ControllerConfig& config : scenario.controllers) take(config, kDriven, "");
    } else {
      take(find(id), kDriven, "");
    }
  }
  for (const auto& [id, key] : controller_keys_) take(find(id), kPythonController, key);
  if (!controller_keys_.empty()) scenario.threads = 0;  // Python's lock lets one step at a time
  for (const std::string& key : hook_keys_) {
    core::HookConfig hook;
    hook.library = std::string(hal::Catalog::kInside);
    hook.label = kPythonHook;
    hook.options.name = "loop_functions";
    hook.options.file = request_.file;
    hook.options.attributes = {{"library", hook.library, 0}, {"label", hook.label, 0}, {kKey, key, 0}};
    scenario.hooks.push_back(std::move(hook));
  }
}

World::World(WorldRequest request)
    : session_(std::make_shared<Session>(app::plugin_folders(), catalog())),
      request_(std::move(request)),
      parameters_(request_.parameters) {
  session_->owner = this;
  for (const auto& [id, guest] : request_.controllers)
    controller_keys_.emplace_back(id.cast<std::string>(),
                                  keep_guest(session_, py::reinterpret_borrow<py::object>(guest)));
  for (const py::handle hook : request_.hooks)
    hook_keys_.push_back(keep_guest(session_, py::reinterpret_borrow<py::object>(hook)));
  request_.controllers = py::dict();
  request_.hooks = py::list();
  std::string warnings;
  const core::Scenario scenario = read(parameters_, warnings);
  length_s_ = scenario.length_s;
  core::WorldOptions options;
  options.seed = request_.seed;
  options.threads = request_.threads;
  if (!controller_keys_.empty()) options.threads = 0;
  options.log = hal::Log(
      [session = session_.get()](hal::Severity severity, std::string_view text) { session->note(severity, text); });
  core::Problems problems;
  {
    const py::gil_scoped_release unlocked;
    session_->world = core::World::make(scenario, session_->loader, options, problems);
  }
  if (session_->world == nullptr) {
    session_->owner = nullptr;
    throw ExperimentError(text_of(problems, false));
  }
  if (std::string more = text_of(problems, true); !more.empty()) warnings += (warnings.empty() ? "" : "\n") + more;
  try {
    open_run(request_.record);
  } catch (...) {
    session_->owner = nullptr;
    throw;
  }
  warn(warnings);
}

/// A run of the world as it is now, with its parts. @throws ExperimentError
void World::open_run(const std::string& record) {
  session_->stop = false;
  session_->run = std::make_unique<core::Run>(*session_->world, session_->stop);
  core::Problems problems;
  library::add_parts(*session_->run, session_->loader, record, problems);
  if (!core::has_errors(problems)) return;
  session_->run = std::make_unique<core::Run>(*session_->world, session_->stop);
  throw ExperimentError(text_of(problems, false));
}

/// Its parts end, before its end where that did not come. The world goes on.
void World::leave_run() {
  if (!started_ || finished_) return;
  session_->stop = session_->world->state() == core::RunState::Running;
  session_->run->leave();  // with Python's lock: the collector may be at work
}

World::~World() {
  if (session_ != nullptr) close();
}

void World::close() {
  if (session_ == nullptr) return;
  if (uses_ > 0) throw std::runtime_error("this world is in use: it cannot be closed now");
  session_->owner = nullptr;
  leave_run();
  session_->run.reset();
  // Python's controllers may hold arrays, which hold the session: they go first.
  core::destroy_controllers(session_->world->space().stores());
  policies_.clear();
  session_.reset();
}

int World::visit(visitproc take, void* argument) const {
  if (session_ == nullptr) return 0;
  for (PyObject* const object : session_->held) {
    if (const int done = take(object, argument); done != 0) return done;
  }
  return 0;
}

void World::collect() noexcept {
  if (session_ != nullptr && uses_ == 0) close();
}

void World::start() {
  const Use use(*this);
  if (std::exchange(started_, true)) return;
  {
    const py::gil_scoped_release unlocked;
    finished_ = !session_->run->begin();
  }
  raise_failure();
}

void World::raise_failure() {
  if (session_->world->state() == core::RunState::Failed) throw RunFailed(session_->world->failure());
  if (!session_->run->failure().empty()) throw RunFailed(session_->run->failure());
}

// --- stepping ---

/// One tick, with or without Python's lock. False: the run has ended.
bool World::tick_unlocked() {
  core::World& world = *session_->world;
  if (world.state() != core::RunState::Running) return false;
  if (session_->writes) world.limit_commands();
  return session_->run->tick() && world.state() == core::RunState::Running;
}

void World::step_unlocked(std::int64_t ticks) noexcept {
  user_ = std::this_thread::get_id();
  session_->write_arrays();
  for (std::int64_t t = 0; t < ticks; ++t) tick_unlocked();
  session_->read_arrays();
}

void World::call_policies() {
  if (policies_.empty() || session_->world->state() == core::RunState::Failed) return;
  session_->writes = true;
  const auto all = Swarm::all(session_);
  for (const auto& [controller, policy] : policies_) {
    for (const auto& swarm : all) {
      if (swarm->controller() == controller) policy(swarm);
    }
  }
}

std::int64_t World::step(std::int64_t ticks) {
  return step(ticks, nullptr);
}

std::int64_t World::step(std::int64_t ticks, app::Progress* progress) {
  const Use use(*this, Use::How::Alone);
  if (ticks < 0) throw py::value_error("a world cannot make " + std::to_string(ticks) + " steps");
  if (finished_) throw std::runtime_error("this run is finished; reset() begins it anew");
  const hal::Tick before = session_->world->tick();
  std::int64_t done = 0;
  bool goes_on = true;
  Interrupts interrupts;
  while (goes_on && done < ticks) {
    {
      const py::gil_scoped_release unlocked;
      session_->write_arrays();
      do {
        goes_on = tick_unlocked();
        ++done;
      } while (goes_on && done < ticks && policies_.empty() && !interrupts.due());
      session_->read_arrays();
    }
    call_policies();
    Interrupts::look();
    if (progress != nullptr) progress->step(session_->world->tick() - before);
  }
  raise_failure();
  return session_->world->tick() - before;
}

std::int64_t World::steps_left(std::optional<double> until_s) {
  core::World& world = *session_->world;
  if (!until_s && !(length_s_ > 0.0)) return -1;
  const double end_s = until_s.value_or(length_s_);
  const double end = end_s * static_cast<double>(world.ticks_per_second());
  if (!(std::abs(end) < 1e15)) throw py::value_error("the end of a run is a time in s; this is none, or too far away");
  const auto ticks = static_cast<std::int64_t>(end + 0.5);
  return std::max<std::int64_t>(0, ticks - world.tick());
}

std::int64_t World::run(std::optional<double> until_s, bool progress) {
  std::int64_t left = 0;
  {
    const Use use(*this);
    left = steps_left(until_s);
    if (left < 0 && session_->world->hooks() == 0)
      throw py::value_error("this experiment has no length, and no hook that could end it: say run(until=seconds)");
  }
  std::int64_t done = 0;
  if (left >= 0) {
    std::optional<app::Progress> shown;
    if (progress) shown.emplace(left, session_->world->ticks_per_second(), "run");
    done = step(left, shown ? &*shown : nullptr);
  } else {
    while (session_->world->state() == core::RunState::Running) done += step(1000);
  }
  if (!until_s) finish();
  return done;
}

void World::finish() {
  const Use use(*this, Use::How::Alone);
  if (std::exchange(finished_, true)) return;
  {
    const py::gil_scoped_release unlocked;
    session_->run->end();
  }
  raise_failure();
}

void World::reset(std::optional<std::uint64_t> seed, const std::optional<std::vector<std::string>>& parameters,
                  const std::string& record) {
  const Use use(*this, Use::How::Alone);
  core::World& world = *session_->world;
  std::optional<core::Scenario> changed;
  if (parameters) {
    std::vector<std::string> all = request_.parameters;
    for (const std::string& one : *parameters) {
      if (!changes_at_reset(one)) {
        throw py::value_error(
            "'" + one.substr(0, one.find('=')) +
            "' cannot change without building the world anew: a reset takes over parameters of controllers "
            "(…params.…), those of hooks (loop_functions.…) and framework.experiment.length. Make another "
            "tandem.World with it");
      }
      all.push_back(one);
    }
    if (all != parameters_) {
      std::string warnings;
      changed = read(all, warnings);
      if (const hal::Status can = world.can_reset(*changed); !can.ok()) throw ExperimentError(can.error().message);
      parameters_ = std::move(all);
      length_s_ = changed->length_s;
      warn(warnings);
    }
  }
  leave_run();
  finished_ = started_ = true;
  hal::Status begun;
  {
    const py::gil_scoped_release unlocked;
    begun = world.reset(seed.value_or(world.seed()), changed ? &*changed : nullptr);
  }
  Swarm::renew(session_, true);
  session_->read_arrays();
  open_run(record);
  if (!begun.ok()) throw RunFailed(begun.error().message);
  finished_ = !session_->run->join();
  raise_failure();
  for (const auto& [controller, policy] : policies_) {
    if (py::hasattr(policy, "reset")) policy.attr("reset")(world.seed());
  }
}

std::shared_ptr<Snapshot> World::snapshot() {
  const Use use(*this, Use::How::Alone);
  hal::Result<core::Snapshot> taken = [&] {
    const py::gil_scoped_release unlocked;
    session_->write_arrays();
    return session_->world->snapshot_of_all();
  }();
  if (!taken.ok()) throw std::runtime_error(taken.error().message);
  return std::make_shared<Snapshot>(Snapshot{session_, std::move(taken).value()});
}

void World::restore(const Snapshot& snapshot) {
  const Use use(*this, Use::How::Alone);
  hal::Status back;
  {
    const py::gil_scoped_release unlocked;
    back = session_->world->restore(snapshot.moment);
  }
  if (!back.ok()) throw std::runtime_error(back.error().message);
  Swarm::renew(session_, false);
  session_->read_arrays();
  const hal::Tick tick = session_->world->tick();
  if (finished_) {  // its run is over, and this is another
    open_run({});
    finished_ = !session_->run->join();
  }
  session_->run->tell(tick, {{"kind", "back"}, {"to", tick}});
  raise_failure();
}

void World::add_policy(const std::string& controller, py::object policy) {
  const Use use(*this);
  const auto& configs = session_->world->scenario().controllers;
  if (std::none_of(configs.begin(), configs.end(), [&](const core::ControllerConfig& c) { return c.id == controller; }))
    throw py::key_error("there is no controller '" + controller + "'");
  if (PyCallable_Check(policy.ptr()) == 0)
    throw py::type_error("a policy is called with a swarm after every step, and this is not callable");
  policies_.emplace_back(controller, std::move(policy));
}

bool World::has_guests() const noexcept {
  return !controller_keys_.empty() || !hook_keys_.empty() || !request_.driven.empty() || !policies_.empty();
}

std::string World::state() {
  if (closed()) return "closed";
  const Use use(*this);
  switch (session_->world->state()) {
    case core::RunState::Running:
      if (finished_) return "finished";
      return session_->run->ended_by() != nullptr ? "done" : "running";
    case core::RunState::Done:
      return "done";
    case core::RunState::Failed:
      break;
  }
  return "failed";
}

// --- many worlds ---

/// Worlds that are stepped side by side.
class Group {
 public:
  Group(std::vector<std::shared_ptr<World>> worlds, std::size_t threads)
      : worlds_(std::move(worlds)), pool_(threads, core::Assignment::Dynamic) {
    for (std::size_t i = 0; i < worlds_.size(); ++i) {
      if (std::find(worlds_.begin(), worlds_.begin() + static_cast<std::ptrdiff_t>(i), worlds_[i]) !=
          worlds_.begin() + static_cast<std::ptrdiff_t>(i))
        throw py::value_error("a world stands twice in the group");
    }
  }

  /// Each world makes so many ticks, or fewer where its run ends.
  void step(std::int64_t ticks) {
    std::vector<std::unique_ptr<Use>> uses;
    for (const auto& world : worlds_) uses.push_back(std::make_unique<Use>(*world, Use::How::Alone));
    bool policies = false;
    for (const auto& world : worlds_) {
      if (world->finished_) throw std::runtime_error("a run of the group is finished; reset() begins it anew");
      policies = policies || world->has_policies();
    }
    Interrupts interrupts;
    for (std::int64_t done = 0; done < ticks;) {
      const std::int64_t now = policies ? 1 : std::min<std::int64_t>(ticks - done, 100);
      {
        const py::gil_scoped_release unlocked;
        pool_.run(worlds_.size(), 1, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) worlds_[i]->step_unlocked(now);
        });
      }
      for (const auto& world : worlds_) world->user_ = std::this_thread::get_id();
      for (const auto& world : worlds_) world->call_policies();
      done += now;
      if (interrupts.due()) Interrupts::look();
    }
    for (const auto& world : worlds_) world->raise_failure();
  }
  const std::vector<std::shared_ptr<World>>& worlds() const noexcept { return worlds_; }

 private:
  std::vector<std::shared_ptr<World>> worlds_;
  core::ThreadPool pool_;
};

namespace {

/// Null: it is not made yet.
World* world_in(PyObject* self) {
  const auto held = reinterpret_cast<py::detail::instance*>(self)->get_value_and_holder();
  return held.holder_constructed() ? held.value_ptr<World>() : nullptr;
}

int traverse_world(PyObject* self, visitproc visit, void* argument) {
  if (const World* const world = world_in(self); world != nullptr) {
    if (const int done = world->visit(visit, argument); done != 0) return done;
  }
  return py::detail::pybind11_traverse(self, visit, argument);
}

int clear_world(PyObject* self) {
  if (World* const world = world_in(self); world != nullptr) world->collect();
  return py::detail::pybind11_clear(self);
}

}  // namespace

void bind_world(py::module_& m) {
  py::register_exception<ExperimentError>(m, "ExperimentError", PyExc_ValueError);
  py::register_exception<RunFailed>(m, "RunFailed", PyExc_RuntimeError);
  py::class_<Snapshot, std::shared_ptr<Snapshot>>(m, "Snapshot", "A moment of a world, to go back to.")
      .def_property_readonly("tick", [](const Snapshot& s) { return s.moment.tick(); })
      .def_property_readonly(
          "bytes", [](const Snapshot& s) { return s.moment.bytes(); }, "About how much memory it takes.");
  WorldClass world(m, "World", py::dynamic_attr(), py::custom_type_setup([](PyHeapTypeObject* heap) {
                     heap->ht_type.tp_traverse = &traverse_world;
                     heap->ht_type.tp_clear = &clear_world;
                   }));
  world
      .def(py::init([](std::string file, std::string text, std::optional<std::uint64_t> seed,
                       std::optional<std::int64_t> threads, std::vector<std::string> parameters, py::dict controllers,
                       std::vector<std::string> driven, py::list hooks, std::vector<std::string> plugins,
                       std::string record) {
             return std::make_shared<World>(WorldRequest{
                 std::move(file), std::move(text), seed, threads, std::move(parameters), std::move(controllers),
                 std::move(driven), std::move(hooks), std::move(plugins), std::move(record)});
           }),
           py::arg("file"), py::arg("text"), py::arg("seed"), py::arg("threads"), py::arg("parameters"),
           py::arg("controllers"), py::arg("driven"), py::arg("hooks"), py::arg("plugins"), py::arg("record"))
      .def("_start", &World::start)
      .def("step", py::overload_cast<std::int64_t>(&World::step), py::arg("ticks") = 1,
           "Makes so many ticks, fewer where the run ends; returns how many.")
      .def("run", &World::run, py::arg("until") = py::none(), py::arg("progress") = true,
           "Goes on to this time in s, or to the end that the experiment says; returns how many ticks were made. With "
           "progress, standard error shows after two seconds how far it is.")
      .def("finish", &World::finish, "Calls the hooks' after_run; run() to the end does it, too.")
      .def("_reset", &World::reset, py::arg("seed"), py::arg("parameters"), py::arg("record"))
      .def("snapshot", &World::snapshot, "Keeps this moment.")
      .def("restore", &World::restore, py::arg("snapshot"), "Goes back to a moment of this world.")
      .def("close", &World::close, "Ends the world. Arrays that were taken from it stay readable.")
      .def_property_readonly("closed", &World::closed)
      .def("add_policy", &World::add_policy, py::arg("controller"), py::arg("policy"),
           "Has policy(swarm) called after every step, for the robots under that configuration.")
      .def_property_readonly("state", &World::state, "'running', 'done', 'finished', 'failed' or 'closed'.")
      .def_property_readonly("parameters", &World::parameters,
                             "What was set on top of the experiment, as 'path=value'.")
      .def_property_readonly("has_guests", &World::has_guests, "Whether something of Python takes part.");
  bind_looks(world);
  py::class_<app::Progress>(m, "Progress", "How far something long is, on standard error.")
      .def(py::init<std::int64_t, std::int64_t, std::string, std::string>(), py::arg("total"), py::arg("per_unit"),
           py::arg("name"), py::arg("unit"))
      .def(
          "step", [](app::Progress& progress, std::int64_t done) { progress.step(done); }, py::arg("done"));
  py::class_<Group>(m, "Group", "Worlds that are stepped side by side on threads of their own.")
      .def(py::init<std::vector<std::shared_ptr<World>>, std::size_t>(), py::arg("worlds"), py::arg("threads"))
      .def("step", &Group::step, py::arg("ticks") = 1, "Each world makes so many ticks, fewer where its run ends.")
      .def_property_readonly("worlds", &Group::worlds);
}

}  // namespace tandem::python
