#include "app/window/view_run.hpp"

#include <algorithm>
#include <utility>

#include "app/outputs/observers.hpp"
#include "app/process/terminal.hpp"
#include "app/run_options.hpp"
#include "core/live/controls.hpp"
#include "core/live/inspection.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::app {
namespace {

using hal::Json;
using namespace std::chrono_literals;

constexpr int kWishesPerSecond = 20;
constexpr auto kStateEvery = 250ms;
constexpr auto kControlsEvery = 1s;
constexpr auto kRealEvery = 500ms;
constexpr int kLogEntriesPerSecond = 100;

Json refusal(const std::string& why) {
  return {{"ok", false}, {"error", why}};
}

}  // namespace

RunView::RunView(std::unique_ptr<window::Window> window, const ViewedRun& run)
    : run_(run),
      projector_(run.world.scenario().file),
      view_(run.catalog, hal::Log([this](hal::Severity, std::string_view text) { log(text); })),
      window_(std::move(window)) {}

RunView::~RunView() {
  run_.live.close();  // answers those who still wait
  window_.reset();
}

hal::Result<std::unique_ptr<RunView>> RunView::open(const ViewRequest& request, const ViewedRun& run) {
  auto window = open_window(request);
  if (!window.ok()) return window.error();
  std::unique_ptr<RunView> view(new RunView(std::move(window).value(), run));
  view->greet();
  announce(*view->window_, request);
  return view;
}

void RunView::greet() {
  RunView* const self = this;
  run_.live.add_command("show", [self](const Json&) -> hal::Result<Json> {
    self->wish_posted_ = false;
    if (self->may_show_at_once()) self->refresh(true);  // else the next tick does
    return Json::object();
  });
  run_.live.add_command("picture", [self](const Json&) -> hal::Result<Json> {
    return Json{{"svg", core::to_svg(self->run_.draw())}};
  });
  const core::LiveState state = run_.live.state();
  std::vector<std::string> can = {"touch"};
  if (run_.real != nullptr) {
    can.insert(can.end(), {"real", "pause"});
  } else {
    can.insert(can.end(), {"pause", "reset"});
    if (state.no_way_back.empty()) can.emplace_back("back");
  }
  const core::World& world = run_.world;
  Json hello = hello_message(world.scenario().name, run_.real != nullptr ? "mixed" : "run", world.seed(),
                             world.ticks_per_second(), can, world.scenario().safety);
  hello["layers"] = view_.layers_json(world.space());
  for (const hal::RobotKind* kind : run_.catalog.all<hal::RobotKind>()) hello["kinds"].push_back(kind->name);
  for (const core::ControllerConfig& config : world.scenario().controllers) hello["controllers"].push_back(config.id);
  hello["states"] = core::published_names(world.space());
  controls_ = core::controls_json(run_.world);
  hello["controls"] = controls_;
  window_->tell(std::move(hello));
  tell_state(true);
  tell_real();
  window_->tell(projector_.message());
  window_->set_commands(
      [self](Json command, window::WindowReply reply) { self->take(std::move(command), std::move(reply)); });
  if (run_.commands != nullptr)
    window_->on_refused(
        [commands = run_.commands](const Json& command, const Json& answer) { commands->note(command, answer); });
  window_->set_pictures(
      [self](const std::string& name, window::WindowFileReply reply) { self->make_picture(name, std::move(reply)); });
  window_->on_wish([self] {
    if (!self->wish_posted_.exchange(true)) self->run_.live.post({{"do", "show"}}, {});
  });
}

// On the window's thread.
void RunView::take(Json command, window::WindowReply reply) {
  const std::string name = command["do"].get<std::string>();
  if (name == "projector") {
    const hal::Status taken = projector_.take(command);
    window_->tell(projector_.message());
    return reply(taken.ok() ? Json{{"ok", true}} : refusal(taken.error().message));
  }
  if (run_.real != nullptr) return run_.real->post(std::move(command), std::move(reply), "window");
  for (const char* of_real : {"arm", "rearm", "estop", "replace", "preflight"}) {
    if (name == of_real) return reply(refusal("no real robots take part in this run"));
  }
  if (run_.commands != nullptr) reply = run_.commands->noting(command, std::move(reply));
  run_.live.post(std::move(command), std::move(reply));
}

// On the window's thread. The thread that steps draws; rendering, which takes long, happens on a thread of its own.
void RunView::make_picture(const std::string& name, window::WindowFileReply reply) {
  if (!run_.draw) return reply({"", "", "there is no picture of this"});
  run_.live.post({{"do", "picture"}}, [this, name, reply](const Json& answer) {
    const auto svg = answer.find("svg");
    if (svg == answer.end()) return reply({"", "", answer.value("error", "no picture")});
    const std::lock_guard hold(picture_lock_);
    if (picture_.valid() && picture_.wait_for(0s) != std::future_status::ready)
      return reply({"", "", "another picture is being drawn; ask again"});
    picture_ = std::async(std::launch::async,
                          [name, reply, text = svg->get<std::string>()] { reply(picture_file(name, text)); });
  });
}

core::Observation RunView::observation() const {
  return observation_of(run_.world, std::max<hal::Tick>(0, run_.world.tick() - 1));
}

void RunView::tick_done() {
  tick_.store(run_.world.tick(), std::memory_order_relaxed);
  if (view_.notes()) view_.note(observation());
  stand();
}

void RunView::stand() {
  tell_incidents();
  if (window_->wants_frame()) {
    refresh(false);
  } else if (window_->watched() && Clock::now() - state_told_ >= kStateEvery) {
    tell_state(false);
  }
}

void RunView::show() {
  tick_.store(run_.world.tick(), std::memory_order_relaxed);
  const core::LiveState state = run_.live.state();
  const bool settled = state.paused || !state.ended.empty();
  if (settled || window_->wants_frame()) refresh(settled);
}

// Nothing is copied while nobody watches: who comes wishes for a frame.
void RunView::refresh(bool settled) {
  if (!window_->watched()) {
    if (settled) tell_state(false);
    return;
  }
  tell_controls();
  tell_state(settled);
  view_.show(*window_, observation(), run_.world.tick(), settled,
             [this](const std::vector<std::string>& robots) { return core::inspection_of(run_.world, robots); });
  tell_real();
}

// Viewers who wish for something else all the time do not slow the run.
bool RunView::may_show_at_once() {
  const Clock::time_point now = Clock::now();
  if (now - wish_second_ >= 1s) {
    wish_second_ = now;
    wishes_in_second_ = 0;
  }
  return ++wishes_in_second_ <= kWishesPerSecond;
}

void RunView::tell_state(bool always) {
  const core::LiveState state = run_.live.state();
  const Clock::time_point now = Clock::now();
  if (!always && state.changes == told_changes_ && now - state_told_ < kStateEvery) return;
  told_changes_ = state.changes;
  state_told_ = now;
  Json message = {{"type", "state"}};
  message.update(core::to_json(state));
  message["tick"] = run_.world.tick();
  window_->tell(std::move(message));
}

void RunView::tell_incidents() {
  const std::vector<core::IncidentCause>& incidents = run_.world.incidents().causes;
  if (incidents.size() < incidents_told_) incidents_told_ = incidents.size();  // the run went back
  for (; incidents_told_ < incidents.size(); ++incidents_told_) {
    const std::lock_guard hold(log_lock_);
    window_->tell(log_messages_.entry(run_.world.tick(), "incident", incidents[incidents_told_].text()));
  }
}

void RunView::event(hal::Tick tick, const Json& event) {
  const auto action = event.find("action");
  const std::string text = action != event.end() ? action_text(*action) : hal::to_text(event);
  const std::lock_guard hold(log_lock_);
  Json message = log_messages_.entry(tick, "action", text);
  if (action != event.end() && action->contains("robot") && (*action)["robot"].is_string())
    message["entries"][0]["robot"] = (*action)["robot"];
  window_->tell(std::move(message));
}

void RunView::log(std::string_view text) {
  const std::lock_guard hold(log_lock_);
  const Clock::time_point now = Clock::now();
  if (now - log_second_ >= 1s) {
    log_second_ = now;
    logged_in_second_ = 0;
  }
  if (++logged_in_second_ > kLogEntriesPerSecond) return;  // --log keeps all
  window_->tell(log_messages_.entry(tick_.load(std::memory_order_relaxed), "log", text));
}

void RunView::tell_controls() {
  const Clock::time_point now = Clock::now();
  if (now - controls_told_ < kControlsEvery && run_.live.state().changes == told_changes_) return;
  controls_told_ = now;
  Json controls = core::controls_json(run_.world);
  if (controls == controls_) return;
  controls_ = controls;
  window_->tell({{"type", "controls"}, {"controls", std::move(controls)}});
}

void RunView::tell_real() {
  if (run_.real == nullptr) return;
  const Clock::time_point now = Clock::now();
  if (now - real_told_ < kRealEvery) return;
  real_told_ = now;
  window_->tell(run_.real->message());
}

}  // namespace tandem::app
