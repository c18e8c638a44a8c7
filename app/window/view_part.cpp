#include "app/window/view_part.hpp"

#include "app/live/command_log.hpp"
#include "app/process/terminal.hpp"
#include "app/run/run_plan.hpp"
#include "app/window/script_watch.hpp"
#include "app/window/view_run.hpp"

namespace tandem::app {
namespace {

/// The window; reads scripts anew that somebody changes while it is open.
class View final : public core::RunPart {
 public:
  View(RunPlan& plan, std::unique_ptr<RunView> view) : plan_(plan), view_(std::move(view)) {
    plan.live->on_show([this] { view_->show(); });
    plan.log.tell_also([this](std::string_view text) { view_->log(text); });
    if (!plan.replays()) scripts_.emplace(*plan.live, *plan.world, plan.world_log);
  }
  std::string_view name() const override { return "view"; }
  core::RunTurn turn() const override { return core::RunTurn::View; }
  bool after_tick(core::Run&) override {
    view_->tick_done();
    return true;
  }
  void stand() { view_->stand(); }
  void event(hal::Tick tick, const hal::Json& event) override { view_->event(tick, event); }
  hal::Status finish(core::Run&) override {
    scripts_.reset();
    return {};
  }
  hal::Status close(core::Run&) override {
    plan_.log.tell_also({});
    view_.reset();
    return {};
  }

 private:
  RunPlan& plan_;
  std::unique_ptr<RunView> view_;
  std::optional<ScriptWatch> scripts_;
};

}  // namespace

int add_view(RunPlan& plan, core::Run& run) {
  auto opened = RunView::open(plan.options.view, {*plan.world, *plan.live, plan.loader.catalog(), plan.real,
                                                  plan.drawing, plan.commands.get()});
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  auto view = std::make_unique<View>(plan, std::move(opened).value());
  if (plan.real != nullptr) {
    plan.look = [&live = *plan.live, &view = *view] {
      live.look();
      view.stand();
    };
  }
  run.add(std::move(view));
  return kDone;
}

}  // namespace tandem::app
