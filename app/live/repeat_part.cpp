#include <fmt/format.h>
#include <iterator>

#include "app/experiment/reading.hpp"
#include "app/live/live_parts.hpp"
#include "app/process/terminal.hpp"
#include "core/live/repeat.hpp"
#include "core/live/source_files.hpp"

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
    const auto known = plan_.repeated->fingerprints.find(world.tick() - 1);
    return known == plan_.repeated->fingerprints.end() || known->second == world.state_hash();
  }

  RunPlan& plan_;
};

}  // namespace

int read_repeated(RunPlan& plan) {
  const RunOptions& options = plan.options;
  if (options.repeat.empty()) return kDone;
  if (has_real_robots(*plan.scenario))
    return complain(kBadInput,
                    "--repeat: real robots take part, and never do the same twice; simulate them instead (--without)");
  auto repeated = core::read_repeatable(options.repeat);
  if (!repeated.ok()) return complain(kBadInput, repeated.error().message);
  if (repeated.value().real_robots && !plan.replays())
    return complain(kBadInput, "record '" + options.repeat +
                                   "': real robots took part in this run; `tandem replay` computes it again");
  if (repeated.value().experiment != plan.scenario->name)
    say("the record is of the experiment '" + repeated.value().experiment + "'");
  plan.repeated = std::make_shared<core::Repeatable>(std::move(repeated).value());
  plan.seed = plan.repeated->seed;
  return kDone;
}

void run_recorded_scripts(RunPlan& plan) {
  const bool other_scripts =
      plan.options.replay.accept_changes || (plan.side != nullptr && plan.side->changes_scripts());
  if (plan.repeated == nullptr || other_scripts) return;
  std::vector<core::RepeatedAction> reloads = core::reloads_to(plan.repeated->scripts, *plan.world);
  for (const core::RepeatedAction& reload : reloads) {
    say("controller '" + reload.action["controller"].get<std::string>() +
        "' begins with its script as the record has it; the file is another one now");
  }
  auto& actions = plan.repeated->actions;
  actions.insert(actions.begin(), std::make_move_iterator(reloads.begin()), std::make_move_iterator(reloads.end()));
}

void compare_repeated(RunPlan& plan, core::Run& run) {
  run.add(std::make_unique<Repetition>(plan));
}

}  // namespace tandem::app
