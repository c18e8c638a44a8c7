// `tandem robot`: one real robot's controller, run here.
#include <cstdio>
#include <fmt/format.h>

#include "app/bridged_controller.hpp"
#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/measure.hpp"
#include "app/progress.hpp"
#include "app/report.hpp"
#include "app/sha256.hpp"
#include "app/signals.hpp"
#include "bridges/epuck/bridge.hpp"
#include "bridges/epuck/guardian.hpp"
#include "bridges/link/link_text.hpp"
#include "hal/plugin_loader.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

namespace epuck = bridges::epuck;

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

std::vector<std::string> names_of(const std::vector<core::DeviceChoice>& choices) {
  std::vector<std::string> names;
  for (const core::DeviceChoice& c : choices) names.push_back(c.device);
  return names;
}

std::string report_of(const core::Scenario& scenario, const core::RobotItem& item, const epuck::BridgeStatus& status,
                      const mixed_reality::PaceLedger& pace, const std::string& library, const std::string& failure) {
  Json json;
  json.begin_object();
  json.field("experiment", scenario.name)
      .field("robot", item.id)
      .field("link", status.link)
      .field("firmware", status.identity.version_text());
  json.field("steps", pace.ticks)
      .field("deadline_misses", pace.deadline_misses)
      .field("state", epuck::state_name(status.state));
  json.field("wake_up_p99_ms", static_cast<double>(pace.wake_up.quantile_ns(0.99)) * 1e-6);
  json.field("packets", status.session.packets)
      .field("answers", status.session.answers)
      .field("silent", status.session.silent);
  json.field("cut_short", status.session.cut_short)
      .field("implausible", status.session.implausible)
      .field("resynchronised", status.session.resynchronised);
  json.field("restarts", status.session.restarts).field("links_lost", status.session.links_lost);
  json.field("commands_clamped", status.driver.clamped).field("commands_not_finite", status.driver.not_finite);
  json.field("bytes_in", status.bytes.bytes_in).field("bytes_out", status.bytes.bytes_out);
  if (const auto digest = sha256_of_file(library); digest.ok())
    json.field("controller", library).field("sha256", digest.value());
  if (!failure.empty()) json.field("failure", failure);
  json.end_object();
  return json.text();
}

void print_result(const core::RobotItem& item, const epuck::BridgeStatus& status,
                  const mixed_reality::PaceLedger& pace) {
  const epuck::SessionStatistics& s = status.session;
  print_table(
      {{"robot",
        fmt::format("{} on {}, {}", item.id, status.link.empty() ? item.bridge ? item.bridge->link : "" : status.link,
                    status.identity.version_text())},
       {"ticks", fmt::format("{}, {} missed their deadline, {:.2f} ms late at most", pace.ticks, pace.deadline_misses,
                             static_cast<double>(pace.largest_lateness_ns) * 1e-6)},
       {"answers",
        fmt::format(
            "{} of {} packets, {:.1f} ms round trip on average", s.answers, s.packets,
            s.answers > 0 ? static_cast<double>(s.sum_round_trip_ns) * 1e-6 / static_cast<double>(s.answers) : 0.0)},
       {"trouble", fmt::format("{} silences, {} answers cut short, {} implausible, {} restarts, {} links lost",
                               s.silent, s.cut_short, s.implausible, s.restarts, s.links_lost)},
       {"rolled", fmt::format("{:.3f} m left, {:.3f} m right", status.odometry.left_m, status.odometry.right_m)},
       {"at the end", epuck::state_name(status.state)}});
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
  const auto complain = [](int code, const std::string& message) {
    fmt::print(stderr, "error: {}\n", message);
    return code;
  };

  auto guardian = epuck::Guardian::start();  // before any thread
  if (!guardian.ok()) return complain(kFailedRunning, guardian.error().message);
  const auto address = bridges::parse_link(item.bridge->link);
  if (!address.ok()) return complain(kBadInput, address.error().message);
  auto opener = bridges::epuck::epuck_link_opener(address.value());
  if (!opener.ok()) return complain(kBadInput, opener.error().message);
  hal::PluginLoader loader(plugin_folders());
  const auto type = loader.controller(config.library, config.label);
  if (!type.ok()) return complain(kBadInput, "controller '" + config.id + "': " + type.error().message);
  core::Problems problems;
  core::ElementReader reader(item.params ? *item.params : config.params, problems);
  const auto params = type.value()->read_params(reader);
  reader.finish();
  print_problems(problems);
  if (core::has_errors(problems)) return kBadInput;

  epuck::BridgeSettings settings;
  settings.driver.robot.id = item.id;
  settings.driver.robot.seed = scenario->seed.value_or(1);
  settings.driver.robot.tick_ns = hal::time_of_tick(1, scenario->ticks_per_second);
  settings.driver.robot.sensors = names_of(config.sensors);
  settings.driver.robot.actuators = names_of(config.actuators);
  settings.driver.timing = epuck::timing_for(item.bridge->link);
  settings.driver.command_timeout_ns =
      std::max<hal::TimeNs>(static_cast<hal::TimeNs>(item.bridge->timeout_s * 1e9), 2 * settings.driver.robot.tick_ns);
  const hal::Log log([](hal::Severity, std::string_view text) { say(text); });
  epuck::EpuckBridge bridge(settings, std::move(opener).value(), log);

  std::unique_ptr<BridgedController> controller;
  try {
    controller = std::make_unique<BridgedController>(*type.value(), bridge.robot(), params.get());
  } catch (const std::exception& e) {
    return complain(kBadInput, "controller '" + config.id + "' of robot '" + item.id + "' " + e.what());
  }

  const std::atomic<bool>& stop = catch_signals();
  guardian->watch(address.value().target, address.value().rate);
  bridge.start();
  hal::Status ready;
  for (hal::TimeNs waited = 0; waited < kConnectWithin_ns && !stop.load(); waited += 200 * hal::kNsPerMs) {
    ready = bridge.wait_active(200 * hal::kNsPerMs);
    if (ready.ok()) break;
    const epuck::BridgeStatus status = bridge.status();
    if (waited >= kOpenWithin_ns && status.links_opened == 0 && !status.trouble.empty())
      break;  // the port itself is the trouble
  }
  if (stop.load() || !ready.ok()) guardian->release(address.value().target);  // it was never driven
  if (stop.load()) return kDone;
  if (!ready.ok()) return complain(kFailedRunning, "robot '" + item.id + "': " + ready.error().message);

  if (const epuck::Identity who = bridge.status().identity;
      !epuck::firmware_fits(item.bridge->firmware, who.firmware)) {
    guardian->release(address.value().target);
    return complain(kFailedRunning, "robot '" + item.id + "' runs the firmware '" + std::string(who.version_text()) +
                                        "', not '" + item.bridge->firmware +
                                        "' as the file says; correct firmware=\"…\" or say auto");
  }

  mixed_reality::MonotonicTime clock;
  mixed_reality::Pacer pacer(clock, scenario->ticks_per_second);
  const double seconds = options.seconds.value_or(scenario->length_s);
  const auto steps = static_cast<std::int64_t>(seconds * static_cast<double>(scenario->ticks_per_second) + 0.5);
  std::string failure;
  bridge.robot().set_origin(clock.now_ns());
  {
    Progress progress(steps, scenario->ticks_per_second);
    pacer.start();
    for (hal::Tick tick = 0; (steps == 0 || tick < steps) && !stop.load(std::memory_order_relaxed); ++tick) {
      bridge.latch(tick, clock.now_ns());
      if (!controller->step(failure)) {
        failure = "controller '" + config.id + "' of robot '" + item.id + "' threw at tick " + std::to_string(tick) +
                  ": " + failure + "; the robot is stopped";
        bridge.fault(clock.now_ns(), failure);
        break;
      }
      bridge.commit(clock.now_ns());  // at once, not after the wait
      progress.step(tick + 1);
      if (!pacer.wait_for_next(stop)) break;
    }
  }
  const epuck::BridgeStatus status = bridge.status();
  if (failure.empty() && !stop.load() && status.state == epuck::SessionState::Lost) {
    failure = "robot '" + item.id + "' was lost at the end: " + status.trouble;
  }
  bridge.shut_down();
  if (status.state != epuck::SessionState::Lost)
    guardian->release(address.value().target);  // else it may yet be stopped
  controller.reset();
  print_result(item, status, pacer.ledger());
  if (!options.report.empty()) {
    const std::string library = loader.find(config.library).value().string();
    const hal::Status written =
        write_report(options.report, report_of(*scenario, item, status, pacer.ledger(), library, failure));
    if (!written.ok()) return complain(kFailedRunning, written.error().message);
  }
  return failure.empty() ? kDone : complain(kFailedRunning, failure);
}

}  // namespace tandem::app
