// The `tandem` command: its words and its exit codes.
#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/build_info.hpp"
#include "app/command/command.hpp"
#include "app/command/command_groups.hpp"
#include "app/command/robot_commands.hpp"
#include "app/command/validate.hpp"
#include "app/process/emergency.hpp"
#include "app/process/signals.hpp"

namespace {

using namespace tandem::app;

void add_desk_keys(CLI::App& c, std::string& keys) {
  c.add_option("--desk-keys", keys,
               "Who commands over LCM (<desk lcm=…>): a file of lines NAME ROLE SECRET; default: this user's");
}

/// How pictures and films look.
void add_looks(CLI::App& c, PictureRequest& o) {
  c.add_option("--picture-size", o.size_px, "Pixels of the longer side of what is shown")
      ->capture_default_str()
      ->check(CLI::Range(64, 16'000));
  c.add_option("--picture-region", o.region, "Only this part of the arena: X0,Y0,X1,Y1 in metres")
      ->delimiter(',')
      ->expected(4);
  c.add_option("--picture-trails", o.trails_s, "Where robots were in so many seconds before")
      ->check(CLI::NonNegativeNumber);
  c.add_flag("--picture-axes", o.axes, "Coordinates along the frame");
  c.add_flag("--picture-ids", o.ids, "The id beside every robot");
}

void add_film(CLI::App& c, CLI::Option& film, PictureRequest& o) {
  c.add_option("--film-every", o.film_every, "A frame every so many ticks")
      ->capture_default_str()
      ->check(CLI::PositiveNumber)
      ->needs(&film);
  c.add_option("--film-rate", o.film_rate, "Frames a second; default: as fast as it was, 60 at most")
      ->check(CLI::Range(0.1, 240.0))
      ->needs(&film);
}

/// Who may look where, and how the run is held for those who do.
void add_window(CLI::App& c, RunOptions& o) {
  c.add_option("--view-address", o.view.address,
               "Where the window listens; 0.0.0.0: on all networks of this machine, for all who know its token")
      ->capture_default_str();
  c.add_option("--view-origin", o.view.origins,
               "An address besides its own by which browsers reach the window, http://host:port, as through a proxy; "
               "repeatable")
      ->allow_extra_args(false);
  c.add_flag("--projector", o.view.projector, "Tell the address of the page for a projector over the arena, too");
  c.add_flag("--paused,--hold", o.hold.paused,
             "Wait at the start until somebody lets the run go; real robots are connected, and stand");
  c.add_option("--speed", o.hold.speed, "At the start: times real time")->check(CLI::Range(0.001, 1e6));
  c.add_option("--view-memory", o.hold.memory_MB, "MB for checkpoints, by which one can go back")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
}

/// What `run` and `view` have in common.
void add_run_options(CLI::App* c, RunOptions& o) {
  auto* seconds =
      c->add_option("--seconds", o.seconds, "Virtual duration, instead of the file's")->check(CLI::PositiveNumber);
  c->add_option("--steps", o.steps, "Number of control steps, instead of the file's length")
      ->check(CLI::PositiveNumber)
      ->excludes(seconds);
  c->add_option("--seed", o.seed, "Seed of all chance, instead of the file's");
  c->add_option("--threads", o.threads, "Threads that step the world; results do not depend on it")
      ->check(CLI::Range(0, 1024));
  c->add_option("--set", o.overrides,
                "Change the experiment: path=value, e.g. framework.experiment.length=5; repeatable")
      ->allow_extra_args(false);
  c->add_option("--report", o.report, "Write a JSON report to this file ('-': standard output)");
  auto* picture =
      c->add_option("--picture", o.pictures.picture, "Draw the space from above at the end: FILE.svg, .png or .pdf");
  c->add_option("--picture-at", o.pictures.at, "… and after these numbers of ticks, as FILE-000100.svg: 0,100,200")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber)
      ->needs(picture);
  add_looks(*c, o.pictures);
  c->add_option("--picture-layers", o.pictures.layers, "Layers over pictures and films: `tandem list layers`")
      ->delimiter(',');
  auto* film = c->add_option("--film", o.pictures.film,
                             "Make a film: FILE.mp4 or .mkv (ffmpeg), or pictures: FOLDER/ or FOLDER/%06d.png");
  add_film(*c, *film, o.pictures);
  c->add_option("--povray", o.pictures.povray,
                "Write the space at the end as a scene in perspective: FILE.pov, or FILE.png to render that, too");
  c->add_option("--trajectory", o.trajectory, "Write poses as CSV");
  c->add_option("--record", o.record, "Write a record: poses, state, and what <record> names; for `tandem export`");
  c->add_option(
      "--repeat", o.repeat,
      "Do what was done by hand in the run of this record (--record) again, at the same ticks, with its seed");
  c->add_option("--log", o.log, "Write all messages of the run to this file: of controllers, too");
  auto* dump =
      c->add_option("--dump", o.dump, "Write every value of the state at the end as CSV, for `tandem compare`");
  c->add_option("--dump-every", o.dump_every, "… and after every so many ticks")
      ->check(CLI::PositiveNumber)
      ->needs(dump);
  add_step_timeout(*c, o.step_timeout_s);
  add_desk_keys(*c, o.hold.desk_keys);
  c->add_flag("--anyway", o.anyway, "Drive real robots although their last first motion (preflight --move) failed");
  c->add_option("--step-limit", o.step_limit_s,
                "End the run, as a failure, when a controller or hook has not returned after so many seconds; 0: never")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  c->add_option("--without", o.without, "Simulate this robot instead of driving the real one; repeatable")
      ->allow_extra_args(false);
  c->add_flag("--quiet", o.quiet, "No table at the end");
  auto* watch =
      c->add_flag("--watch", o.watch.watch, "A live table of the run on the terminal; keys pause it and more");
  c->add_option("--watch-robots", o.watch.robots, "Only these, separated by commas; '*' stands for any text")
      ->delimiter(',')
      ->needs(watch);
  c->add_option("--watch-port", o.watch.port, "The fields of this port, instead of what controllers publish")
      ->needs(watch);
  c->add_option("--hub-fault", o.hub_faults,
                "With real robots: a fault of this program, e.g. stall@5s+0.4s, freeze@5s+2s, kill@5s, clock=1h@5s; "
                "repeatable")
      ->allow_extra_args(false);
  add_plugins(*c, o.plugins);
  add_window(*c, o);
}

void add_run(CLI::App& app, RunOptions& o, int& code) {
  CLI::App* c = app.add_subcommand("run", "Run an experiment.");
  c->add_option("experiment", o.experiment, "The experiment file (.xml)")->required();
  const auto want_view = [&o](std::int64_t port) {  // CLI11 makes -1 of 0
    o.view.on = o.view.no_browser = true;
    o.view.port = std::max<std::int64_t>(0, port);
  };
  c->add_flag_function("--view{0}", want_view,
                       "Serve a page that shows the run, on port --view=PORT or any that is free");
  c->add_flag("--view-stay", o.hold.stay, "… until somebody ends the program");
  add_run_options(c, o);
  c->callback([&] { code = run(o); });
}

void add_view(CLI::App& app, RunOptions& o, int& code) {
  CLI::App* c = app.add_subcommand(
      "view",
      "Run an experiment, or play a record, behind a page in the browser, until Ctrl-C: watch, stop, go back, "
      "click, drag, plot.");
  c->footer(
      "It begins in real time. All options but those of the window are those of `tandem run`; a record takes the "
      "window's alone.");
  c->add_option("experiment", o.experiment, "The experiment file (.xml), or a record of `tandem run --record`")
      ->required();
  c->add_option("--port", o.view.port, "Where the page is served; 0: any port that is free")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  c->add_flag("--no-browser", o.view.no_browser, "Only tell the address");
  add_run_options(c, o);
  c->callback([&] { code = view(o); });
}

void add_replay(CLI::App& app, RunOptions& o, int& code) {
  CLI::App* c = app.add_subcommand(
      "replay", "Compute a run with real robots again out of its record, without them, and compare every tick.");
  c->footer(
      "With --from the robots are simulated from that tick on, and it is told how far they go astray from the real "
      "ones. What --set and --controller change holds from that tick on too; without --from it holds from the start.");
  c->add_option("record", o.replay.record, "The record of `tandem run --record`; of one that was killed FILE.part")
      ->required();
  c->add_option(
       "--from", o.replay.from,
       "What if: until this tick all is as recorded; from it on the robots are simulated, with what is changed")
      ->check(CLI::NonNegativeNumber);
  c->add_option("--until", o.replay.until, "So many ticks are done; default: all that are recorded")
      ->check(CLI::PositiveNumber);
  c->add_option("--controller", o.replay.controllers,
                "Another controller: ROBOT=ID or KIND=ID, an id of the experiment's <controllers>; repeatable")
      ->allow_extra_args(false);
  c->add_flag("--accept-changes", o.replay.accept_changes,
              "Also with plug-ins and files that are not those of the run");
  const auto want_view = [&o](std::int64_t port) {
    o.view.on = o.view.no_browser = true;
    o.view.port = std::max<std::int64_t>(0, port);
  };
  c->add_flag_function("--view{0}", want_view, "Serve a page that shows it, on port --view=PORT or any that is free");
  c->add_flag("--view-stay", o.hold.stay, "… until somebody ends the program");
  add_run_options(c, o);
  for (const char* other :
       {"--seconds", "--steps", "--seed", "--repeat", "--without", "--anyway", "--hub-fault", "--desk-keys"})
    c->remove_option(c->get_option(other));
  c->callback([&] { code = replay(o); });
}

void add_compare(CLI::App& app, CompareOptions& o, int& code) {
  CLI::App* c = app.add_subcommand("compare", "Name the first tick and the values in which two runs differ.");
  c->footer("Exit code: 0 equal, 4 different. Real robots are simulated; hooks do not learn of the end.");
  c->add_option("a", o.a, "An experiment, which is run, or what `tandem run --dump` wrote")->required();
  c->add_option("b", o.b, "The other one; default: the same again");
  auto* seconds = c->add_option("--seconds", o.seconds, "Virtual duration of runs, instead of the file's")
                      ->check(CLI::PositiveNumber);
  c->add_option("--steps", o.steps, "Number of control steps, instead of the file's length")
      ->check(CLI::PositiveNumber)
      ->excludes(seconds);
  c->add_option("--seed", o.seed, "Seed of all chance in both, instead of the files'");
  c->add_option("--threads-a", o.threads_a, "Threads that step A")->check(CLI::Range(0, 1024));
  c->add_option("--threads-b", o.threads_b, "Threads that step B")->check(CLI::Range(0, 1024));
  c->add_option("--set", o.overrides, "Change both experiments: path=value; repeatable")->allow_extra_args(false);
  c->add_option("--set-a", o.overrides_a, "Change A alone; repeatable")->allow_extra_args(false);
  c->add_option("--set-b", o.overrides_b, "Change B alone; repeatable")->allow_extra_args(false);
  add_plugins(*c, o.plugins);
  c->callback([&] { code = compare(o); });
}

void add_export(CLI::App& app, ExportOptions& o, int& code) {
  CLI::App* c =
      app.add_subcommand("export", "Say what a record of `tandem run --record` holds, or make a table of it.");
  c->add_option("record", o.record, "The record; that of a run that was killed is FILE.part")->required();
  c->add_option("--csv", o.csv, "Write comma-separated values of one table to this file ('-': standard output)");
  c->add_option("--hdf5", o.hdf5, "Write the tables as data sets to this file, for h5py, Matlab, …");
  c->add_option("--table", o.stream, "Which table, as the record names it; default: in CSV 'pose', in HDF5 all");
  c->add_option("--fields", o.fields, "Of HDF5: only these fields, separated by commas")->delimiter(',');
  c->add_option("--entities", o.entities, "Only of these, separated by commas; '*' stands for any text")
      ->delimiter(',');
  c->add_option("--from", o.from, "First tick");
  c->add_option("--until", o.until, "Last tick");
  c->add_option("--every", o.every, "Only every so manyth tick")->check(CLI::PositiveNumber);
  c->callback([&] { code = export_record(o); });
}

void add_drawing(CLI::App& app, DrawOptions& picture, DrawOptions& film, int& code) {
  CLI::App* p = app.add_subcommand("picture", "Draw a picture of a record of `tandem run --record`.");
  p->add_option("record", picture.record, "The record; that of a run that was killed is FILE.part")->required();
  p->add_option("--at", picture.at, "After so many ticks; default: the last that the record holds")
      ->check(CLI::NonNegativeNumber);
  auto* out = p->add_option_group("output", "Where to");
  out->add_option("-o,--picture", picture.pictures.picture, "FILE.svg, .png or .pdf");
  out->add_option("--povray", picture.pictures.povray,
                  "A scene in perspective: FILE.pov, or FILE.png to render that, too");
  out->require_option(1, 2);
  add_looks(*p, picture.pictures);
  p->callback([&] { code = draw_picture(picture); });

  CLI::App* f = app.add_subcommand("film", "Make a film of a record of `tandem run --record`.");
  f->add_option("record", film.record, "The record; that of a run that was killed is FILE.part")->required();
  auto* to = f->add_option("-o,--film", film.pictures.film,
                           "FILE.mp4 or .mkv (ffmpeg), or pictures: FOLDER/ or FOLDER/%06d.png")
                 ->required();
  add_film(*f, *to, film.pictures);
  add_looks(*f, film.pictures);
  f->callback([&] { code = draw_film(film); });
}

void add_bench(CLI::App& app, BenchOptions& o, int& code) {
  CLI::App* c = app.add_subcommand("bench", "Run a benchmark: one JSON object a line, and figures.");
  c->footer(
      "With --from the options --robots, --engine, --threads, --partition, --regions, --density and --assignment "
      "choose among the saved lines.");
  c->add_option(
       "name", o.name,
       "diffusion: the standard scene; flocking: robots that fly, in space; codec: messages of a bridge, only with "
       "--repeat; record: what a record of all poses costs, with --robots, --threads, --ticks; sense_to_act: how soon "
       "robots are answered over LCM, with --robots, --seconds, --real-time, "
       "--repeat; back: the way back to an earlier tick, e.g. after --ticks 6000; view: what a window costs, in "
       "--repeat "
       "pairs of --ticks; sweep: what a sweep costs besides its runs, with --robots, --ticks, --repeat: how many runs "
       "(10000); gap: hidden parameters of --robots (50) found again, and controllers ranked in --repeat (200) "
       "pseudo-realities; lockstep: a hub and --robots peers, each a process, with --ticks, --repeat; "
       "python: steps over arrays of --robots (10000), and --repeat (600) whole runs, by the module for Python")
      ->capture_default_str();
  c->add_option("--robots", o.robots, "Numbers of robots, e.g. 1000,10000; default: 1 to 100000")
      ->delimiter(',')
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{100'000'000}));
  auto* robot = c->add_option("--robot", o.robot, "Kind of robot; default: the one of the benchmark's scene");
  c->add_option("--in", o.file, "A file with kinds of robots that --robot may name, too");
  auto* with = c->add_option("--with", o.devices,
                             "Devices besides proximity sensors and wheels: range_and_bearing, omnidirectional_camera "
                             "(of robots that have one); proximity:NAME: another implementation of those")
                   ->delimiter(',');
  c->add_option("--engine", o.engines,
                "Physics engines; `tandem list engines` names them; default: its first, for flocking the first for "
                "robots that fly")
      ->delimiter(',');
  c->add_option("--threads", o.threads, "Numbers of threads, e.g. 0,2; default: 0")
      ->delimiter(',')
      ->check(CLI::Range(0, 1024));
  auto* partitions = c->add_option("--partition", o.partitions,
                                   "Divide the arena in equal parts: A1, A2 (2x1), A4 (2x2), A8 (4x2), A16 (4x4)")
                         ->delimiter(',');
  c->add_option("--regions", o.regions, "Divide it otherwise, e.g. 5x3; default: auto")
      ->delimiter(',')
      ->excludes(partitions);
  auto* ticks =
      c->add_option("--ticks", o.ticks, "Steps that are timed")->capture_default_str()->check(CLI::PositiveNumber);
  c->add_option("--density", o.density, "equal: the arena grows with the number of robots; else it is 40 m");
  c->add_option("--assignment", o.assignment, "Of work to threads: static (default) or dynamic");
  auto* repeat = c->add_option("--repeat", o.repeat, "How often each is run, in turns; figures show medians")
                     ->capture_default_str()
                     ->check(CLI::PositiveNumber);
  c->add_option("--plot", o.plot, "Draw wall time and speed-up against robots: FILE.svg or FILE.png (gnuplot-nox)");
  c->add_option("--from", o.from, "Take saved lines from this file instead of measuring")
      ->excludes(robot)
      ->excludes(with)
      ->excludes(ticks)
      ->excludes(repeat);
  c->add_option("--seconds", o.seconds, "Of sense_to_act: how long it is timed")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 3600.0));
  c->add_flag("--real-time", o.real_time, "Of sense_to_act: with the scheduling class SCHED_FIFO");
  c->add_flag("--compare-threads", o.compare_threads,
              "Print how many times faster each number of threads is than the first");
  add_plugins(*c, o.plugins);
  c->callback([&] { code = bench(o); });
}

void add_plugin_commands(CLI::App& app, PluginNewOptions& made, PluginCheckOptions& checked, int& code) {
  CLI::App* c = app.add_subcommand("plugin", "Begin a plug-in, or check one: `plugin new NAME`, `plugin check FILE`.");
  c->require_subcommand(1);
  CLI::App* n = c->add_subcommand("new", "Make a folder with a plug-in that builds, an experiment and a test.");
  n->add_option("name", made.name, "Of the folder and the library: a to z, 0 to 9 and _")->required();
  n->add_option("--kind", made.kind, "What it begins with")
      ->capture_default_str()
      ->check(CLI::IsMember(plugin_kinds()));
  n->callback([&] { code = plugin_new(made); });
  CLI::App* k =
      c->add_subcommand("check", "Judge what a plug-in registers, each part by its table and in small worlds.");
  k->footer("Exit code: 0 no fault was found, 1 faults, or a library that cannot be loaded.");
  k->add_option("file", checked.file, "The library")->required();
  k->add_flag("--json", checked.json, "One JSON object instead of lines");
  add_plugins(*k, checked.plugins);
  k->callback([&] { code = plugin_check(checked); });
}

void add_desk(CLI::App& app, PreflightOptions& p, DeskOptions& d, int& code) {
  CLI::App* c = app.add_subcommand(
      "preflight", "Look for everything that would stop a run with real robots, before anything moves.");
  c->footer("Exit code: 0 nothing is in the way, 1 bad input, 3 something is.");
  c->add_option("experiment", p.experiment, "The experiment file (.xml)")->required();
  auto* move = c->add_flag("--move", p.move, "First motion: each robot turns a little, one after the other");
  c->add_flag("--yes", p.yes, "… without asking on the terminal")->needs(move);
  c->add_option("--wait", p.wait_s, "Seconds for robots to answer; default: as long as the run would wait")
      ->check(CLI::Range(0.0, 3600.0));
  c->add_option("--listen", p.listen_s, "Seconds to listen to robots and trackers after that")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 3600.0));
  add_desk_keys(*c, p.desk_keys);
  c->add_option("--without", p.without, "Leave this robot out; repeatable")->allow_extra_args(false);
  c->add_option("--set", p.overrides, "Change the experiment first: path=value; repeatable")->allow_extra_args(false);
  c->add_flag("--json", p.json, "One JSON object instead of a table");
  c->add_option("--report", p.report, "Write the JSON object to this file, too");
  add_plugins(*c, p.plugins);
  c->callback([&] { code = preflight(p); });

  CLI::App* k = app.add_subcommand("desk", "Command the real robots of a run that goes on.");
  k->footer("Exit code: 0 done, 1 the run refuses, 3 it cannot be reached.");
  k->add_option("where", d.where, "The address that the run printed (http://…), or lcm:URL, lcm:URL#CHANNEL")
      ->required();
  k->add_option("command", d.command, "What to do")
      ->required()
      ->check(CLI::IsMember({"status", "preflight", "start", "pause", "go", "estop", "arm", "rearm", "move", "halt",
                             "release", "replace"}));
  k->add_option("robot", d.robot, "Which robot; default: all");
  auto* spare = k->add_option("--spare", d.spare, "Of replace: a <spare> of the file comes instead");
  k->add_option("--link", d.link, "Of replace: the robot on this link comes instead")->excludes(spare);
  k->add_option("--as", d.as, "… and is called so")->excludes(spare);
  k->add_option("--seen-as", d.seen_as, "… and trackers know it by this name or tag")->excludes(spare);
  k->add_option("--at", d.at, "… and stands at X,Y or X,Y,HEADING (m, rad), where wheels alone tell its place")
      ->delimiter(',')
      ->expected(2, 3);
  k->add_option("--who", d.who, "Who says it; default: user@machine");
  k->add_option("--keys", d.keys, "Over LCM: the file with the keys; default: this user's");
  k->add_flag("--json", d.json, "The run's answer as it is");
  k->callback([&] { code = desk(d); });
}

/// "--name value" and "--name=value", as the emulators' own options are written.
std::vector<std::pair<std::string, std::string>> own_options(const std::vector<std::string>& words) {
  std::vector<std::pair<std::string, std::string>> own;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.size() < 3 || !word.starts_with("--")) throw CLI::ExtrasError("emulate", {word});
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) {
      own.emplace_back(word.substr(2, equals - 2), word.substr(equals + 1));
    } else {
      if (i + 1 == words.size()) throw CLI::ArgumentMismatch(word + " needs a value");
      own.emplace_back(word.substr(2), words[++i]);
    }
    const std::string& name = own.back().first;
    if (std::ranges::count(own, name, &std::pair<std::string, std::string>::first) > 1)
      throw CLI::ArgumentMismatch("--" + name + " stands twice; several values go into one, separated by spaces");
  }
  return own;
}

}  // namespace

int main(int argc, char** argv) {
  tandem::app::catch_rearm();
  tandem::app::catch_crashes();
  CLI::App app{"Tandem: one controller drives simulated robots, real ones, and both together.", "tandem"};
  app.footer("The launcher at the top of the checkout has further commands: test, build and format.");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  app.failure_message(CLI::FailureMessage::help);
  int code = kDone;

  RunOptions run_options;
  add_run(app, run_options, code);
  RunOptions view_options;
  add_view(app, view_options, code);

  RunOptions replay_options;
  add_replay(app, replay_options, code);

  add_study_commands(app, code);
  add_gap_commands(app, code);
  CompareOptions compare_options;
  add_compare(app, compare_options, code);
  UpgradeOptions upgrade_options;
  CLI::App* upgrade_command = app.add_subcommand(
      "upgrade", "Rewrite an experiment file in this program's vocabulary; layout and comments stay.");
  upgrade_command->add_option("experiment", upgrade_options.experiment, "The experiment file (.xml)")->required();
  upgrade_command->add_flag("--dry-run", upgrade_options.dry_run, "Only say what would change");
  add_plugins(*upgrade_command, upgrade_options.plugins);
  upgrade_command->callback([&] { code = upgrade(upgrade_options); });

  PreflightOptions preflight_options;
  DeskOptions desk_options;
  add_desk(app, preflight_options, desk_options, code);
  ExportOptions export_options;
  add_export(app, export_options, code);
  DrawOptions picture_options, film_options;
  add_drawing(app, picture_options, film_options, code);
  PluginNewOptions new_options;
  PluginCheckOptions plugin_check_options;
  add_plugin_commands(app, new_options, plugin_check_options, code);

  ListOptions list_options;
  CLI::App* list_command =
      app.add_subcommand("list", "List what there is: controllers, hooks, devices, engines, robots, elements.");
  list_command->add_option("kind", list_options.kind, "Only this kind");
  list_command->add_option("--in", list_options.file, "Also what this file adds: its plug-ins, its kinds of robots");
  add_plugins(*list_command, list_options.plugins);
  list_command->callback([&] { code = list(list_options); });

  DescribeOptions describe_options;
  CLI::App* describe_command =
      app.add_subcommand("describe", "Print the manual of a controller, device, robot, hook or element.");
  describe_command->add_option("name", describe_options.name, "Its name")->required();
  describe_command->add_option("--in", describe_options.file,
                               "A file with plug-ins and kinds of robots that may be meant, too");
  describe_command->add_flag("--xml", describe_options.xml, "A kind of robot as a file that gives it");
  add_plugins(*describe_command, describe_options.plugins);
  describe_command->callback([&] { code = describe(describe_options); });

  RobotCommandOptions robot_command_options;
  add_robot_commands(app, robot_command_options, code);

  add_calibrate_commands(app, code);
  add_validate_command(app, validate, code);

  BenchOptions bench_options;
  add_bench(app, bench_options, code);

  EmulateOptions emulate_options;
  CLI::App* emulate_command = app.add_subcommand("emulate", "Behave as a robot's firmware on a link.");
  emulate_command->add_option("robot", emulate_options.robot, "Which; `tandem list emulators` names them")->required();
  emulate_command
      ->add_option("--link", emulate_options.link,
                   "Where; pty:NAME makes a pseudo-terminal of that name; `tandem describe NAME` tells an emulator's")
      ->required();
  emulate_command->add_option("--log", emulate_options.log, "File for one JSON object an event; default: none");
  emulate_command
      ->add_option("--fault", emulate_options.faults,
                   "A fault to show, e.g. silent@5s+2s, or silent@drive+5s+2s after the robot was first told to move; "
                   "repeatable")
      ->allow_extra_args(false);
  auto* arena = emulate_command->add_option(
      "--arena", emulate_options.arena,
      "Experiment file: one of its robots, driven by the emulator's puppet (`tandem describe NAME`), is the body");
  emulate_command->add_option("--body", emulate_options.body, "Which of its robots; default: the first that can be")
      ->needs(arena);
  add_plugins(*emulate_command, emulate_options.plugins);
  emulate_command->footer("Further options are the emulator's own: --firmware gctronic, --name eb0, …");
  emulate_command->allow_extras();
  emulate_command->callback([&] {
    emulate_options.own = own_options(emulate_command->remaining());
    code = emulate(emulate_options);
  });

  return parse_and_run(app, argc, argv, code);
}
