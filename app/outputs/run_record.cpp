#include "app/outputs/run_record.hpp"

#include <algorithm>
#include <utility>

#include "core/run/scripts.hpp"

namespace tandem::app {

hal::Json start_of_record(core::World& world, const InputFiles& inputs) {
  hal::Json start = record_start(world.scenario(), world.seed(), inputs);
  hal::Json scripts = core::source_files(world);
  for (hal::Json& files : scripts) {
    for (hal::Json& file : files) file.erase("path");
  }
  if (!scripts.empty()) start["scripts"] = std::move(scripts);
  return start;
}

template <class Write>
hal::Status RunRecord::written(Write&& write) {
  if (failed_) return {};
  hal::Status done = write();
  failed_ = !done.ok();
  return done;
}

hal::Status RunRecord::tick_done(const core::World& world, const hal::Json* before) {
  const hal::Tick done = world.tick() - 1;
  if (done < 0) return {};  // a hook went back to the start
  return written([&] {
    hal::Status told = record_.tick_done(world.space(), done);
    if (told.ok() && before != nullptr) told = record_.event(done, *before);
    const std::vector<core::IncidentCause>& incidents = world.incidents().causes;
    incidents_told_ = std::min(incidents_told_, incidents.size());  // fewer, where the run went back
    for (; incidents_told_ < incidents.size() && told.ok(); ++incidents_told_)
      told = record_.event(done, {{"kind", "incident"}, {"text", incidents[incidents_told_].text()}});
    if (!told.ok() || !record_.wants_fingerprint(done)) return told;
    if (!record_.wants_checks()) return record_.fingerprint(done, world.state_hash());
    const core::StateChecks checks = core::checks_of(world.state_view());
    told = record_.fingerprint(done, checks.fingerprint);
    return told.ok() ? record_.checks(done, checks) : told;
  });
}

hal::Status RunRecord::event(hal::Tick tick, const hal::Json& event) {
  return written([&] {
    const hal::Status back = event["kind"] == "back" ? record_.went_back(tick) : hal::Status();
    return back.ok() ? record_.event(tick, event) : back;
  });
}

RecordPart::RecordPart(InputFiles inputs, std::unique_ptr<core::Recorder> record)
    : inputs_(std::move(inputs)), record_(std::move(record)), kept_(*record_) {}

hal::Result<std::unique_ptr<RecordPart>> RecordPart::open(core::World& world, const hal::PluginLoader& loader,
                                                          const std::string& path) {
  core::RecordConfig config = world.scenario().record;
  config.path = path;
  InputFiles inputs = input_files(world.scenario(), loader);
  auto opened = core::Recorder::open(config, world.space(), start_of_record(world, inputs));
  if (!opened.ok()) return opened.error();
  return std::unique_ptr<RecordPart>(new RecordPart(std::move(inputs), std::move(opened).value()));
}

bool RecordPart::after_tick(core::Run& run) {
  if (const hal::Status done = kept_.tick_done(run.world()); !done.ok()) run.fail(done.error().message);
  return true;
}

void RecordPart::event(hal::Tick tick, const hal::Json& event) {
  if (hal::Status done = kept_.event(tick, event); !done.ok()) late_ = std::move(done);
}

hal::Status RecordPart::close(core::Run& run) {
  const core::World& world = run.world();
  RunResult result{world, inputs_, {}, world.space().robot_count(), end_of(run, 0)};
  result.figures.steps = world.tick();
  result.figures.threads = world.threads();
  const hal::Status closed = record_->close(world.tick() - 1, record_end(result));
  return late_.ok() ? closed : late_;
}

}  // namespace tandem::app
