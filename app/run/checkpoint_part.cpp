#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "app/process/terminal.hpp"
#include "app/run/parts.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::app {
namespace {

/// Before the first tick: goes on from a checkpoint, or computes the ticks before it again.
class Resumption final : public core::RunPart {
 public:
  explicit Resumption(RunPlan& plan) : plan_(plan), from_(*plan.resumed) {}
  std::string_view name() const override { return "resume"; }
  core::RunTurn turn() const override { return core::RunTurn::Length; }

  bool before_tick(core::Run& run) override {
    if (std::exchange(begun_, true)) return true;
    core::World& world = run.world();
    world.begin_saving();
    if (from_.state.empty())
      compute_again(run);
    else
      load(world);
    const bool there = world.tick() == from_.tick && world.state() == core::RunState::Running;
    const bool as_asked = plan_.options.overrides.empty() && !plan_.options.seed;
    if (!there || (as_asked && world.state_hash() != from_.fingerprint)) {
      if (run.stopped()) return false;
      throw std::runtime_error(fmt::format(
          "tick {} is not as in '{}': {}", from_.tick, plan_.options.resume,
          world.state() == core::RunState::Failed
              ? world.failure()
              : "a controller or hook depends on something besides its inputs (a clock, a file, chance of its own)"));
    }
    say(fmt::format("goes on from tick {} of '{}'", from_.tick, plan_.options.resume));
    from_.state = {};
    return true;
  }

 private:
  void load(core::World& world) {
    const RunOptions& options = plan_.options;
    std::optional<core::Scenario> before;
    if (!options.overrides.empty()) {
      before = settings_or_complain(plan_.loader, options.plugins, hal::text_of(from_.about, "settings"),
                                    hal::text_of(hal::object_of(from_.about, "file"), "file"), {});
    }
    const hal::Status loaded = world.load(from_.state, before ? &*before : nullptr);
    if (loaded.ok()) return;
    plan_.code_of_failure = kBadInput;
    throw std::runtime_error("checkpoint '" + plan_.options.resume + "' does not fit: " + loaded.error().message);
  }
  void compute_again(core::Run& run) {
    say(fmt::format("computes {} ticks again: the checkpoint does not hold the state, because {}", from_.tick,
                    from_.why_no_state));
    core::World& world = run.world();
    world.set_log({});  // all this was said before
    while (world.tick() < from_.tick && world.state() == core::RunState::Running && !run.stopped()) world.step();
    world.set_log(plan_.world_log);
  }

  RunPlan& plan_;
  core::Checkpoint& from_;
  bool begun_ = false;
};

/// Keeps the state of the run in a file.
class Checkpoints final : public core::RunPart {
 public:
  Checkpoints(RunPlan& plan, std::int64_t every_ticks) : plan_(plan), every_ticks_(every_ticks) {}
  std::string_view name() const override { return "checkpoint"; }
  core::RunTurn turn() const override { return core::RunTurn::Outputs; }

  hal::Status join(core::Run& run) override {
    about_ = record_start(run.world().scenario(), run.world().seed(), plan_.inputs);
    return {};
  }
  bool before_tick(core::Run& run) override {
    run.world().begin_saving();
    return true;
  }
  bool after_tick(core::Run& run) override {
    if (run.world().tick() % every_ticks_ == 0) write(run);
    return true;
  }
  void event(hal::Tick, const hal::Json&) override { touched_ = true; }
  hal::Status finish(core::Run& run) override {
    if (run.stopped() && run.world().tick() > written_) write(run);
    return {};
  }

 private:
  void write(core::Run& run) {
    core::World& world = run.world();
    if (world.state() != core::RunState::Running) return;
    core::Checkpoint checkpoint{about_, world.tick(), world.state_hash(), touched_, {}, {}};
    auto state = world.save();
    if (state.ok()) {
      checkpoint.state = std::move(state).value();
    } else {
      checkpoint.why_no_state = state.error().message;
      tell_that_computed_again(state.error().message);
      if (with_state_) return;  // the file has a better one
    }
    with_state_ = with_state_ || state.ok();
    if (plan_.outputs.trajectory != nullptr) (void)plan_.outputs.trajectory->flush();  // rows up to here
    const hal::Status written = core::write_checkpoint(plan_.options.checkpoint, checkpoint);
    written_ = world.tick();
    if (written.ok()) return;
    if (run.failure().empty()) complain(kFailedRunning, written.error().message + "; the run goes on");
    run.fail(written.error().message);
  }
  void tell_that_computed_again(const std::string& why) {
    if (std::exchange(told_, true)) return;
    say(with_state_
            ? "--checkpoint: the file keeps the state that it has: " + why
            : "--checkpoint: --resume will compute the run again from its start up to the checkpoint, because " + why);
  }

  RunPlan& plan_;
  std::int64_t every_ticks_;
  hal::Json about_;
  hal::Tick written_ = -1;
  bool with_state_ = false, touched_ = false, told_ = false;
};

}  // namespace

int add_resumption(RunPlan& plan, core::Run& run) {
  if (!plan.resumed) return kDone;
  if (plan.peers) return complain(kBadInput, "--resume: peers take part, which cannot be put back");
  run.add(std::make_unique<Resumption>(plan));
  return kDone;
}

int add_checkpoints(RunPlan& plan, core::Run& run) {
  const RunOptions& options = plan.options;
  if (options.checkpoint.empty()) return kDone;
  if (plan.peers) return complain(kBadInput, "--checkpoint: peers take part, which cannot be put back");
  const double ticks = options.checkpoint_every_s * static_cast<double>(plan.world->ticks_per_second());
  run.add(std::make_unique<Checkpoints>(plan, std::max<std::int64_t>(1, std::llround(std::min(ticks, 1e15)))));
  return kDone;
}

}  // namespace tandem::app
