#include <fmt/format.h>

#include "app/process/terminal.hpp"
#include "app/run/parts.hpp"

namespace tandem::app {
namespace {

/// Compares every tick with the record of the run that is repeated.
class Repetition final : public core::RunPart {
 public:
  explicit Repetition(RunPlan& plan) : plan_(plan) {}
  std::string_view name() const override { return "repeat"; }
  core::RunTurn turn() const override { return core::RunTurn::Compare; }
  bool after_tick(core::Run& run) override {
    if (!plan_.as_before || as_recorded(run.world())) return true;
    plan_.as_before = false;
    complain(kFailedRunning, fmt::format("tick {} is not as in {}: another experiment, program or plug-in, or the "
                                         "run was not a repeatable one",
                                         run.world().tick() - 1, plan_.options.repeat));
    return true;
  }

 private:
  bool as_recorded(const core::World& world) const {
    const auto known = plan_.repeated.fingerprints.find(world.tick() - 1);
    return known == plan_.repeated.fingerprints.end() || known->second == world.state_hash();
  }

  RunPlan& plan_;
};

/// The same for a run with real robots, which is computed again out of its record; changes it where it is to be.
class Replaying final : public core::RunPart {
 public:
  explicit Replaying(RunPlan& plan) : plan_(plan) {}
  std::string_view name() const override { return "replay"; }
  core::RunTurn turn() const override { return core::RunTurn::Compare; }
  bool after_tick(core::Run& run) override {
    core::World& world = run.world();
    plan_.as_before = plan_.replay.tick_done(plan_.repeated, world) && plan_.as_before;
    if (const std::string changes = plan_.replay.next_tick(world); !changes.empty())
      run.tell(world.tick(), {{"kind", "what if"}, {"text", changes}});
    return true;
  }
  hal::Status close(core::Run& run) override {
    plan_.as_before = plan_.replay.finish(run.world()) && plan_.as_before;
    plan_.result->replay = plan_.replay.json();
    plan_.result->more_rows = plan_.replay.rows();
    return {};
  }

 private:
  RunPlan& plan_;
};

}  // namespace

int add_comparison(RunPlan& plan, core::Run& run) {
  if (plan.replay.wanted()) {
    run.add(std::make_unique<Replaying>(plan));
  } else if (!plan.options.repeat.empty()) {
    run.add(std::make_unique<Repetition>(plan));
  }
  return kDone;
}

}  // namespace tandem::app
