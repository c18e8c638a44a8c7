// Options of runs, and of pictures and films, as the command line has them.
#include "app/command/shared_options.hpp"

namespace tandem::app {
namespace {

void describe_pictures(hal::CommandLine& line, PictureRequest& o) {
  line.option("--picture", o.picture, "Draw the space from above at the end: FILE.svg, .png or .pdf").file();
  line.option("--picture-at", o.at, "… and after these numbers of ticks, as FILE-000100.svg: 0,100,200")
      .separated()
      .not_negative()
      .needs("--picture");
  describe_looks(line, o);
  line.option("--film", o.film,
              "Make a film: FILE.mp4, .mkv or .webp (ffmpeg), or pictures: FOLDER/ or FOLDER/%06d.png")
      .file();
  describe_film(line, "--film", o);
  line.option("--povray", o.povray,
              "Write the space at the end as a scene in perspective: FILE.pov, or FILE.png to render that, too")
      .file();
}

/// What is written of a run.
void describe_outputs(hal::CommandLine& line, RunOptions& o) {
  line.option("--trajectory", o.trajectory, "Write poses as CSV").file();
  line.option("--record", o.record, "Write a record: poses, state, and what <record> names; for `tandem export`")
      .file();
  line.option("--repeat", o.repeat,
              "Do what was done by hand in the run of this record (--record) again, at the same ticks, with its seed")
      .file();
  line.option(
          "--checkpoint", o.checkpoint,
          "Keep the state of the run in this file; whatever ended it, `tandem run --resume FILE` goes on from there")
      .file();
  line.option("--checkpoint-every", o.checkpoint_every_s, "… every so many seconds of simulated time")
      .show_default()
      .positive()
      .needs("--checkpoint");
  line.option("--log", o.log, "Write all messages of the run to this file: of controllers, too").file();
  line.option("--dump", o.dump, "Write every value of the state at the end as CSV, for `tandem compare`").file();
  line.option("--dump-every", o.dump_every, "… and after every so many ticks").positive().needs("--dump");
}

/// Who may look where, and how the run is held for those who do.
void describe_window(hal::CommandLine& line, RunOptions& o) {
  describe_viewers(line, o.view);
  line.flag("--projector", o.view.projector, "Tell the address of the page for a projector over the arena, too");
  line.flag("--paused,--hold", o.hold.paused,
            "Wait at the start until somebody lets the run go; real robots are connected, and stand");
  line.option("--speed", o.hold.speed, "At the start: times real time").range(0.001, 1e6);
  line.option("--view-memory", o.hold.memory_MB, "MB for checkpoints, by which one can go back")
      .show_default()
      .range(1, 1'000'000);
}

}  // namespace

void describe_looks(hal::CommandLine& line, PictureRequest& o) {
  line.option("--picture-size", o.size_px, "Pixels of the longer side of what is shown")
      .show_default()
      .range(64, 16'000);
  line.option("--picture-region", o.region, "Only this part of the arena: X0,Y0,X1,Y1 in metres")
      .separated()
      .count(4, 4);
  line.option("--picture-trails", o.trails_s, "Where robots were in so many seconds before").not_negative();
  line.flag("--picture-axes", o.axes, "Coordinates along the frame");
  line.flag("--picture-ids", o.ids, "The id beside every robot");
  line.flag("--picture-no-title", o.no_title, "Without the line above");
  line.flag("--picture-no-legend", o.no_legend, "Without scale and legend");
  line.option("--picture-layers", o.layers, "Layers over pictures and films: `tandem list layers`")
      .separated()
      .named_in("layer");
}

void describe_film(hal::CommandLine& line, std::string_view option, PictureRequest& o) {
  line.option("--film-every", o.film_every, "A frame every so many ticks").show_default().positive().needs(option);
  line.option("--film-rate", o.film_rate, "Frames a second; default: as fast as it was, 60 at most")
      .range(0.1, 240.0)
      .needs(option);
}

void describe_viewers(hal::CommandLine& line, ViewRequest& o) {
  line.option("--view-address", o.address,
              "Where the window listens; 0.0.0.0: on all networks of this machine, for all who know its token")
      .show_default();
  line.option("--view-origin", o.origins,
              "An address besides its own by which browsers reach the window, http://host:port, as through a proxy; "
              "repeatable")
      .repeatable();
}

void describe_watch(hal::CommandLine& line, WatchRequest& o, std::string_view text) {
  line.flag("--watch", o.watch, text);
  line.option("--watch-robots", o.robots, "Only these, separated by commas; '*' stands for any text")
      .separated()
      .needs("--watch");
  line.option("--watch-port", o.port, "The fields of this port, instead of what controllers publish").needs("--watch");
}

void describe_run(hal::CommandLine& line, RunOptions& o) {
  line.option("--seconds", o.seconds, "Virtual duration, instead of the file's").positive();
  line.option("--steps", o.steps, "Number of control steps, instead of the file's length")
      .positive()
      .excludes("--seconds");
  line.option("--seed", o.seed, "Seed of all chance, instead of the file's");
  line.option("--threads", o.threads, "Threads that step the world; results do not depend on it").range(0, 1024);
  describe_allow_io(line, o.allow_io);
  line.option("--set", o.overrides, "Change the experiment: path=value, e.g. framework.experiment.length=5; repeatable")
      .repeatable();
  line.option("--report", o.report, "Write a JSON report to this file ('-': standard output)").file();
  describe_pictures(line, o.pictures);
  describe_outputs(line, o);
  describe_step_timeout(line, o.step_timeout_s);
  describe_desk_keys(line, o.hold.desk_keys);
  line.flag("--anyway", o.anyway, "Drive real robots although their last first motion (preflight --move) failed");
  line.option("--step-limit", o.step_limit_s,
              "End the run, as a failure, when a controller or hook has not returned after so many seconds; 0: never")
      .range(0.0, 1e9)
      .show_default();
  line.option("--without", o.without, "Simulate this robot instead of driving the real one; repeatable").repeatable();
  line.flag("--quiet", o.quiet, "No table at the end");
  describe_watch(line, o.watch,
                 "A live table and map of the run on the terminal, in real time unless the file says else; keys pause "
                 "it and more");
  describe_hub_faults(line, o.hub_faults, "With real robots: a");
  describe_plugins(line, o.plugins);
  describe_window(line, o);
}

void PagedRunOptions::describe_page(hal::CommandLine& line, std::string_view text) {
  line.flag_or_number("--view", page_port, text);
  line.flag("--view-stay", hold.stay, "… until somebody ends the program");
}

RunOptions PagedRunOptions::with_page() const {
  RunOptions options = *this;
  if (page_port) {
    options.view.on = options.view.no_browser = true;
    options.view.port = *page_port;
  }
  return options;
}

}  // namespace tandem::app
