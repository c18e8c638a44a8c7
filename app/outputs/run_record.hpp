// The record of a run: rows, incidents, fingerprints, actions of people.
#pragma once
#include <cstddef>
#include <memory>
#include <string>

#include "app/outputs/run_report.hpp"
#include "core/record/record.hpp"
#include "core/run/run.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// What a record says at its start, with the scripts of controllers.
hal::Json start_of_record(core::World& world, const InputFiles& inputs);

/// Keeps a record in step with its run. An error is reported once; nothing is written then any more.
class RunRecord {
 public:
  /// `record` must outlive this.
  explicit RunRecord(core::Recorder& record) noexcept : record_(record) {}
  /// After every tick; `before`: what is to be said before what the tick brought.
  hal::Status tick_done(const core::World& world, const hal::Json* before = nullptr);
  hal::Status event(hal::Tick tick, const hal::Json& event);

 private:
  template <class Write>
  hal::Status written(Write&& write);

  core::Recorder& record_;
  std::size_t incidents_told_ = 0;
  bool failed_ = false;
};

/// A run's record where the program is a user's own. An error is a failure of the run, which goes on.
class RecordPart final : public core::RunPart {
 public:
  /// The experiment says what is in the record. It is at `path`. Errors: as core::Recorder::open.
  static hal::Result<std::unique_ptr<RecordPart>> open(core::World& world, const hal::PluginLoader& loader,
                                                       const std::string& path);
  std::string_view name() const override { return "record"; }
  core::RunTurn turn() const override { return core::RunTurn::Outputs; }
  bool after_tick(core::Run& run) override;
  void event(hal::Tick tick, const hal::Json& event) override;
  hal::Status close(core::Run& run) override;

 private:
  RecordPart(InputFiles inputs, std::unique_ptr<core::Recorder> record);

  InputFiles inputs_;
  std::unique_ptr<core::Recorder> record_;
  RunRecord kept_;
  hal::Status late_;  // of events, which have no turn
};

}  // namespace tandem::app
