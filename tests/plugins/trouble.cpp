// A controller and a hook that do to the whole program what no plug-in should.
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "core/hook/hook.hpp"
#include "core/record/observer.hpp"
#include "core/run/part_type.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

std::size_t endless_stack(volatile char* outer) {
  if (outer[0] == 0) return 0;  // never
  volatile char frame[4096];
  frame[0] = outer[0];
  frame[4095] = frame[0];
  return static_cast<std::size_t>(frame[4095]) + endless_stack(frame) + static_cast<std::size_t>(frame[1]);
}

/// Does what the word says.
void make_trouble(const std::string& what) {
  volatile int zero = 0;
  volatile char seed = 1;
  if (what == "loop") {
    while (zero == 0) {
    }
  } else if (what == "memory") {
    *static_cast<volatile int*>(nullptr) = 1;
  } else if (what == "divide") {
    zero = 77 / zero;
  } else if (what == "abort") {
    std::abort();
  } else if (what == "stack") {
    (void)endless_stack(&seed);
  } else if (what == "instruction") {
    std::raise(SIGILL);
  } else if (what == "exit") {
    std::exit(0);
  } else if (what == "_exit") {
    _exit(0);
  } else if (what == "_Exit") {
    std::_Exit(0);
  } else if (what == "_exit on a thread") {
    std::thread([] { _exit(0); }).join();
  } else if (what == "child") {  // which is none of the run's
    const pid_t child = fork();
    if (child == 0) _exit(7);
    int status = 0;
    (void)waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 7) throw std::runtime_error("its child did not end as it should");
  } else if (what == "quick_exit") {
    std::quick_exit(0);
  } else if (what == "noexcept") {
    []() noexcept { make_trouble("throw in noexcept"); }();
  } else if (what == "throw in noexcept") {
    throw std::runtime_error("lost in \033[2Jspace");
  } else if (what == "thread") {
    std::thread([] { make_trouble("throw in noexcept"); }).join();
  } else if (what == "long") {
    throw std::runtime_error(std::string(20'000'000, 'x') + "end");
  } else if (what == "forge") {
    throw std::runtime_error("no\nerror: the arena burns\n\u202Eback");
  } else if (what == "throw") {
    throw std::runtime_error("\033[2J\033]0;owned\007 gone");
  }
}

struct Params {
  std::string what = "nothing";
  std::int64_t at = 3;
  std::string robot;
  bool early = false;
  void describe(hal::ParamVisitor& v) {
    v.text("what", what, "The trouble.");
    v.integer("at", at, hal::kAny, "Step or tick of the trouble.");
    v.text("robot", robot, "Id of the only robot that makes it; empty: all do.");
    v.flag("early", early, "Already when it is made.");
  }
};

class Troublemaker final : public hal::Controller {
 public:
  using Params = ::Params;
  Troublemaker(hal::Robot& robot, const Params& params)
      : wheels_(robot.actuator<hal::WheelSpeeds>()),
        what_(params.robot.empty() || params.robot == robot.id() ? params.what : ""),
        left_(params.at) {
    if (params.early) make_trouble(what_);
  }
  void step() override {
    wheels_.set(0.02, 0.02);
    if (left_-- == 0) make_trouble(what_);
  }

 private:
  hal::WheelSpeeds& wheels_;
  std::string what_;
  std::int64_t left_;
};

class Trouble final : public core::Hook {
 public:
  using Params = ::Params;
  explicit Trouble(const Params& params) : params_(params) {
    if (params_.early) make_trouble(params_.what);
  }
  void after_step(core::HookContext& c) override {
    if (c.tick == params_.at) make_trouble(params_.what);
  }

 private:
  Params params_;
};

/// An observer that fails, throws or makes trouble at its tick.
class Onlooker final : public core::Observer {
 public:
  using Params = ::Params;
  Onlooker(const Params& params, const core::Observation&) : params_(params) {
    if (params_.early) make_trouble(params_.what);
  }
  hal::Status observe(const core::Observation& now) override {
    if (now.tick < params_.at) return {};
    if (params_.what == "fail") return hal::Error{"cannot bear to look"};
    make_trouble(params_.what);
    return {};
  }

 private:
  Params params_;
};

/// A part of a run that fails, throws or makes trouble at its tick, or when it joins.
class Joiner final : public core::RunPart {
 public:
  using Params = ::Params;
  Joiner(const Params& params, core::Run&) : params_(params) {}
  std::string_view name() const override { return "joiner"; }
  core::RunTurn turn() const override { return core::RunTurn::Added; }
  hal::Status join(core::Run&) override {
    return params_.what == "join" ? hal::Status(hal::Error{"will not join"}) : hal::Status();
  }
  bool before_tick(core::Run& run) override {
    if (run.world().tick() < params_.at) return true;
    if (params_.what == "end") return false;
    if (params_.what == "before") throw std::runtime_error("cannot go on");
    return true;
  }
  bool after_tick(core::Run& run) override {
    if (run.world().tick() == params_.at && params_.what != "finish") make_trouble(params_.what);
    return true;
  }
  hal::Status finish(core::Run&) override {
    return params_.what == "finish" ? hal::Status(hal::Error{"cannot let go"}) : hal::Status();
  }

 private:
  Params params_;
};

void register_all(hal::Registrar& registrar) {
  registrar.add_controller<Troublemaker>("troublemaker", "Ends the program, or does not return.");
  registrar.add(core::hook_type<Trouble>("trouble", "Ends the program, or does not return."));
  static const core::ObserverType onlooker = core::observer_type<Onlooker>("onlooker", "Fails.");
  registrar.add(onlooker);
  static const core::RunPartType joiner = core::run_part_type<Joiner>("joiner", "Fails, or ends a run.");
  registrar.add(joiner);
}

}  // namespace

TANDEM_PLUGIN(register_all)
