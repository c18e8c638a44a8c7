#include "app/process/terminal.hpp"
#include "app/robots/motion_memory.hpp"
#include "app/run/parts.hpp"
#include "app/view/script_watch.hpp"
#include "app/view/view_run.hpp"

namespace tandem::app {
namespace {

/// What people command real robots.
class Desk final : public core::RunPart {
 public:
  Desk(RunPlan& plan, core::Run& run)
      : plan_(plan), desks_(std::in_place, *plan.live, *plan.mixed, *plan.commands, *plan.stop) {
    desks_->on_done([&run](const hal::Json& action) {  // of real robots: nobody can do it again
      run.tell(run.world().tick(), {{"kind", "action"}, {"action", action}, {"repeatable", false}});
    });
    desks_->on_first_motion([&guarded = *plan.guarded](const mixed_reality::PreflightRows& rows) {
      if (const hal::Status kept = keep_motions(guarded.robots(), rows); !kept.ok()) say(kept.error().message);
    });
    plan.desks = &*desks_;
  }
  std::string_view name() const override { return "desk"; }
  core::RunTurn turn() const override { return core::RunTurn::Desk; }
  hal::Status listen() { return desks_->listen(plan_.scenario->desk, plan_.options.hold.desk_keys); }
  hal::Status close(core::Run&) override {
    plan_.desks = nullptr;
    desks_.reset();
    return {};
  }

 private:
  RunPlan& plan_;
  std::optional<Desks> desks_;
};

/// The window; reads scripts anew that somebody changes while it is open.
class View final : public core::RunPart {
 public:
  View(RunPlan& plan, std::unique_ptr<RunView> view) : plan_(plan), view_(std::move(view)) {
    plan.live->on_show([this] { view_->show(); });
    plan.log.tell_also([this](std::string_view text) { view_->log(text); });
    if (!plan.replay.wanted()) scripts_.emplace(*plan.live, *plan.world, plan.world_log);
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

int add_desk(RunPlan& plan, core::Run& run) {
  if (plan.mixed == nullptr) return kDone;
  plan.look = [&live = *plan.live] { live.look(); };
  auto desk = std::make_unique<Desk>(plan, run);
  const hal::Status listens = desk->listen();
  run.add(std::move(desk));
  return listens.ok() ? kDone : complain(kFailedRunning, listens.error().message);
}

int add_view(RunPlan& plan, core::Run& run) {
  if (!plan.options.view.on) return kDone;
  auto opened = RunView::open(plan.options.view, {*plan.world, *plan.live, plan.loader.catalog(), plan.mixed,
                                                  plan.drawing, plan.desks, &*plan.commands});
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  auto view = std::make_unique<View>(plan, std::move(opened).value());
  if (plan.mixed != nullptr) {
    plan.look = [&live = *plan.live, &view = *view] {
      live.look();
      view.stand();
    };
  }
  run.add(std::move(view));
  return kDone;
}

}  // namespace tandem::app
