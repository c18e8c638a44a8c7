// `tandem plot`: draws what the table of a sweep holds, and tests for differences.
#include <algorithm>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/report.hpp"
#include "app/process/terminal.hpp"
#include "study/plot/chart.hpp"

namespace tandem::app {
namespace {

/// What is left empty is chosen from what the table has.
struct PlotOptions {
  std::string table;
  std::string output;  ///< .svg, .png or .pdf; empty: numbers and tests alone
  std::vector<std::string> measures;
  std::string over;                ///< "time", a column or a measure
  std::string by, panel;           ///< columns
  std::vector<std::string> where;  ///< "column=value"
  std::string show = "median";     ///< median, mean, box or runs
  std::string difference;          ///< the group that others are compared with, in pairs
  std::string title, x_label;
  std::vector<std::string> y_labels;  ///< of the measures, in their order
  bool log_x = false, from_zero = false, equal_axes = false;
  bool quiet = false;

  void describe(hal::CommandLine& line) {
    line.word("table", table, "The table that `tandem sweep` wrote").required().file();
    line.option("-o,--output", output, "Figure to write: FILE.svg, .pdf or .png (gnuplot-nox)").file();
    line.option("--measure", measures, "What to draw, a panel each; needed where there are several").separated();
    line.option("--over", over,
                "Along x: time, a column, or another measure, for a way of each run and its end; default: time where "
                "there are samples, else a parameter");
    line.option("--by", by, "A line for each value of this column; default: of what varies besides");
    line.option("--panel", panel, "A panel for each value of this column");
    line.option("--where", where, "Only runs with this value: COLUMN=VALUE; repeatable").repeatable();
    line.option("--show", show,
                "median with quartiles, mean with its 95 % confidence interval, box, or runs: each by itself")
        .show_default()
        .one_of({"median", "mean", "box", "runs"});
    line.option("--difference", difference,
                "In a panel below: what the other groups have more than GROUP, in pairs of runs with the same seed and "
                "settings")
        .written("GROUP");
    line.option("--title", title, "Above the figure");
    line.option("--x-label", x_label, "Below it; default: the column's name and unit");
    line.option("--y-label", y_labels, "Beside it, of the first --measure; repeatable, for the others").repeatable();
    line.flag("--log-x", log_x, "Logarithmic along x");
    line.flag("--from-zero", from_zero, "Values begin at 0");
    line.flag("--equal-axes", equal_axes, "A unit is as long along x as along y, as on a map");
    line.flag("--quiet", quiet, "Neither numbers nor tests");
  }
};

std::string listed_or_none(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "none" : all;
}

/// What the options leave open, from what the table has. Error: nothing can be chosen.
hal::Status complete(PlotOptions& o, const study::TableContents& there) {
  if (there.done == 0) return hal::Error{"'" + o.table + "': no run is done yet"};
  if (there.measures.empty()) return hal::Error{"'" + o.table + "': its runs have no measures; hooks publish them"};
  if (o.measures.empty()) {
    if (there.measures.size() > 1)
      return hal::Error{"--measure says what to draw; the table has: " + listed_or_none(there.measures)};
    o.measures = there.measures;
  }
  const auto varied = [&](const std::string& name) {
    return std::find(there.varied.begin(), there.varied.end(), name) != there.varied.end();
  };
  const auto free = [&](const std::string& name) {
    return name != o.over && name != o.by && name != o.panel &&
           std::none_of(o.where.begin(), o.where.end(),
                        [&](const std::string& where) { return where.starts_with(name + "="); });
  };
  if (o.over.empty()) {
    for (const std::string& name : there.varied) {
      if (name != "experiment" && free(name) && o.over.empty()) o.over = name;
    }
    if (there.samples) o.over = study::kOverTime;
    if (o.over.empty()) o.over = "experiment";
  }
  if (o.by.empty() && varied("experiment") && free("experiment")) o.by = "experiment";
  for (const std::string& name : there.varied) {
    if (o.by.empty() && free(name)) o.by = name;
  }
  for (const std::string& name : there.varied) {
    if (free(name))
      say(fmt::format("warning: runs with different '{}' are taken together; --by, --panel and --where part them",
                      name));
  }
  return {};
}

hal::Result<std::vector<std::pair<std::string, std::string>>> where_of(const std::vector<std::string>& words) {
  std::vector<std::pair<std::string, std::string>> where;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0) return hal::Error{"--where takes COLUMN=VALUE, not '" + word + "'"};
    where.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  }
  return where;
}

study::Show show_of(const std::string& word) {
  return word == "mean"   ? study::Show::Mean
         : word == "box"  ? study::Show::Box
         : word == "runs" ? study::Show::Runs
                          : study::Show::Median;
}

/// What the chart shows, but for its panels. Error: options that do not go together.
hal::Result<study::Chart> chart_of(const PlotOptions& o, const study::TableContents& there) {
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  study::Chart chart;
  chart.over_time = o.over == study::kOverTime;
  chart.over_measure = !chart.over_time && !has(there.columns, o.over) && has(there.measures, o.over);
  chart.show = chart.over_measure ? study::Show::Runs : show_of(o.show);
  chart.log_x = o.log_x;
  chart.from_zero = o.from_zero;
  chart.equal_axes = o.equal_axes;
  chart.title = o.title;
  chart.x_name = o.over;
  chart.x_label = o.x_label;
  chart.base = o.difference;
  if (chart.over_time && chart.show == study::Show::Box)
    return hal::Error{"boxes are drawn over a parameter, not over time; take --over, or --show median"};
  if (!chart.base.empty() && chart.over_measure)
    return hal::Error{"--difference compares runs at the same place of x: over time or over a column"};
  if (!chart.base.empty() && o.by.empty()) return hal::Error{"--difference needs groups: --by names their column"};
  if (o.y_labels.size() > o.measures.size())
    return hal::Error{fmt::format("there are {} --y-label for {}", o.y_labels.size(), o.measures.size())};
  return chart;
}

hal::Status add_measure(study::Chart& chart, const std::string& table, const study::Selection& selection,
                        const std::string& y_label) {
  if (chart.over_measure) {
    auto ways = study::select_ways(table, selection);
    if (!ways.ok()) return ways.error();
    study::add_panels(chart, *ways, selection, y_label);
    return {};
  }
  auto observations = study::select(table, selection);
  if (!observations.ok()) return observations.error();
  return study::add_panels(chart, *observations, selection, y_label);
}

int plot(const PlotOptions& given) {
  PlotOptions o = given;
  if (!o.output.empty()) {
    if (const auto format = core::figure_format(o.output); !format.ok())
      return complain(kBadInput, format.error().message);
    if (const hal::Status apart = check_apart({{"figure", o.output}}, {{"table", o.table}}); !apart.ok())
      return complain(kBadInput, apart.error().message);
    if (const hal::Status can = core::can_draw_figures(); !can.ok())
      return complain(kFailedRunning, can.error().message);
  }
  auto there = study::contents_of(o.table);
  if (!there.ok()) return complain(kBadInput, there.error().message);
  if (const hal::Status chosen = complete(o, *there); !chosen.ok()) return complain(kBadInput, chosen.error().message);
  auto where = where_of(o.where);
  if (!where.ok()) return complain(kBadInput, where.error().message);
  auto made = chart_of(o, *there);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  study::Chart& chart = *made;
  for (std::size_t i = 0; i < o.measures.size(); ++i) {
    const study::Selection selection{o.measures[i], o.over, o.by, o.panel, *where, !o.difference.empty()};
    const hal::Status added = add_measure(chart, o.table, selection, i < o.y_labels.size() ? o.y_labels[i] : "");
    if (!added.ok()) return complain(kBadInput, added.error().message);
  }
  study::place_labels(chart);
  if (there->failed > 0) say(fmt::format("warning: {} runs failed, and are left out", there->failed));
  if (!o.output.empty()) {
    auto file = hal::OutputFile::open(o.output, "figure");
    if (!file.ok()) return complain(kBadInput, file.error().message);
    const auto format = core::figure_format(o.output);
    const hal::Status drawn = core::draw_figure(study::chart_script(chart, format.value()), *file);
    if (!drawn.ok()) return complain(kFailedRunning, drawn.error().message);
  }
  if (o.quiet) return kDone;
  fmt::print("{}", study::chart_table(chart));
  for (const std::string& sentence : study::chart_differences(chart)) fmt::print("{}\n", sentence);
  return kDone;
}

}  // namespace

constinit const hal::CommandType plot_command = module_command<PlotOptions, plot>("plot");

}  // namespace tandem::app
