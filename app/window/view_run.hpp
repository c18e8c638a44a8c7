// Shows a live run to the viewers of a window, and hands their commands to it.
#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "app/live/command_log.hpp"
#include "app/run/real_side.hpp"
#include "app/window/projector_fit.hpp"
#include "app/window/source_view.hpp"
#include "app/window/view_messages.hpp"
#include "core/live/live_run.hpp"
#include "core/sim/world.hpp"
#include "core/view/drawing.hpp"
#include "hal/catalog.hpp"
#include "window/window.hpp"

namespace tandem::app {

/// What is shown; all of it outlives the view.
struct ViewedRun {
  core::World& world;
  core::LiveRun& live;
  const hal::Catalog& catalog;
  RealRobots* real = nullptr;            ///< null: none take part
  std::function<core::Drawing()> draw;   ///< the picture as it would be written now
  const CommandLog* commands = nullptr;  ///< keeps commands; may be null
};

/// Made, used and destroyed by the thread that steps, but for `log`. Without viewers, a tick costs two atomic
/// reads.
class RunView {
 public:
  /// Before the first step. Error: as window::Window::open.
  static hal::Result<std::unique_ptr<RunView>> open(const ViewRequest& request, const ViewedRun& run);
  ~RunView();

  /// After every step.
  void tick_done();
  /// What is to be shown although no new tick was done; for LiveRun::on_show.
  void show();
  /// While a run with real robots is paused, again and again.
  void stand();
  /// What LiveRun::on_event tells.
  void event(hal::Tick tick, const hal::Json& event);
  /// A message of the run; from any thread.
  void log(std::string_view text);
  const std::string& address() const noexcept { return window_->address(); }

 private:
  using Clock = std::chrono::steady_clock;
  RunView(std::unique_ptr<window::Window> window, const ViewedRun& run);
  void greet();
  void take(hal::Json command, window::WindowReply reply);
  void make_picture(const std::string& name, window::WindowFileReply reply);
  void refresh(bool settled);
  bool may_show_at_once();
  void tell_state(bool always);
  void tell_incidents();
  void tell_controls();
  void tell_real();
  core::Observation observation() const;

  ViewedRun run_;
  ProjectorFit projector_;  // of the window's thread, once it runs
  SourceView view_;
  std::uint64_t told_changes_ = 0;
  std::size_t incidents_told_ = 0;
  hal::Json controls_;
  Clock::time_point wish_second_, state_told_, controls_told_, real_told_;
  std::atomic<bool> wish_posted_{false};
  std::atomic<hal::Tick> tick_{0};
  std::mutex log_lock_;
  LogMessages log_messages_;
  Clock::time_point log_second_;
  int logged_in_second_ = 0;
  int wishes_in_second_ = 0;
  std::mutex picture_lock_;
  std::future<void> picture_;
  std::unique_ptr<window::Window> window_;  // goes first: its thread uses the rest
};

}  // namespace tandem::app
