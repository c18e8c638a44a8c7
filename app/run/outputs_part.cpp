#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/outputs/emergency_outputs.hpp"
#include "app/process/terminal.hpp"
#include "app/robots/real_robots.hpp"
#include "app/run/parts.hpp"
#include "core/view/picture.hpp"
#include "core/view/record_drawing.hpp"

namespace tandem::app {
namespace {

/// What a picture of the world says besides where everything is.
core::PictureOptions picture_options(const core::World& world, const mixed_reality::MixedReport* real,
                                     const core::PictureLook& look) {
  core::PictureOptions picture;
  picture.experiment = world.scenario().name;
  picture.seed = world.seed();
  picture.time_ns = hal::time_of_tick(world.tick(), world.ticks_per_second());
  picture.look = look;
  picture.ticks_done = world.tick();
  for (const auto& r : real != nullptr ? real->robots : std::vector<mixed_reality::RealRobotReport>{}) {
    if (!r.driving) picture.trouble.push_back({r.robot, r.state});
  }
  return picture;
}

/// A drawing of the world, with the layers that were asked for.
core::Drawing drawing_of(const core::World& world, const RunOutputs& outputs, const core::PictureOptions& options) {
  core::Drawing drawing = core::drawing_of(world.space(), options);
  drawing.areas = areas_of(world.scenario().safety);
  if (outputs.layers == nullptr) return drawing;
  const hal::Tick last = world.tick() == 0 ? 0 : world.tick() - 1;
  for (const core::LayerPicture& layer : outputs.layers->show(observation_of(world, last)))
    drawing.shapes.insert(drawing.shapes.end(), layer.sketch.shapes().begin(), layer.sketch.shapes().end());
  return drawing;
}

/// What is kept of a run while it goes on, so that little is lost however it ends: records, which the system gets twice
/// a second, and a report for the emergency. Lives from the first tick to the last.
class Recording {
 public:
  /// `now.figures` is brought up to date here. All must outlive this.
  Recording(RunOutputs& outputs, RunResult& now, const mixed_reality::MixedSession* mixed, Watchdog& watchdog)
      : outputs_(outputs),
        now_(now),
        mixed_(mixed),
        watchdog_(watchdog),
        emergency_(outputs),
        began_s_(wall_seconds()),
        began_cpu_s_(cpu_seconds()),
        save_(watchdog, [this] {
          if (outputs_.trajectory != nullptr) (void)outputs_.trajectory->flush();
          set_report();
        }) {
    prepare_report();
    draw();
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
    if (records && !recorded_.ok()) complain(kFailedRunning, recorded_.error().message + "; the run goes on");
    record();
    outputs_.observers.tick_done(now_.world);
    if (outputs_.layers != nullptr && now_.world.tick() > 0)
      outputs_.layers->note(observation_of(now_.world, now_.world.tick() - 1));
    if (now_.world.tick() > 0) draw();
    if (!outputs_.dump) return;
    if (const hal::Status dumped = outputs_.dump->tick_done(now_.world); !dumped.ok())
      complain(kFailedRunning, dumped.error().message + "; the run goes on");
  }

  /// Of somebody who holds the run.
  void event(hal::Tick tick, const hal::Json& event) {
    const std::lock_guard hold(watchdog_.lock());
    if (outputs_.record == nullptr || !in_record_.ok()) return;
    if (event["kind"] == "back") in_record_ = outputs_.record->went_back(tick);
    if (in_record_.ok()) in_record_ = outputs_.record->event(tick, event);
    if (!in_record_.ok()) complain(kFailedRunning, in_record_.error().message + "; the run goes on");
  }

  /// The picture as it is now.
  core::Drawing drawing() const {
    std::optional<mixed_reality::MixedReport> real;
    if (mixed_ != nullptr) real = mixed_->report();
    auto picture = picture_options(now_.world, real ? &*real : nullptr, outputs_.look);
    if (outputs_.pictures != nullptr) picture.trails = &outputs_.pictures->trails();
    return drawing_of(now_.world, outputs_, picture);
  }

  void measure() {
    now_.figures.wall_s = wall_seconds() - began_s_;
    now_.figures.cpu_s = cpu_seconds() - began_cpu_s_;
    now_.figures.steps = now_.world.tick();
  }

 private:
  void record() {
    core::Recorder* const recorder = outputs_.record.get();
    const hal::Tick done = now_.world.tick() - 1;
    if (recorder == nullptr || !in_record_.ok() || done < 0) return;
    in_record_ = recorder->tick_done(now_.world.space(), done);
    if (mixed_ != nullptr && in_record_.ok()) note_skipped(done);
    const std::vector<std::string>& incidents = now_.world.incidents().first;
    incidents_told_ = std::min(incidents_told_, incidents.size());  // fewer, where the run went back
    for (; incidents_told_ < incidents.size() && in_record_.ok(); ++incidents_told_)
      in_record_ = recorder->event(done, {{"kind", "incident"}, {"text", incidents[incidents_told_]}});
    if (in_record_.ok() && recorder->wants_fingerprint(done)) {
      if (recorder->wants_checks()) {
        const core::StateChecks checks = core::checks_of(now_.world.state_view());
        in_record_ = recorder->fingerprint(done, checks.fingerprint);
        if (in_record_.ok()) in_record_ = recorder->checks(done, checks);
      } else {
        in_record_ = recorder->fingerprint(done, now_.world.state_hash());
      }
    }
    if (!in_record_.ok()) complain(kFailedRunning, in_record_.error().message + "; the run goes on");
  }
  /// Slots of the schedule in which no tick could begin, right before this one.
  void note_skipped(hal::Tick done) {
    if (const auto skipped = skipped_event(mixed_->clock(), skipped_told_))
      in_record_ = outputs_.record->event(done, *skipped);
  }
  void draw() {
    Pictures* const pictures = outputs_.pictures.get();
    if (pictures == nullptr) return;
    const hal::Tick done = now_.world.tick();
    pictures->note(done, now_.world.space());
    if (!pictures->wants(done)) return;
    pictures->draw(done, drawing());
  }
  void prepare_report() {
    if (!outputs_.report) return;
    if (mixed_ != nullptr) real_ = mixed_->report();
    set_report();
  }
  void set_report() {
    if (!outputs_.report) return;
    measure();
    RunResult now = now_;
    now.real = real_ ? &*real_ : nullptr;
    emergency_.set_report(report_members(now));
  }

  RunOutputs& outputs_;
  RunResult& now_;
  const mixed_reality::MixedSession* mixed_;
  Watchdog& watchdog_;
  EmergencyOutputs emergency_;
  double began_s_, began_cpu_s_;
  std::optional<mixed_reality::MixedReport> real_;
  hal::Status recorded_, in_record_;
  std::size_t incidents_told_ = 0;
  std::uint32_t skipped_told_ = 0;
  SaveAtEnd save_;
};

/// Why a run has failed whose world has not; empty: it has not.
std::string failure_besides(const RunPlan& plan, const core::Run& run) {
  if (const core::Incidents& incidents = plan.world->incidents(); incidents.controllers_thrown > 0) {
    return fmt::format("{} threw, and the run went on without {}; the first incident: {}",
                       incidents.controllers_thrown == 1 ? "a controller"
                                                         : fmt::format("{} controllers", incidents.controllers_thrown),
                       incidents.controllers_thrown == 1 ? "its robot" : "their robots",
                       incidents.first.empty() ? "not known" : incidents.first.front());
  }
  if (!plan.as_before) return "it was not as in the run that it repeats";
  if (plan.live != nullptr && !plan.live->failure().empty()) return plan.live->failure();
  if (!plan.left.empty()) return fmt::format("the stop of {} is not confirmed", fmt::join(plan.left, ", "));
  if (!plan.guarded_to_the_end) return "no guardian looked after its robots at the end";
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
  if (outputs.dump) check(outputs.dump->close(result.world));
  if (outputs.pictures != nullptr && !outputs.pictures->close()) good = false;
  auto picture = picture_options(result.world, result.real, outputs.look);
  if (outputs.pictures != nullptr) picture.trails = &outputs.pictures->trails();
  if (outputs.picture) {
    check(core::write_picture(drawing_of(result.world, outputs, picture), *outputs.picture, outputs.look));
  }
  if (outputs.scene) {
    check(write_scene(core::drawing_of(result.world.space(), picture), outputs.look, *outputs.scene, outputs.povray));
  }
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
    recording_.emplace(plan_.outputs, *plan_.result, plan_.mixed, *plan_.watchdog);
    return {};
  }
  bool after_tick(core::Run&) override {
    recording_->tick_done();
    return true;
  }
  void event(hal::Tick tick, const hal::Json& event) override { recording_->event(tick, event); }
  core::Drawing drawing() const { return recording_->drawing(); }
  hal::Status finish(core::Run&) override {
    if (recording_) recording_->measure();
    return {};
  }
  hal::Status close(core::Run& run) override {
    recording_.reset();
    tell_end(run);
    plan_.written = write_results(plan_.outputs, *plan_.result, !plan_.options.quiet && plan_.options.report != "-");
    plan_.log.results_done();
    if (plan_.live != nullptr && !plan_.live->failure().empty()) complain(kFailedRunning, plan_.live->failure());
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

/// A record holds what comes from outside of the world, too.
hal::Status record_inputs(RunPlan& plan) {
  core::Recorder* const record = plan.outputs.record.get();
  if (record == nullptr) return {};
  if (plan.mixed != nullptr) {
    if (const hal::Status added = record_ledgers(*record, *plan.mixed); !added.ok()) return added;
    return record->set_inputs(plan.world->space(), plan.mixed->inputs());
  }
  const core::SpaceInputs* const inputs = plan.replay.wanted() ? plan.replay.inputs() : nullptr;
  return inputs != nullptr ? record->set_inputs(plan.world->space(), *inputs) : hal::Status();
}

}  // namespace

int add_outputs(RunPlan& plan, core::Run& run) {
  if (const hal::Status inputs = record_inputs(plan); !inputs.ok())
    return complain(kFailedRunning, inputs.error().message);
  plan.result->figures.init_s = wall_seconds() - plan.began_s;
  auto outputs = std::make_unique<Outputs>(plan);
  plan.drawing = [&outputs = *outputs] { return outputs.drawing(); };
  run.add(std::move(outputs));
  return kDone;
}

}  // namespace tandem::app
