#include <CLI/CLI.hpp>
#include <memory>

#include "app/command/command_groups.hpp"
#include "app/command/robot_commands.hpp"
#include "app/command/study.hpp"

namespace tandem::app {
namespace {

void add_sweep(CLI::App& app, int& code) {
  const auto options = std::make_shared<SweepOptions>();
  SweepOptions& o = *options;
  CLI::App* c = app.add_subcommand("sweep", "Make all runs of a study, on all cores, into one table.");
  c->footer(
      "Exit code: 0 all runs are done, 1 bad input, 3 some have failed, now or before, 130 interrupted. What was made "
      "stays in the table, "
      "however the sweep ends.");
  c->add_option("study", o.study, "The study (.xml); `tandem describe study` tells what stands in it")->required();
  c->add_option("--table", o.table, "Table to write, instead of the study's");
  c->add_option("--jobs", o.jobs, "Runs side by side; default: as many as there are cores")->check(CLI::Range(1, 4096));
  auto* resume = c->add_flag("--resume", o.resume, "Make the runs that the table lacks");
  c->add_flag("--retry-failed", o.retry_failed, "… and those that failed, again")->needs(resume);
  c->add_flag("--accept-changes", o.accept_changes, "… although program or files have changed")->needs(resume);
  c->add_flag("--yes", o.yes, "Do not ask, however many runs there are");
  c->add_flag("--quiet", o.quiet, "No summary at the end");
  auto* slurm = c->add_flag("--slurm", o.slurm, "Have a cluster make the runs, by Slurm's sbatch, and wait for them");
  c->add_option("--batch", o.batch_runs, "Runs in one job of the cluster, at least; default: so that there are 64 jobs")
      ->needs(slurm)
      ->check(CLI::Range(1, 10'000'000));
  c->add_option("--sbatch", o.sbatch, "Options for sbatch, as one word: --sbatch='--partition=short --time=60'")
      ->needs(slurm);
  auto* folder = c->add_option("--batch-folder", o.batch_folder)->group("");  // what the jobs of a cluster call
  c->add_option("--batch-number", o.batch_number)->group("")->needs(folder)->check(CLI::NonNegativeNumber);
  add_plugins(*c, o.plugins);
  c->callback([options, &code] { code = options->batch_folder.empty() ? sweep(*options) : sweep_batch(*options); });
}

void add_plot(CLI::App& app, int& code) {
  const auto options = std::make_shared<PlotOptions>();
  PlotOptions& o = *options;
  CLI::App* c = app.add_subcommand("plot", "Draw what the table of a sweep holds, and say what differs.");
  c->add_option("table", o.table, "The table that `tandem sweep` wrote")->required();
  c->add_option("-o,--output", o.output, "Figure to write: FILE.svg, .pdf or .png (gnuplot-nox)");
  c->add_option("--measure", o.measures, "What to draw, a panel each; needed where there are several")->delimiter(',');
  c->add_option("--over", o.over,
                "Along x: time, a column, or another measure, for a way of each run and its end; default: time where "
                "there are samples, else a parameter");
  c->add_option("--by", o.by, "A line for each value of this column; default: of what varies besides");
  c->add_option("--panel", o.panel, "A panel for each value of this column");
  c->add_option("--where", o.where, "Only runs with this value: COLUMN=VALUE; repeatable")->allow_extra_args(false);
  c->add_option("--show", o.show,
                "median with quartiles, mean with its 95 % confidence interval, box, or runs: each by itself")
      ->capture_default_str()
      ->check(CLI::IsMember({"median", "mean", "box", "runs"}));
  c->add_option("--difference", o.difference,
                "In a panel below: what the other groups have more than GROUP, in pairs of runs with the same seed and "
                "settings")
      ->type_name("GROUP");
  c->add_option("--title", o.title, "Above the figure");
  c->add_option("--x-label", o.x_label, "Below it; default: the column's name and unit");
  c->add_option("--y-label", o.y_labels, "Beside it, of the first --measure; repeatable, for the others")
      ->allow_extra_args(false);
  c->add_flag("--log-x", o.log_x, "Logarithmic along x");
  c->add_flag("--from-zero", o.from_zero, "Values begin at 0");
  c->add_flag("--equal-axes", o.equal_axes, "A unit is as long along x as along y, as on a map");
  c->add_flag("--quiet", o.quiet, "Neither numbers nor tests");
  c->callback([options, &code] { code = plot(*options); });
}

}  // namespace

void add_study_commands(CLI::App& app, int& code) {
  add_sweep(app, code);
  add_plot(app, code);
}

}  // namespace tandem::app
