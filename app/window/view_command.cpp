#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/module/module_table.hpp"
#include "app/process/signals.hpp"
#include "app/window/view_record.hpp"

namespace tandem::app {
namespace {

struct ViewLine : RunOptions {
  void describe(hal::CommandLine& line) {
    line.footer(
        "It begins in real time. All options but those of the window are those of `tandem run`; a record takes the "
        "window's and those of --watch alone.");
    line.word("experiment", experiment, "The experiment file (.xml), or a record of `tandem run --record`")
        .required()
        .file();
    line.option("--port", view.port, "Where the page is served; 0: any port that is free")
        .show_default()
        .range(0, 65535);
    line.flag("--no-browser", view.no_browser, "Only tell the address");
    describe_run(line, *this);
  }
};

int view(RunOptions options) {
  options.view.on = options.hold.stay = true;
  if (is_record(options.experiment)) return view_record(options, catch_signals());
  if (!options.hold.speed) options.hold.speed = 1.0;
  return run(options);
}

}  // namespace

constinit const hal::CommandType view_command = module_command<ViewLine, view>("view");

}  // namespace tandem::app
