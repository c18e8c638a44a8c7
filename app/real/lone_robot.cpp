// `tandem robot`: one real robot's controller, run here. Its file is a whole experiment, checked by the same reader, so
// that `tandem run` takes the same file; only tick rate, controller and the one robot with a <bridge> count. The price:
// a board's program needs core/config and core/scenario, and files need an <arena>.
#include "app/real/lone_robot.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <mutex>
#include <optional>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/emergency_report.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/process/watchdog.hpp"
#include "app/real/bridge_status.hpp"
#include "app/real/bridged_controller.hpp"
#include "app/real/file_controller.hpp"
#include "app/real/guarded_robots.hpp"
#include "app/real/hub_faults.hpp"
#include "app/real/listed_robot.hpp"
#include "app/real/robot_end.hpp"
#include "app/real/robot_sinks.hpp"
#include "app/run/time_parts.hpp"
#include "core/run/run.hpp"
#include "hal/output_file.hpp"
#include "hal/sha256.hpp"
#include "mixed_reality/safety/lone_robot.hpp"
#include "mixed_reality/settings/bridge_request.hpp"
#include "mixed_reality/settings/timeouts.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

constexpr hal::TimeNs kOpenWithin_ns = hal::kNsPerSecond;
constexpr hal::TimeNs kFrozenAfter_ns = 500 * hal::kNsPerMs;  // guardians have stopped the robot meanwhile
constexpr hal::TimeNs kPollEvery_ns = 20 * hal::kNsPerMs;     // while waiting for the robot
constexpr hal::TimeNs kArmAfter_ns = hal::kNsPerSecond;       // an emergency stop
constexpr hal::TimeNs kLookEvery_ns = 10 * hal::kNsPerMs;     // for an emergency stop

/// The one robot of the file that is to be driven; prints what is wrong otherwise.
const core::RobotItem* only_robot(const core::Scenario& scenario, const std::string& link) {
  const core::RobotItem* found = nullptr;
  for (const core::RobotItem& item : scenario.robots) {
    if (!item.bridge && (link.empty() || scenario.robots.size() > 1)) continue;
    if (found != nullptr) {
      fmt::print(stderr, "{}:{}: error: a second robot with a <bridge>; `tandem robot` drives one, `tandem run` many\n",
                 scenario.file, item.line);
      return nullptr;
    }
    found = &item;
  }
  if (found == nullptr) {
    fmt::print(
        stderr,
        "{}: error: no robot has a <bridge link=\"serial:…\"/>; add one, or say --link when there is one robot\n",
        scenario.file);
  }
  return found;
}

const std::atomic<bool> kNever{false};

/// Waits until the robot answers, has told all that its controller asked for, and stands armed; or it is clear that it
/// will not. Error: it does not; says what is known.
hal::Status connect(mixed_reality::LoneRobot& robot, const core::BridgeConfig& config, hal::TimeNs tick_ns,
                    mixed_reality::TimeSource& clock, const std::atomic<bool>& stop) {
  const bridges::RobotBridge& bridge = robot.real().bridge();
  const hal::TimeNs began_ns = clock.now_ns();
  hal::TimeNs commit_ns = began_ns;  // the next; bridges learn from it when to ask
  for (hal::TimeNs now = began_ns; !stop.load(); now = clock.now_ns()) {
    (void)robot.latch(0, now, mixed_reality::RunPhase::Joining);
    if (robot.real().verdict().may_drive) return {};
    if (now >= commit_ns) {
      commit_ns = now + tick_ns;
      robot.commit(now);
    }
    const std::string trouble = bridge.trouble();
    if (bridge.mismatched()) return hal::Error{trouble};
    const bool shut = now - began_ns >= kOpenWithin_ns && bridge.identity().session == 0 && !trouble.empty();
    const bool late = shut || hal::to_seconds(now - began_ns) >= config.connect_s;
    if (late && config.if_missing != core::IfMissing::Wait) {
      if (bridge.health() == bridges::LinkHealth::Active) return hal::Error{"it cannot be driven: " + robot.reason()};
      return hal::Error{"it is not there: " + (trouble.empty() ? "" : trouble + "; ") + bridge.advice()};
    }
    clock.sleep_until(std::min(now + kPollEvery_ns, std::max(commit_ns, now + 1)), stop);
  }
  return hal::Error{"interrupted while waiting for it"};
}

/// Stops the robot and waits a while for it to confirm.
void stop_and_wait(bridges::RobotBridge& bridge, double within_s, mixed_reality::TimeSource& clock) {
  const hal::TimeNs began_ns = clock.now_ns();
  bridge.stop(began_ns);
  while (!bridge.at_rest() && hal::to_seconds(clock.now_ns() - began_ns) < within_s) {
    clock.sleep_until(clock.now_ns() + kPollEvery_ns, kNever);
    bridge.latch(0, clock.now_ns());
  }
}

/// The files that the command reads: the experiment, those of its kinds, and those that the bridge asks for.
std::vector<NamedFile> input_files(const hal::Catalog& catalog, const bridges::BridgeRequest& request,
                                   const core::Scenario& scenario) {
  std::vector<NamedFile> files = {{"experiment", scenario.file}};
  for (const core::KindConfig& kind : scenario.kinds) files.push_back({"file of the " + kind.kind->name, kind.file});
  for (const auto& [what, path] : mixed_reality::bridge_inputs(catalog, request)) files.push_back({what, path});
  return files;
}

/// Begins the report; what the end adds comes later.
void begin_report(hal::Json& json, const core::Scenario& scenario, const core::RobotItem& item,
                  const bridges::RobotBridge& bridge, const mixed_reality::Supervisor& supervisor,
                  const mixed_reality::PaceLedger& pace) {
  json["experiment"] = scenario.name;
  json["robot"] = item.id;
  json["link"] = bridge.identity().link;
  json["steps"] = pace.ticks;
  json["deadline_misses"] = pace.deadline_misses;
  json["wake_up_p99_ms"] = static_cast<double>(pace.wake_up.quantile_ns(0.99)) * 1e-6;
  json["stops"] = supervisor.stops();
  json["rearms"] = supervisor.rearms();
  add_link_report(json, bridge.report());
  JsonStatus status(json);
  bridge.describe(status);
}

std::vector<std::pair<std::string, std::string>> result_table(const core::RobotItem& item,
                                                              const bridges::RobotBridge& bridge,
                                                              const mixed_reality::PaceLedger& pace) {
  const bridges::LinkReport link = bridge.report();
  const std::string identity = bridges::to_text(bridge.identity()), trouble = bridge.trouble();
  std::vector<std::pair<std::string, std::string>> rows = {
      {"robot", fmt::format("{} on {}", item.id, bridge.identity().link)},
      {"ticks", fmt::format("{}, {} missed their deadline, {:.2f} ms late at most", pace.ticks, pace.deadline_misses,
                            static_cast<double>(pace.largest_lateness_ns) * 1e-6)}};
  if (!identity.empty()) rows.emplace_back("it says it is", identity);
  rows.emplace_back("answers", fmt::format("{} to {} questions, {:.1f} ms round trip on average", link.answers,
                                           link.questions, static_cast<double>(link.mean_round_trip_ns) * 1e-6));
  rows.emplace_back("trouble",
                    fmt::format("{} answers too late, {} implausible; found again {} times, link lost {} times",
                                link.time_outs, link.bad_answers, link.resynchronised, link.links_lost));
  if (!trouble.empty()) rows.emplace_back("at the end", trouble);
  return rows;
}

/// Which files decided, each with its SHA-256.
void add_files(hal::Json& json, const std::string& experiment, hal::PluginLoader& loader,
               const core::ControllerConfig& config) {
  if (const auto digest = hal::sha256_of_file(experiment); digest.ok())
    json["file"] = {{"file", experiment}, {"sha256", digest.value()}};
  const std::string library = loader.find(config.library).value().string();
  if (const auto digest = hal::sha256_of_file(library); digest.ok()) {
    json["controller"] = library;
    json["sha256"] = digest.value();
  }
  for (const std::string& plugin : loader.plugins()) {
    const auto digest = hal::sha256_of_file(plugin);
    json["plugins"].push_back({{"file", plugin}, {"sha256", digest.ok() ? digest.value() : ""}});
  }
}

/// One robot with its controller, from the file to the report: a run that steps no world. What is made first is
/// destroyed last.
class LoneHub final : public core::Stepped {
 public:
  explicit LoneHub(const RobotOptions& options) : options_(options) {}
  /// @returns an exit code; kDone: go on with the next.
  int read();
  int prepare();
  int connect();
  int drive();

  bool step() override;
  hal::Tick tick() const override { return ticks_; }
  bool running() const override { return failure_.empty(); }

 private:
  class Driven;
  int choose_robot();
  hal::Json report_so_far() const;
  void prepare_report();
  void commit();
  hal::Status obey(std::string_view command);
  void obey_emergency_stop() noexcept;
  void stop();
  int end();

  const RobotOptions& options_;
  const hal::Log log_{[](hal::Severity, std::string_view text) { say(text); }};
  HubFaults hub_faults_;
  hal::PluginLoader loader_ = make_loader();
  ExperimentReading reading_{loader_, options_.plugins};
  std::optional<GuardedRobots> guarded_;
  std::optional<core::Scenario> scenario_;
  core::RobotItem item_;
  bridges::BridgeRequest request_;
  std::optional<hal::OutputFile> report_;
  const std::atomic<bool>* stop_ = nullptr;
  std::optional<Watchdog> watchdog_;
  FileController file_;
  mixed_reality::MonotonicTime clock_;
  std::optional<mixed_reality::LoneRobot> lone_;  // outlives the controller
  std::unique_ptr<BridgedController> controller_;
  RobotSinks sinks_;                                         // until the run has them
  std::atomic<bool> estop_asked_{false}, arm_asked_{false};  // by people, on any thread
  std::atomic<hal::TimeNs> stopped_ns_{-kArmAfter_ns};       // when the last emergency stop was asked for
  std::optional<mixed_reality::Pacer> pacer_;
  std::optional<EmergencyReport> emergency_;
  hal::Tick ticks_ = 0;
  std::uint64_t freezes_ = 0;
  std::string failure_;
  bool interrupted_ = false;
};

/// The robot as a part of its run: what its controller wrote is sent at once, before anything else; at the end it
/// stands first.
class LoneHub::Driven final : public core::RunPart {
 public:
  explicit Driven(LoneHub& hub) : hub_(hub) {}
  std::string_view name() const override { return "robot"; }
  core::RunTurn turn() const override { return core::RunTurn::Hold; }
  bool after_tick(core::Run&) override {
    hub_.commit();
    return true;
  }
  hal::Status finish(core::Run&) override {
    hub_.stop();
    return {};
  }

 private:
  LoneHub& hub_;
};

int LoneHub::read() {
  if (!options_.robot.empty()) return complain(kWrongUsage, "--robot goes with --link peer:…");
  auto hub_faults = HubFaults::make(options_.hub_faults);
  if (!hub_faults.ok()) return complain(kBadInput, hub_faults.error().message);
  hub_faults_ = std::move(hub_faults).value();
  if (!reading_.open(options_.file, {})) return kBadInput;
  guarded_.emplace(true, loader_.catalog(), log_);  // before any thread
  scenario_ = reading_.read();
  if (!scenario_) return kBadInput;
  return choose_robot();
}

int LoneHub::choose_robot() {
  const core::RobotItem* found = only_robot(*scenario_, options_.link);
  if (found == nullptr) return kBadInput;
  item_ = *found;
  if (!item_.bridge) item_.bridge = core::BridgeConfig{};
  if (!options_.link.empty()) item_.bridge->link = options_.link;
  request_ = mixed_reality::bridge_request(*scenario_, item_, scenario_->seed.value_or(1));
  if (request_.robot_kind == nullptr) request_.robot_kind = core::find_kind(*scenario_, loader_.catalog(), item_.kind);
  const hal::Status apart = check_apart({{"report", options_.report}, {"record", options_.record}},
                                        input_files(loader_.catalog(), request_, *scenario_));
  if (!apart.ok()) return complain(kBadInput, apart.error().message);
  auto report = open_report(options_.report);
  if (!report.ok()) return complain(kBadInput, report.error().message);
  report_ = std::move(report).value();
  const hal::Status& started = guarded_->started();
  return started.ok() ? kDone : complain(kFailedRunning, started.error().message);
}

int LoneHub::prepare() {
  stop_ = &catch_signals();
  std::signal(SIGPIPE, SIG_IGN);  // who reads our output may end before us
  watchdog_.emplace(options_.step_timeout_s, *stop_);
  request_.permit = guarded_->permit();
  request_.unix_clock = &hub_unix_ns;
  auto made = mixed_reality::make_bridge(loader_.catalog(), request_, log_);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  const core::SafetyConfig& safety = scenario_->safety;
  if (!safety.fences.empty() || !safety.keep_outs.empty() || !safety.zones.empty())
    log_.warning(
        "<safety> is not heeded here, for nobody knows where the robot is: no fence, keep-out or zone holds it");
  auto read = read_file_controller(*scenario_, item_, item_.id, loader_);
  if (!read.ok()) return complain(kBadInput, read.error().message);
  file_ = std::move(read).value();
  std::vector<std::pair<hal::PublishedField, const void*>> published;
  try {
    ListedRobot listed((*made)->robot(), *file_.config, loader_.catalog());
    listed.on_show([&published](hal::PublishedField field, const void* member) {
      published.emplace_back(std::move(field), member);
    });
    controller_ = std::make_unique<BridgedController>(*file_.type, listed, file_.params.get(),
                                                      scenario_->ticks_per_second, log_, file_.who);
  } catch (const std::exception& e) {
    return complain(kBadInput, file_.who + " " + e.what());
  }
  guarded_->add(**made);
  if (const hal::Status claimed = guarded_->claim(); !claimed.ok())
    return complain(kFailedRunning, claimed.error().message);
  const hal::TimeNs tick_ns = hal::time_of_tick(1, scenario_->ticks_per_second);
  lone_.emplace(item_.id, std::move(made).value(),
                mixed_reality::RealRobotParams{.rearm = mixed_reality::rearm_params(*item_.bridge),
                                               .frozen_after_ns = tick_ns + kFrozenAfter_ns},
                tick_ns, log_);
  const ShownRobot shown{*scenario_,
                         loader_,
                         item_,
                         lone_->real().bridge(),
                         *file_.type,
                         controller_->memory(),
                         std::move(published),
                         [this](std::string_view command) { return obey(command); }};
  auto sinks = robot_sinks(options_, shown, *lone_, [this] {
    hal::Json json = report_so_far();
    json["ended"] = RobotEnd{.failure = failure_, .interrupted = interrupted_}.word();
    return json;
  });
  if (!sinks.ok()) return complain(kBadInput, sinks.error().message);
  sinks_ = std::move(sinks).value();
  return kDone;
}

int LoneHub::connect() {
  lone_->real().bridge().start();
  const hal::TimeNs tick_ns = hal::time_of_tick(1, scenario_->ticks_per_second);
  const hal::Status ready = app::connect(*lone_, *item_.bridge, tick_ns, clock_, *stop_);
  if (stop_->load()) return interrupted_code();
  if (!ready.ok()) return complain(kFailedRunning, "robot '" + item_.id + "': " + ready.error().message);
  rearm_asked() = false;  // the start arms it
  return kDone;
}

hal::Json LoneHub::report_so_far() const {
  const mixed_reality::RealRobot& real = lone_->real();
  hal::Json json;
  begin_report(json, *scenario_, item_, real.bridge(), real.supervisor(), pacer_->ledger());
  return json;
}

/// On any thread.
hal::Status LoneHub::obey(std::string_view command) {
  if (command == "estop") {
    arm_asked_ = false;  // it came before
    stopped_ns_ = clock_.now_ns();
    estop_asked_ = true;
    return {};
  }
  if (command == "rearm") {
    rearm_asked() = true;
    return {};
  }
  if (command != "arm")
    return hal::Error{"'" + std::string(command) +
                      "' cannot be done: one real robot drives by itself, and its time has one speed"};
  if (clock_.now_ns() - stopped_ns_ < kArmAfter_ns)
    return hal::Error{"an emergency stop came less than a second ago; arm it once more if it is to drive"};
  arm_asked_ = true;
  return {};
}

void LoneHub::obey_emergency_stop() noexcept {
  if (estop_asked_.exchange(false)) lone_->real().emergency_stop(clock_.now_ns());
}

bool LoneHub::step() {
  mixed_reality::RealRobot& real = lone_->real();
  obey_emergency_stop();
  if (arm_asked_.exchange(false)) real.arm();
  if (rearm_asked().exchange(false)) real.rearm();
  real.set_guarded(guarded_->guarded());
  if (const std::uint64_t count = guarded_->freezes(); count != freezes_) {
    freezes_ = count;
    real.hub_was_frozen();
  }
  if (lone_->latch(ticks_, clock_.now_ns(), mixed_reality::RunPhase::Running) && !controller_->step(failure_, ticks_)) {
    failure_ = file_.who + " threw at tick " + std::to_string(ticks_) + ": " + failure_ + "; the robot is stopped";
    return false;
  }
  ++ticks_;
  return true;
}

/// For an end that leaves no time to make one.
void LoneHub::prepare_report() {
  if (report_) emergency_->set_report(report_so_far());
}

void LoneHub::commit() {
  const std::lock_guard hold(watchdog_->lock());  // what is saved changes
  guarded_->update();
  hub_faults_.apply(clock_.now_ns());
  lone_->commit(clock_.now_ns());  // at once, not after the wait
  if (emergency_->due()) prepare_report();
}

int LoneHub::drive() {
  pacer_.emplace(clock_, scenario_->ticks_per_second);
  const double seconds = options_.seconds.value_or(scenario_->length_s);
  const auto steps = static_cast<std::int64_t>(seconds * static_cast<double>(scenario_->ticks_per_second) + 0.5);
  freezes_ = guarded_->freezes();
  if (scenario_->priority > 0) {
    const hal::Status granted = mixed_reality::ask_for_realtime_priority(scenario_->priority);
    if (!granted.ok()) log_.warning(granted.error().message + "; going on without");
  }
  emergency_.emplace(report_);
  {
    const SaveAtEnd save(*watchdog_, [this] { prepare_report(); });
    prepare_report();
    core::Run run(*this, *stop_);
    run.add(std::make_unique<core::Length>(steps));
    run.add(std::make_unique<Driven>(*this));
    for (std::unique_ptr<core::RunPart>& part : sinks_) run.add(std::move(part));
    if (!options_.watch.watch) run.add(progress_part(steps, scenario_->ticks_per_second));
    run.add(pace_part(*pacer_, &watchdog_->lock(), {kLookEvery_ns, [this] { obey_emergency_stop(); }}));
    (void)run.go();
    if (failure_.empty()) failure_ = run.failure();
  }
  emergency_.reset();
  return end();
}

void LoneHub::stop() {
  bridges::RobotBridge& bridge = lone_->real().bridge();
  interrupted_ = stop_->load();
  if (failure_.empty() && !interrupted_ && bridge.health() == bridges::LinkHealth::Lost)
    failure_ = "robot '" + item_.id + "' was lost at the end: " + bridge.trouble();
  if (failure_.empty() && !guarded_->guarded())
    failure_ = "robot '" + item_.id + "' stood: the guardian process was gone";
  stop_and_wait(bridge, item_.bridge->stop_s, clock_);
}

int LoneHub::end() {
  bridges::RobotBridge& bridge = lone_->real().bridge();
  hal::Json json = report_so_far();
  const auto table = result_table(item_, bridge, pacer_->ledger());
  bridge.shut_down();
  const bool confirmed = guarded_->release_rested().empty();
  controller_.reset();
  print_table(table);
  if (!confirmed) {
    const std::string unconfirmed =
        "robot '" + item_.id + "' did not confirm its stop: switch it off by hand if it moves";
    failure_ += (failure_.empty() ? "" : "\n") + unconfirmed;
  }
  if (report_) {
    json["stop_confirmed"] = confirmed;
    add_files(json, options_.file, loader_, *file_.config);
  }
  return end_robot(report_, std::move(json), {.failure = failure_, .interrupted = interrupted_});
}

int drive_robot(const RobotOptions& options) {
  LoneHub hub(options);
  int code = hub.read();
  if (code == kDone) code = hub.prepare();
  if (code == kDone) code = hub.connect();
  return code == kDone ? hub.drive() : code;
}

int robot(const RobotOptions& options) {
  if (!options.link.starts_with(kPeerScheme)) return drive_robot(options);
  if (!options.record.empty() || options.watch.watch || options.page_port)
    return complain(kWrongUsage,
                    "--record, --watch and --view are for the run of the simulation that this is a peer of");
  return robot_peer(options);
}

}  // namespace

void RobotOptions::describe(hal::CommandLine& line) {
  line.word("file", file, "Experiment file with one robot that has a <bridge>").required().file();
  line.option("--link", link,
              "Where the robot is, instead of the file's, e.g. serial:/dev/rfcomm0@115200, can:can0, "
              "tcp:ROBOT:33333; peer:tcp:HOST:PORT or peer:serial:…: in lock-step with the simulation there");
  line.option("--robot", robot,
              "With peer:…: which robot of that simulation; '*': any that waits; default: the file's");
  line.option("--seconds", seconds, "How long, instead of the file's length").positive();
  line.option("--report", report, "Write a JSON report to this file ('-': standard output)").file();
  describe_robot_sinks(line, *this);
  describe_step_timeout(line, step_timeout_s);
  describe_hub_faults(line, hub_faults, "A");
  describe_plugins(line, plugins);
}

constinit const hal::CommandType robot_command = module_command<RobotOptions, robot>("robot");

}  // namespace tandem::app
