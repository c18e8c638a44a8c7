// Window of a space that no world steps.
#include <chrono>
#include <utility>

#include "app/live/viewed_space.hpp"
#include "app/run_options.hpp"
#include "app/window/source_view.hpp"
#include "app/window/view_messages.hpp"
#include "app/window/view_part.hpp"
#include "core/live/inspection.hpp"

namespace tandem::app {
namespace {

using hal::Json;
constexpr std::chrono::milliseconds kToldEvery{250};

class SpaceView final : public core::RunPart {
 public:
  SpaceView(std::unique_ptr<window::Window> window, const ViewRequest& request, const ViewedSpace& shown)
      : request_(request), shown_(shown), view_(shown.catalog), window_(std::move(window)) {}
  std::string_view name() const override { return "view"; }
  core::RunTurn turn() const override { return core::RunTurn::View; }

  hal::Status join(core::Run&) override {
    Json hello = hello_message(shown_.experiment, "mixed", 0, shown_.ticks_per_second, {"real"}, {});
    hello["layers"] = view_.layers_json(shown_.look().space);
    window_->tell(std::move(hello));
    tell();
    window_->set_commands(
        [this](Json command, window::WindowReply reply) { shown_.watched.post(std::move(command), std::move(reply)); });
    announce(*window_, request_);
    return {};
  }
  bool after_tick(core::Run& run) override {
    const core::Observation now = shown_.look();
    if (view_.notes()) view_.note(now);
    if (Clock::now() - told_ >= kToldEvery) tell();
    if (window_->wants_frame())
      view_.show(*window_, now, run.tick_count(), false, [&](const std::vector<std::string>& robots) {
        return core::inspection_of(now.space, run.tick_count(), now.ticks_per_second, robots);
      });
    return true;
  }
  hal::Status close(core::Run&) override {
    window_.reset();
    return {};
  }

 private:
  using Clock = std::chrono::steady_clock;
  void tell() {
    told_ = Clock::now();
    Json state = {{"type", "state"}};
    state.update(core::to_json(shown_.watched.state()));
    window_->tell(std::move(state));
    window_->tell(shown_.real());
  }

  ViewRequest request_;
  ViewedSpace shown_;
  SourceView view_;
  Clock::time_point told_;
  std::unique_ptr<window::Window> window_;  // goes first: its thread uses the rest
};

}  // namespace

hal::Result<std::unique_ptr<core::RunPart>> view_space(const ViewRequest& request, const ViewedSpace& shown) {
  auto window = open_window(request);
  if (!window.ok()) return window.error();
  return std::unique_ptr<core::RunPart>(std::make_unique<SpaceView>(std::move(window).value(), request, shown));
}

}  // namespace tandem::app
