#include <CLI/CLI.hpp>
#include <memory>

#include "app/command/command_groups.hpp"
#include "app/command/gap.hpp"
#include "app/command/robot_commands.hpp"

namespace tandem::app {
namespace {

void add_fit(CLI::App& app, int& code) {
  const auto options = std::make_shared<FitOptions>();
  FitOptions& o = *options;
  CLI::App* c = app.add_subcommand("fit", "Find the parameters of simulated robots in records of real ones.");
  c->footer("The file is for <fitted file=\"FILE\"/> in an experiment. Errors are those of 95 %.");
  c->add_option("record", o.records,
                "Records of runs with real robots; of simulated ones with <record ports=\"differential_steering\"/>")
      ->required();
  c->add_option("--robots", o.robots, "Only these, separated by commas; '*' stands for any text; default: real ones")
      ->delimiter(',');
  c->add_option("-o,--output", o.output, "Write what was found to this file");
  c->add_option("--report", o.report, "Write it as JSON to this file ('-': standard output)");
  add_plugins(*c, o.plugins);
  c->callback([options, &code] { code = fit(*options); });
}

void add_gap(CLI::App& app, int& code) {
  const auto options = std::make_shared<GapOptions>();
  GapOptions& o = *options;
  CLI::App* c = app.add_subcommand("gap", "Say how far a simulation is from what was recorded.");
  c->footer(
      "Without a second record the run of the first is made again, with its real robots simulated from where they "
      "began.");
  c->add_option("record", o.record, "The record of what really happened")->required();
  c->add_option("other", o.other, "Another record, to be compared with it instead of a simulation");
  c->add_option("--robots", o.robots, "Only these, separated by commas; '*' stands for any text; default: real ones")
      ->delimiter(',');
  c->add_option("--fitted", o.fitted, "Simulate with these fitted parameters (`tandem fit`)");
  c->add_option("--set", o.overrides, "Change the simulation: path=value; repeatable")->allow_extra_args(false);
  c->add_option("--seed", o.seed, "Of the simulation, instead of the record's");
  c->add_option("--report", o.report, "Write it as JSON to this file ('-': standard output)");
  add_plugins(*c, o.plugins);
  c->callback([options, &code] { code = gap(*options); });
}

}  // namespace

void add_gap_commands(CLI::App& app, int& code) {
  add_fit(app, code);
  add_gap(app, code);
}

}  // namespace tandem::app
