// `tandem preflight`: everything that would stop a run with real robots, before anything moves.
#include "mixed_reality/desk/preflight.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <iostream>
#include <unistd.h>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/run_report.hpp"
#include "app/process/progress.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/real/desk_keys.hpp"
#include "app/real/desks.hpp"
#include "app/real/guarded_robots.hpp"
#include "app/real/lockstep_peers.hpp"
#include "app/real/mixed_run.hpp"
#include "app/real/motion_memory.hpp"
#include "core/sim/world.hpp"
#include "hal/output_file.hpp"
#include "mixed_reality/settings/tracker_check.hpp"

namespace tandem::app {
namespace {

struct PreflightOptions {
  Libraries plugins;
  std::string experiment;
  std::vector<std::string> overrides;
  std::vector<std::string> without;  ///< real robots that are simulated instead, by id
  std::optional<double> wait_s;      ///< for robots to answer; none: as long as the run would
  double listen_s = 2.0;             ///< to robots and trackers, after that
  bool move = false;                 ///< the first motion test
  bool yes = false;                  ///< … without asking
  bool json = false;
  std::string report;
  std::string desk_keys;  ///< as of `run`

  void describe(hal::CommandLine& line) {
    line.footer("Exit code: 0 nothing is in the way, 1 bad input, 3 something is.");
    line.word("experiment", experiment, "The experiment file (.xml)").required().file();
    line.flag("--move", move, "First motion: each robot turns a little, one after the other");
    line.flag("--yes", yes, "… without asking on the terminal").needs("--move");
    line.option("--wait", wait_s, "Seconds for robots to answer; default: as long as the run would wait")
        .range(0.0, 3600.0);
    line.option("--listen", listen_s, "Seconds to listen to robots and trackers after that")
        .show_default()
        .range(0.1, 3600.0);
    describe_desk_keys(line, desk_keys);
    line.option("--without", without, "Leave this robot out; repeatable").repeatable();
    line.option("--set", overrides, "Change the experiment first: path=value; repeatable").repeatable();
    line.flag("--json", json, "One JSON object instead of a table");
    line.option("--report", report, "Write the JSON object to this file, too").file();
    describe_plugins(line, plugins);
  }
};

using mixed_reality::Finding;
using mixed_reality::PreflightRow;
using mixed_reality::PreflightRows;

void add_file(const char* what, const InputFile& file, PreflightRows& rows) {
  const std::string about = file.id.empty() ? file.label : file.id;
  const bool there = !file.sha256.empty();
  rows.push_back({what + (about.empty() ? std::string() : " " + about), "file", there ? Finding::Ok : Finding::Fail,
                  file.file + (there ? ", sha256 " + file.sha256.substr(0, 16) : ": it cannot be read"),
                  there ? "" : "see whether it is there, and may be read"});
}

PreflightRows rows_of_files(const InputFiles& files) {
  PreflightRows rows;
  add_file("experiment", files.experiment, rows);
  for (const InputFile& file : files.plugins) add_file("plug-in", file, rows);
  for (const InputFile& file : files.controllers) add_file("controller", file, rows);
  for (const InputFile& file : files.hooks) add_file("hook", file, rows);
  return rows;
}

/// Who may command the run over LCM.
PreflightRow row_of_desk(const core::DeskConfig& desk, const std::string& keys_file) {
  const std::string about = "desk " + desk.lcm;
  const auto keys = keys_to_listen(keys_file, desk.lcm, desk.channel);
  if (!keys.ok()) return {about, "keys", Finding::Fail, keys.error().message, "see --desk-keys"};
  std::string people;
  for (const bridges::desk::DeskKey& key : keys.value()) {
    people += people.empty() ? "" : ", ";
    people += (key.who == "*" ? "anybody who has the key" : key.who) + " (" + std::string(name_of(key.role)) + ")";
  }
  return {about, "keys", Finding::Ok, people, ""};
}

/// A run in lock-step: whether its peers come, and run what the hub's file names.
PreflightRows look_over_peers(core::World& world, const hal::PluginLoader& loader, const std::atomic<bool>& stop) {
  PreflightRows rows;
  const hal::Log log([](hal::Severity, std::string_view text) { say(text); });
  auto made = make_lockstep(world, loader, stop, log);
  if (!made.ok()) {
    rows.push_back({"peers", "port", Finding::Fail, made.error().message, "see <peers listen> and <peer link>"});
    return rows;
  }
  mixed_reality::LockstepRun& run = *made.value();
  if (!run.address().empty()) log.info("peers connect to " + run.address());
  (void)run.connect();  // who is missing, the rows tell
  for (const mixed_reality::PartnerReport& peer : run.report().peers) {
    const std::string about = "peer " + peer.robot;
    const auto add = [&](const char* check, Finding finding, std::string found, std::string advice) {
      rows.push_back({about, check, finding, std::move(found), std::move(advice)});
    };
    if (peer.ready)
      add("link", Finding::Ok, peer.link, "");
    else
      add("link", Finding::Fail, (peer.link.empty() ? "" : peer.link + ": ") + peer.state,
          "see what its own terminal says");
    if (!peer.controller) continue;
    const bridges::peer::CopyComparison& c = *peer.controller;
    if (!c.differs.empty())
      add("controller", world.scenario().lockstep.any_controller ? Finding::Warn : Finding::Fail, c.differs,
          "bring both to one version, or accept that with <peers controllers=\"any\">");
    if (!c.same.empty()) add("controller", Finding::Ok, "the same here and there: " + c.same, "");
    if (!c.not_compared.empty())
      add("controller", Finding::Warn, "not compared: " + c.not_compared, "make sure by hand that it is the right one");
  }
  run.let_go();
  return rows;
}

/// Robots stand for at most so long, and people see `what` is waited for.
hal::Status stand_by(mixed_reality::MixedSession& session, const char* what, double most_s,
                     const std::function<bool()>& enough, const std::atomic<bool>& stop) {
  mixed_reality::MonotonicTime clock;
  const hal::TimeNs began_ns = clock.now_ns();
  const hal::TimeNs most_ns = static_cast<hal::TimeNs>(most_s * 1e9);
  Progress progress(std::max<hal::TimeNs>(1, most_ns), hal::kNsPerSecond, what);
  return session.stand_by(
      [&] {
        const hal::TimeNs waited_ns = clock.now_ns() - began_ns;
        progress.step(waited_ns);
        return enough() || waited_ns >= most_ns;
      },
      stop);
}

/// Waits for the robots as a run would, and then listens for a while.
hal::Status listen(mixed_reality::MixedSession& session, const PreflightOptions& options,
                   const std::atomic<bool>& stop) {
  double wait_s = 0.0;
  for (const core::RobotItem& item : session.world().scenario().robots) {
    if (item.bridge) wait_s = std::max(wait_s, item.bridge->connect_s);
  }
  wait_s = options.wait_s.value_or(wait_s);
  if (const hal::Status waited = stand_by(
          session, "waiting for robots to answer", wait_s, [&] { return session.all_answer(); }, stop);
      !waited.ok())
    return waited;
  return stand_by(
      session, "listening to robots and trackers", options.listen_s, [] { return false; }, stop);
}

/// What a person on the terminal says to "turn it?": y, n, a (all), q (no more). Ctrl-C counts as q.
char asked(const std::string& robot, const std::atomic<bool>& stop) {
  fmt::print(stderr, "turn '{}' a little? [y]es, [n]o, [a]ll, [q]uit: ", robot);
  std::string line;
  if (stop.load() || !std::getline(std::cin, line) || stop.load()) return 'q';
  return line.empty() ? 'n' : line.front();
}

PreflightRows move_all(mixed_reality::MixedSession& session, const PreflightOptions& options,
                       const std::atomic<bool>& stop) {
  PreflightRows rows;
  bool ask = !options.yes && ::isatty(STDIN_FILENO) == 1;
  for (const auto& robot : session.status()) {
    const auto skip = [&](const char* why) {
      rows.push_back({"robot " + robot.id, "motion", Finding::Warn, why, "try it alone, before it is among others"});
    };
    if (session.world().space().kind(robot.robot).drive() == nullptr) {
      skip("not tried: it has no wheels to turn on");
      continue;
    }
    if (robot.health != bridges::LinkHealth::Active) continue;  // that was told
    if (ask) {
      const char said = asked(robot.id, stop);
      if (said == 'q') break;
      if (said == 'a') ask = false;
      if (said != 'a' && said != 'y') {
        skip("not tried");
        continue;
      }
    }
    say("turning '" + robot.id + "' to the left and back; Ctrl-C stops it");
    const PreflightRows moved = mixed_reality::try_motion(session, robot.id, stop);
    rows.insert(rows.end(), moved.begin(), moved.end());
    if (stop.load()) break;
  }
  return rows;
}

/// Real robots, their trackers and this computer. @returns kDone, or why nothing could be looked at, which was told
int look_over_robots(const PreflightOptions& options, const core::Scenario& scenario, hal::PluginLoader& loader,
                     std::unique_ptr<core::World>& world, GuardedRobots& guarded, const std::atomic<bool>& stop,
                     PreflightRows& rows) {
  mixed_reality::MonotonicTime clock;
  mixed_reality::MixedOptions mixed;
  mixed.ask_batteries = true;
  mixed.before_commands = [&guarded] { guarded.update(); };
  auto made = make_session(loader.catalog(), world, guarded, clock, std::move(mixed));
  if (!made.ok()) return complain(kBadInput, made.error().message);
  const auto session = std::move(made).value();
  for (const auto& robot : guarded.abandoned())
    rows.push_back({robot.abandoned.holder.robot.robot, "left behind", robot.confirmed ? Finding::Warn : Finding::Fail,
                    robot.to_text(), robot.confirmed ? "" : "see to it by hand"});
  const hal::Status claimed = guarded.claim();
  rows.push_back({"guardian", "robots", claimed.ok() ? Finding::Ok : Finding::Fail,
                  claimed.ok() ? "nobody else drives them" : claimed.error().message,
                  claimed.ok() ? "" : "end the other program"});
  for (const std::string& outlook : mixed_reality::outlooks(scenario, loader.catalog()))
    rows.push_back({"trackers", "outlook", Finding::Ok, outlook, ""});
  const auto append = [&rows](const PreflightRows& more) { rows.insert(rows.end(), more.begin(), more.end()); };
  if (claimed.ok()) {
    if (const hal::Status listened = listen(*session, options, stop); !listened.ok() && !stop.load())
      rows.push_back({"trackers", "listen", Finding::Fail, listened.error().message, "see the tracker's address"});
    append(mixed_reality::look_over(*session));
    append(mixed_reality::look_over_machine(scenario, session->woke_late()));
    if (options.move && !stop.load() && worst_of(rows) == Finding::Fail)
      rows.push_back({"motion", "test", Finding::Warn, "not tried, as something is in the way", "mend that first"});
    else if (options.move && !stop.load())
      append(move_all(*session, options, stop));
    if (options.move && !stop.load()) {
      if (const hal::Status kept = keep_motions(guarded.robots(), rows); !kept.ok())
        complain(kFailedRunning, kept.error().message);
    }
    session->stop_robots();
    session->shut_down();
  }
  (void)guarded.release_rested();
  return kDone;
}

void print_rows(const PreflightRows& rows) {
  std::size_t about = 0, check = 0;
  for (const PreflightRow& row : rows) {
    about = std::max(about, row.about.size());
    check = std::max(check, row.check.size());
  }
  for (const PreflightRow& row : rows) {
    fmt::print("{:<4}  {:<{}}  {:<{}}  {}\n", name_of(row.finding), printable(row.about), about, printable(row.check),
               check, printable(row.found));
    if (!row.advice.empty()) fmt::print("{:<{}}-> {}\n", "", about + check + 10, printable(row.advice));
  }
  const auto count = [&](Finding finding) {
    return std::count_if(rows.begin(), rows.end(), [&](const PreflightRow& row) { return row.finding == finding; });
  };
  fmt::print("{} ok, {} to look at, {} in the way: {}\n", count(Finding::Ok), count(Finding::Warn),
             count(Finding::Fail), count(Finding::Fail) == 0 ? "the run can begin" : "the run would not go well");
}

int preflight(const PreflightOptions& options) {
  hal::PluginLoader loader = make_loader();
  ExperimentReading reading(loader, options.plugins);
  if (!reading.open(options.experiment, options.overrides)) return kBadInput;
  GuardedRobots guarded(reading.has_real_robots(options.without), loader.catalog(),
                        hal::Log([](hal::Severity, std::string_view text) { say(text); }));  // before any thread
  auto scenario = reading.read();
  if (!scenario) return kBadInput;
  if (const hal::Status left_out = leave_out(*scenario, options.without); !left_out.ok())
    return complain(kBadInput, left_out.error().message);
  const bool peers = has_peers(*scenario);  // then nobody has a bridge
  if (!has_real_robots(*scenario) && !peers)
    return complain(kBadInput,
                    "no robot of this experiment has a <bridge> or a <peer>: `tandem check` is all that it needs");
  if (peers && options.move)
    return complain(kBadInput, "--move is for real robots; those of a run in lock-step are simulated");
  if (peers) scenario->lockstep.simulate_missing = false;  // who is missing is told
  if (peers && options.wait_s) scenario->lockstep.timeout_s = *options.wait_s;
  if (!guarded.started().ok()) return complain(kFailedRunning, guarded.started().error().message);
  const std::atomic<bool>& stop = catch_signals();
  std::signal(SIGPIPE, SIG_IGN);
  core::WorldOptions world_options;
  core::Problems problems;
  auto world = core::World::make(*scenario, loader, world_options, problems);
  print_problems(problems);
  if (world == nullptr) return kBadInput;
  PreflightRows rows = rows_of_files(input_files(*scenario, loader));
  if (!scenario->desk.lcm.empty()) rows.push_back(row_of_desk(scenario->desk, options.desk_keys));
  if (peers) {
    const PreflightRows more = look_over_peers(*world, loader, stop);
    rows.insert(rows.end(), more.begin(), more.end());
  } else if (const int code = look_over_robots(options, *scenario, loader, world, guarded, stop, rows); code != kDone) {
    return code;
  }
  if (stop.load()) return interrupted_code();

  const hal::Json json = {{"experiment", scenario->file},
                          {"worst", name_of(worst_of(rows))},
                          {"moved", options.move},
                          {"preflight", to_json(rows)}};
  if (options.json) {
    fmt::print("{}\n", hal::to_text(json));
  } else {
    print_rows(rows);
  }
  if (!options.report.empty()) {
    const hal::Status written = hal::write_whole_file(options.report, "report", hal::to_text(json) + "\n");
    if (!written.ok()) return complain(kFailedRunning, written.error().message);
  }
  return worst_of(rows) == Finding::Fail ? kFailedRunning : kDone;
}

}  // namespace

constinit const hal::CommandType preflight_command = module_command<PreflightOptions, preflight>("preflight");

}  // namespace tandem::app
