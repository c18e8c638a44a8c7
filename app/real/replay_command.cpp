// `tandem replay`: a run with real robots, computed again out of its record.
#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/module/module_table.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {
namespace {

struct ReplayLine : PagedRunOptions {
  void describe(hal::CommandLine& line) {
    line.footer(
        "With --from the robots are simulated from that tick on, and it is told how far they go astray from the real "
        "ones. What --set and --controller change holds from that tick on too; without --from it holds from the "
        "start.");
    line.word("record", replay.record, "The record of `tandem run --record`; of one that was killed FILE.part")
        .required()
        .file();
    line.option("--from", replay.from,
                "What if: until this tick all is as recorded; from it on the robots are simulated, with what is "
                "changed")
        .not_negative();
    line.option("--until", replay.until, "So many ticks are done; default: all that are recorded").positive();
    line.option("--controller", replay.controllers,
                "Another controller: ROBOT=ID or KIND=ID, an id of the experiment's <controllers>; repeatable")
        .repeatable();
    line.flag("--accept-changes", replay.accept_changes, "Also with plug-ins and files that are not those of the run");
    describe_page(line, "Serve a page that shows it, on port --view=PORT or any that is free");
    describe_run(line, *this);
    for (const char* other : {"--seconds", "--steps", "--seed", "--repeat", "--without", "--anyway", "--hub-fault",
                              "--desk-keys", "--checkpoint", "--checkpoint-every"})
      line.leave_out(other);
  }
};

int replay_line(const ReplayLine& line) {
  RunOptions options = line.with_page();
  const ReplayRequest& asked = options.replay;
  if (asked.from && asked.until && *asked.until <= *asked.from)
    return complain(kWrongUsage, "--until is to lie behind --from: both are ticks");
  options.repeat = asked.record;
  return run(options);
}

}  // namespace

constinit const hal::CommandType replay_command = module_command<ReplayLine, replay_line>("replay");

}  // namespace tandem::app
