#include <fmt/format.h>

#include "app/outputs/emergency_outputs.hpp"
#include "app/outputs/run_record.hpp"
#include "app/process/terminal.hpp"
#include "app/run/parts.hpp"

namespace tandem::app {
namespace {

/// What is kept of a run while it goes on, so that little is lost however it ends: records, which the system gets twice
/// a second, and a report for the emergency. Lives from the first tick to the last.
class Recording {
 public:
  /// `now.figures` is brought up to date here. All must outlive this.
  Recording(RunOutputs& outputs, RunResult& now, RealRobots* real, Watchdog& watchdog)
      : outputs_(outputs),
        now_(now),
        real_(real),
        watchdog_(watchdog),
        emergency_(outputs),
        began_s_(wall_seconds()),
        began_cpu_s_(cpu_seconds()),
        save_(watchdog, [this] {
          if (outputs_.trajectory != nullptr) (void)outputs_.trajectory->flush();
          set_report();
        }) {
    if (outputs.record != nullptr) record_.emplace(*outputs.record);
    prepare_report();
  }

  void tick_done() {
    const std::lock_guard hold(watchdog_.lock());
    core::TrajectoryRecorder* const trajectory = outputs_.trajectory.get();
    const bool records = trajectory != nullptr && recorded_.ok();
    if (records && now_.world.tick() > 0)                                         // 0: a hook went back to the start
      recorded_ = trajectory->record(now_.world.space(), now_.world.tick() - 1);  // the tick that was just done
    if (emergency_.due()) {
      if (records && recorded_.ok()) recorded_ = trajectory->flush();
      outputs_.observers.flush();
      prepare_report();
    }
    if (records) tell(recorded_);
    record();
    outputs_.observers.tick_done(now_.world);
    if (outputs_.dump) tell(outputs_.dump->tick_done(now_.world.state_view()));
  }

  /// Of somebody who holds the run.
  void event(hal::Tick tick, const hal::Json& event) {
    const std::lock_guard hold(watchdog_.lock());
    if (record_) tell(record_->event(tick, event));
  }

  void measure() {
    now_.figures.wall_s = wall_seconds() - began_s_;
    now_.figures.cpu_s = cpu_seconds() - began_cpu_s_;
    now_.figures.steps = now_.world.tick();
  }

 private:
  static void tell(const hal::Status& written) {
    if (!written.ok()) complain(kFailedRunning, written.error().message + "; the run goes on");
  }
  void record() {
    if (!record_) return;
    // Slots of the schedule in which no tick could begin, right before this one.
    const std::optional<hal::Json> skipped = real_ != nullptr ? real_->skipped() : std::nullopt;
    tell(record_->tick_done(now_.world, skipped ? &*skipped : nullptr));
  }
  void prepare_report() {
    if (!outputs_.report) return;
    if (real_ != nullptr) now_.more = real_->report();
    set_report();
  }
  void set_report() {
    if (!outputs_.report) return;
    measure();
    emergency_.set_report(report_members(now_));
  }

  RunOutputs& outputs_;
  RunResult& now_;
  RealRobots* real_;
  Watchdog& watchdog_;
  EmergencyOutputs emergency_;
  double began_s_, began_cpu_s_;
  std::optional<RunRecord> record_;
  hal::Status recorded_;
  SaveAtEnd save_;
};

/// Why a run has failed whose world has not; empty: it has not.
std::string failure_besides(const RunPlan& plan, const core::Run& run) {
  if (const core::Incidents& incidents = plan.world->incidents(); incidents.controllers_thrown > 0) {
    return fmt::format("{} threw, and the run went on without {}; the first incident: {}",
                       incidents.controllers_thrown == 1 ? "a controller"
                                                         : fmt::format("{} controllers", incidents.controllers_thrown),
                       incidents.controllers_thrown == 1 ? "its robot" : "their robots",
                       incidents.causes.empty() ? "not known" : incidents.causes.front().text());
  }
  if (!plan.as_before) return "it was not as in the run that it repeats";
  if (!plan.live_failure.empty()) return plan.live_failure;
  if (plan.side != nullptr) {
    if (std::string failure = plan.side->failure(); !failure.empty()) return failure;
  }
  return run.failure();
}

/// Writes what was asked for at the end of a run. @returns whether all of it could be written.
bool write_results(RunOutputs& outputs, const RunResult& result, bool table) {
  bool good = true;
  const auto check = [&good](const hal::Status& status) {
    if (!status.ok()) good = complain(kFailedRunning, status.error().message) == kDone;
  };
  if (outputs.trajectory != nullptr) check(outputs.trajectory->close());
  if (outputs.record != nullptr) check(outputs.record->close(result.world.tick() - 1, record_end(result)));
  if (!outputs.observers.finish(result.world)) good = false;
  if (outputs.dump) check(outputs.dump->close(result.world.state_view()));
  if (outputs.report) {
    const hal::Status written = outputs.report->write(report_of(result) + "\n");
    check(written.ok() ? outputs.report->commit() : written);
  }
  if (table) print_result(result);
  return good;
}

/// Records, observers, pictures, the dump, the report.
class Outputs final : public core::RunPart {
 public:
  explicit Outputs(RunPlan& plan) : plan_(plan) {}
  std::string_view name() const override { return "outputs"; }
  core::RunTurn turn() const override { return core::RunTurn::Outputs; }

  hal::Status join(core::Run&) override {
    recording_.emplace(plan_.outputs, *plan_.result, plan_.real, *plan_.watchdog);
    return {};
  }
  bool after_tick(core::Run&) override {
    recording_->tick_done();
    return true;
  }
  void event(hal::Tick tick, const hal::Json& event) override { recording_->event(tick, event); }
  hal::Status finish(core::Run&) override {
    if (recording_) recording_->measure();
    if (plan_.pacer) plan_.result->figures.deadline_misses = plan_.pacer->ledger().deadline_misses;
    return {};
  }
  hal::Status close(core::Run& run) override {
    recording_.reset();
    tell_end(run);
    if (!write_results(plan_.outputs, *plan_.result, !plan_.options.quiet && plan_.options.report != "-"))
      plan_.written = false;
    plan_.log.results_done();
    if (!plan_.live_failure.empty()) complain(kFailedRunning, plan_.live_failure);
    return {};
  }

 private:
  void tell_end(const core::Run& run) {
    RunEnd& end = plan_.result->end;
    end = end_of(run, plan_.steps);
    if (end.how == Ended::Failed) complain(kFailedRunning, end.failure);
    if (!run.failure().empty()) complain(kFailedRunning, run.failure());
    if (end.how == Ended::Interrupted) say(fmt::format("interrupted at tick {}", plan_.world->tick()));
    if (end.how == Ended::Failed) return;
    end.failure = failure_besides(plan_, run);
    if (!end.failure.empty()) end.how = Ended::Failed;
  }

  RunPlan& plan_;
  std::optional<Recording> recording_;
};

}  // namespace

int add_outputs(RunPlan& plan, core::Run& run) {
  if (plan.side != nullptr && plan.outputs.record != nullptr) {
    if (const hal::Status inputs = plan.side->record_inputs(*plan.outputs.record); !inputs.ok())
      return complain(kFailedRunning, inputs.error().message);
  }
  plan.result->figures.init_s = wall_seconds() - plan.began_s;
  run.add(std::make_unique<Outputs>(plan));
  return kDone;
}

}  // namespace tandem::app
