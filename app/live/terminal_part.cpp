#include "app/live/live_parts.hpp"
#include "app/live/watch.hpp"
#include "app/process/signals.hpp"

namespace tandem::app {
namespace {

/// A table of a run and its robots, on a terminal.
class TerminalWatch final : public core::RunPart {
 public:
  TerminalWatch(const WatchRequest& request, const Watch::Run& run) : watch_(std::in_place, request, run) {}
  std::string_view name() const override { return "watch"; }
  core::RunTurn turn() const override { return core::RunTurn::Tell; }
  hal::Status close(core::Run&) override {
    watch_.reset();
    return {};
  }

 private:
  std::optional<Watch> watch_;
};

}  // namespace

void watch(RunPlan& plan, core::Run& run) {
  const core::World& world = *plan.world;
  Watch::Run watched{*plan.live,
                     [&world] {
                       return WatchSight{world.space(), world.tick(), world.ticks_per_second(), world.incidents()};
                     },
                     world.scenario().name, plan.steps, world.ticks_per_second()};
  if (plan.real != nullptr) {
    watched.add_real = [&real = *plan.real](WatchMoment& moment) {
      moment.real = real.lines();
      moment.roll = real.roll_call();
    };
  }
  watched.end = &request_stop;
  run.add(std::make_unique<TerminalWatch>(plan.options.watch, watched));
}

}  // namespace tandem::app
