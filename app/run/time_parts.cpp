#include "app/run/time_parts.hpp"

#include <atomic>
#include <optional>
#include <utility>

#include "app/process/progress.hpp"

namespace tandem::app {
namespace {

class Pace final : public core::RunPart {
 public:
  Pace(mixed_reality::Pacer& pacer, std::mutex* lock, mixed_reality::Pacer::Lookout lookout)
      : pacer_(pacer), lock_(lock), lookout_(std::move(lookout)) {}
  std::string_view name() const override { return "real time"; }
  core::RunTurn turn() const override { return core::RunTurn::Pace; }
  bool before_tick(core::Run&) override {
    if (!begun_) pacer_.start();
    begun_ = true;
    return true;
  }
  bool after_tick(core::Run& run) override {
    std::unique_lock<std::mutex> hold;
    if (lock_ != nullptr) hold = std::unique_lock(*lock_);
    (void)pacer_.wait_for_next(run.stop(), lookout_);
    return true;
  }

 private:
  mixed_reality::Pacer& pacer_;
  std::mutex* lock_;
  mixed_reality::Pacer::Lookout lookout_;
  bool begun_ = false;
};

class TerminalProgress final : public core::RunPart {
 public:
  TerminalProgress(std::int64_t steps, std::int64_t ticks_per_second, const std::string& name)
      : progress_(std::in_place, steps, ticks_per_second, name) {}
  std::string_view name() const override { return "progress"; }
  core::RunTurn turn() const override { return core::RunTurn::Tell; }
  bool after_tick(core::Run& run) override {
    progress_->step(run.tick_count());
    return true;
  }
  hal::Status close(core::Run&) override {
    progress_.reset();
    return {};
  }

 private:
  std::optional<Progress> progress_;
};

}  // namespace

std::unique_ptr<core::RunPart> pace_part(mixed_reality::Pacer& pacer, std::mutex* lock,
                                         mixed_reality::Pacer::Lookout lookout) {
  return std::make_unique<Pace>(pacer, lock, std::move(lookout));
}

std::unique_ptr<core::RunPart> progress_part(std::int64_t steps, std::int64_t ticks_per_second,
                                             const std::string& name) {
  return std::make_unique<TerminalProgress>(steps, ticks_per_second, name);
}

}  // namespace tandem::app
