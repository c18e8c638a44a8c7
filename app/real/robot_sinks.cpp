#include "app/real/robot_sinks.hpp"

#include <algorithm>
#include <deque>
#include <fmt/format.h>
#include <mutex>
#include <optional>
#include <utility>

#include "app/command/shared_options.hpp"
#include "app/live/viewed_space.hpp"
#include "app/live/watch.hpp"
#include "app/module/modules.hpp"
#include "app/outputs/run_report.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/real/real_robots.hpp"
#include "app/real/robot_space.hpp"
#include "app/run/run_module.hpp"
#include "core/record/record.hpp"
#include "hal/json/json_access.hpp"
#include "mixed_reality/safety/lone_robot.hpp"
#include "mixed_reality/time/monotonic.hpp"

namespace tandem::app {
namespace {

/// What the table asks is answered after a tick.
class Asked final : public core::Watched {
 public:
  explicit Asked(std::function<hal::Status(std::string_view)> obey) : obey_(std::move(obey)) {}
  void post(hal::Json command, core::LiveReply reply) override {
    const std::string name = hal::text_of(command, "do");
    if (name == "watch") {
      const std::lock_guard hold(lock_);
      return posted_.push_back(std::move(reply));
    }
    const hal::Status done = obey_(name);
    reply(done.ok() ? hal::Json{{"ok", true}} : hal::Json{{"ok", false}, {"error", done.error().message}});
  }
  core::LiveState state() const override {
    const std::lock_guard hold(lock_);
    return state_;
  }
  void add_command(std::string, core::LiveCommand command) override { watch_ = std::move(command); }

  /// After a tick.
  void answer(hal::Tick done) {
    std::deque<core::LiveReply> asked;
    {
      const std::lock_guard hold(lock_);
      asked.swap(posted_);
      state_.tick = state_.latest = state_.first = done;
      state_.speed = state_.reached = 1.0;
    }
    for (const core::LiveReply& reply : asked) {
      (void)watch_({});
      reply({{"ok", true}});
    }
  }

 private:
  std::function<hal::Status(std::string_view)> obey_;
  core::LiveCommand watch_;
  mutable std::mutex lock_;
  std::deque<core::LiveReply> posted_;
  core::LiveState state_;
};

class Sinks final : public core::RunPart {
 public:
  Sinks(const RobotOptions& options, const ShownRobot& shown, const mixed_reality::LoneRobot& lone,
        std::function<hal::Json()> end)
      : options_(options),
        scenario_(shown.scenario),
        loader_(shown.loader),
        lone_(lone),
        id_(shown.item.id),
        space_(shown),
        end_(std::move(end)),
        asked_(shown.obey) {}
  std::string_view name() const override { return "sinks"; }
  core::RunTurn turn() const override { return core::RunTurn::Outputs; }

  hal::Status join(core::Run&) override {
    if (!options_.record.empty()) {
      auto opened =
          core::Recorder::open(record_config(), space_.space(),
                               record_start(scenario_, scenario_.seed.value_or(1), input_files(scenario_, loader_)));
      if (!opened.ok()) return opened.error();
      record_ = std::move(opened).value();
    }
    if (!options_.watch.watch) return {};
    if (hal::Status fits = Watch::check(options_.watch, space_.space()); !fits.ok()) return fits;
    watch_.emplace(options_.watch,
                   Watch::Run{asked_, [this] { return sight(); }, scenario_.name, 0, scenario_.ticks_per_second,
                              [this](WatchMoment& m) { add_robot(m); }, &request_stop});
    return {};
  }
  bool after_tick(core::Run& run) override {
    done_ = run.tick_count();
    space_.take(done_ - 1, clock_.now_ns(), lone_.real().verdict().may_drive);
    if (record_ != nullptr && kept_.ok()) {
      kept_ = record_->tick_done(space_.space(), done_ - 1);
      if (!kept_.ok()) run.fail(kept_.error().message);
    }
    asked_.answer(done_);
    return true;
  }
  ViewedSpace viewed() {
    return {scenario_.name,
            scenario_.ticks_per_second,
            loader_.catalog(),
            asked_,
            [this] {
              return core::Observation{space_.space(), measures_, std::max<hal::Tick>(0, done_ - 1),
                                       scenario_.ticks_per_second, 0};
            },
            [this] { return real_message({status()}, {}); }};
  }
  hal::Status close(core::Run&) override {
    watch_.reset();
    return record_ != nullptr && kept_.ok() ? record_->close(done_ - 1, end_()) : hal::Status();
  }

 private:
  /// As the file says, with all ports where it names none.
  core::RecordConfig record_config() const {
    core::RecordConfig config = scenario_.record;
    config.path = options_.record;
    config.entities = {"*"};
    if (config.ports.empty()) config.ports = {"*"};
    return config;
  }
  mixed_reality::RealRobotStatus status() const {
    const mixed_reality::RealRobot& real = lone_.real();
    const bridges::LinkReport link = real.bridge().report();
    mixed_reality::RealRobotStatus status;
    status.id = status.device = id_;
    status.link = real.bridge().identity().link;
    status.identity = bridges::to_text(real.bridge().identity());
    status.health = real.bridge().health();
    status.trouble = real.bridge().trouble();
    status.driving = real.verdict().may_drive && !real.awaits_arming();
    status.state = lone_.reason();
    status.emergency_stopped = real.emergency_stopped();
    status.awaits_arming = real.awaits_arming();
    status.awaits_rearm = real.awaits_rearm();
    status.round_trip_s = hal::to_seconds(link.mean_round_trip_ns);
    if (real.battery() != nullptr && real.battery()->validity != hal::Validity::Absent)
      status.battery = real.battery()->charge;
    return status;
  }
  WatchSight sight() const { return {space_.space(), done_, scenario_.ticks_per_second}; }
  void add_robot(WatchMoment& moment) const {
    const std::string reason = lone_.reason();
    const bool drives = lone_.real().verdict().may_drive;
    moment.real.push_back(
        {fmt::format("{}: {}", lone_.real().bridge().identity().link, drives ? "drives" : reason), drives});
  }

  const RobotOptions& options_;
  const core::Scenario& scenario_;
  const hal::PluginLoader& loader_;
  const mixed_reality::LoneRobot& lone_;
  std::string id_;
  RobotSpace space_;
  core::Measures measures_;  // none
  std::function<hal::Json()> end_;
  mixed_reality::MonotonicTime clock_;
  hal::Tick done_ = 0;
  std::unique_ptr<core::Recorder> record_;
  hal::Status kept_;
  Asked asked_;
  std::optional<Watch> watch_;
};

}  // namespace

void describe_robot_sinks(hal::CommandLine& line, RobotOptions& options) {
  line.option("--record", options.record, "Write a record: poses by wheels or the robot's own word, ports, state")
      .file();
  describe_watch(line, options.watch, "A live table of the robot on the terminal; q stops the robot, and ends");
  line.flag_or_number("--view", options.page_port,
                      "Serve a page of it, with an emergency stop, on port --view=PORT or any that is free");
  describe_viewers(line, options.view);
}

hal::Result<RobotSinks> robot_sinks(const RobotOptions& options, const ShownRobot& shown,
                                    const mixed_reality::LoneRobot& lone, std::function<hal::Json()> end) {
  RobotSinks parts;
  if (options.record.empty() && !options.watch.watch && !options.page_port) return parts;
  auto sinks = std::make_unique<Sinks>(options, shown, lone, std::move(end));
  const ViewedSpace viewed = sinks->viewed();
  parts.push_back(std::move(sinks));
  if (!options.page_port) return parts;
  ViewRequest request = options.view;
  request.no_browser = true;
  request.port = *options.page_port;
  if (const hal::Status there = need_module(shown.loader, "window"); !there.ok()) return there.error();
  auto view = shown.loader.catalog().find<RunModule>("window")->view(request, viewed);
  if (!view.ok()) return view.error();
  parts.push_back(std::move(view).value());
  return parts;
}

}  // namespace tandem::app
