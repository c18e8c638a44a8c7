// `tandem robot`: one real robot's controller, run here.
#include <cstdio>
#include <fmt/format.h>

#include "app/bridged_controller.hpp"
#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/driven_robot.hpp"
#include "app/measure.hpp"
#include "app/progress.hpp"
#include "app/report.hpp"
#include "app/sha256.hpp"
#include "app/signals.hpp"
#include "app/terminal.hpp"
#include "hal/plugin_loader.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

constexpr hal::TimeNs kConnectWithin_ns = 15 * hal::kNsPerSecond;
constexpr hal::TimeNs kOpenWithin_ns = hal::kNsPerSecond;

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

std::string report_of(const core::Scenario& scenario, const core::RobotItem& item, const DrivenRobot& robot,
                      const mixed_reality::PaceLedger& pace, const std::string& library, const std::string& failure) {
  Json json;
  json.begin_object();
  json.field("experiment", scenario.name).field("robot", item.id).field("link", robot.link());
  json.field("steps", pace.ticks).field("deadline_misses", pace.deadline_misses);
  json.field("wake_up_p99_ms", static_cast<double>(pace.wake_up.quantile_ns(0.99)) * 1e-6);
  robot.add_to_report(json);
  if (const auto digest = sha256_of_file(library); digest.ok())
    json.field("controller", library).field("sha256", digest.value());
  if (!failure.empty()) json.field("failure", failure);
  json.end_object();
  return json.text();
}

void print_result(const core::RobotItem& item, const DrivenRobot& robot, const mixed_reality::PaceLedger& pace) {
  const std::string link = robot.link();
  std::vector<std::pair<std::string, std::string>> rows = {
      {"robot", fmt::format("{} on {}", item.id, link.empty() ? item.bridge->link : link)},
      {"ticks", fmt::format("{}, {} missed their deadline, {:.2f} ms late at most", pace.ticks, pace.deadline_misses,
                            static_cast<double>(pace.largest_lateness_ns) * 1e-6)}};
  for (auto& row : robot.table()) rows.push_back(std::move(row));
  print_table(rows);
}

}  // namespace

int robot(const RobotOptions& options) {
  const auto scenario = read_or_complain(options.file, {});
  if (!scenario) return kBadInput;
  const core::RobotItem* found = only_robot(*scenario, options.link);
  if (found == nullptr) return kBadInput;
  core::RobotItem item = *found;
  if (!item.bridge) item.bridge = core::BridgeConfig{};
  if (!options.link.empty()) item.bridge->link = options.link;
  const core::ControllerConfig& config = scenario->controllers[item.controller];

  const hal::Log log([](hal::Severity, std::string_view text) { say(text); });
  auto made = make_driven_robot({item, config, scenario->ticks_per_second, scenario->seed.value_or(1)}, log);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  DrivenRobot& driven = **made;
  hal::PluginLoader loader(plugin_folders());
  const auto type = loader.controller(config.library, config.label);
  if (!type.ok()) return complain(kBadInput, "controller '" + config.id + "': " + type.error().message);
  core::Problems problems;
  core::ElementReader reader(item.params ? *item.params : config.params, problems);
  const auto params = type.value()->read_params(reader);
  reader.finish();
  print_problems(problems);
  if (core::has_errors(problems)) return kBadInput;

  std::unique_ptr<BridgedController> controller;
  try {
    controller = std::make_unique<BridgedController>(*type.value(), driven.robot(), params.get());
  } catch (const std::exception& e) {
    return complain(kBadInput, "controller '" + config.id + "' of robot '" + item.id + "' " + e.what());
  }

  const std::atomic<bool>& stop = catch_signals();
  driven.start();
  hal::Status ready;
  for (hal::TimeNs waited = 0; waited < kConnectWithin_ns && !stop.load(); waited += 200 * hal::kNsPerMs) {
    ready = driven.wait_active(200 * hal::kNsPerMs);
    if (ready.ok() || (waited >= kOpenWithin_ns && driven.unreachable())) break;
  }
  if (stop.load() || !ready.ok()) driven.forget();  // it was never driven
  if (stop.load()) return kDone;
  if (!ready.ok()) return complain(kFailedRunning, "robot '" + item.id + "': " + ready.error().message);
  if (const hal::Status who = driven.check_identity(); !who.ok()) {
    driven.forget();
    return complain(kFailedRunning, who.error().message);
  }

  mixed_reality::MonotonicTime clock;
  mixed_reality::Pacer pacer(clock, scenario->ticks_per_second);
  const double seconds = options.seconds.value_or(scenario->length_s);
  const auto steps = static_cast<std::int64_t>(seconds * static_cast<double>(scenario->ticks_per_second) + 0.5);
  std::string failure;
  driven.set_origin(clock.now_ns());
  {
    Progress progress(steps, scenario->ticks_per_second);
    pacer.start();
    for (hal::Tick tick = 0; (steps == 0 || tick < steps) && !stop.load(std::memory_order_relaxed); ++tick) {
      driven.latch(tick, clock.now_ns());
      if (!controller->step(failure)) {
        failure = "controller '" + config.id + "' of robot '" + item.id + "' threw at tick " + std::to_string(tick) +
                  ": " + failure + "; the robot is stopped";
        driven.fault(clock.now_ns(), failure);
        break;
      }
      driven.commit(clock.now_ns());  // at once, not after the wait
      progress.step(tick + 1);
      if (!pacer.wait_for_next(stop)) break;
    }
  }
  driven.shut_down();
  if (const std::string loss = driven.loss(); failure.empty() && !stop.load() && !loss.empty()) {
    failure = "robot '" + item.id + "' was lost at the end: " + loss;
  }
  controller.reset();
  print_result(item, driven, pacer.ledger());
  if (!options.report.empty()) {
    const std::string library = loader.find(config.library).value().string();
    const hal::Status written =
        write_report(options.report, report_of(*scenario, item, driven, pacer.ledger(), library, failure));
    if (!written.ok()) return complain(kFailedRunning, written.error().message);
  }
  return failure.empty() ? kDone : complain(kFailedRunning, failure);
}

}  // namespace tandem::app
