// A chart of observations: panels of groups of points, each with its values.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/view/gnuplot.hpp"
#include "study/plot/statistics.hpp"
#include "study/table/select.hpp"

namespace tandem::study {

enum class Show { Mean, Median, Box, Runs };

/// The values at one place of the x-axis, sorted.
struct ChartPoint {
  std::string label;  ///< as the table has it
  double x = 0.0;     ///< the number in the label, or the place among the labels
  std::vector<double> values;
};

/// One run by itself.
struct ChartWay {
  std::int64_t run = 0;
  std::vector<std::pair<double, double>> places;
};

struct ChartGroup {
  std::string name;  ///< empty: the only one
  std::vector<ChartPoint> points;
  std::vector<ChartWay> ways;  ///< with Show::Runs, where x is time or a measure
};

struct ChartPanel {
  std::string value;  ///< of the column that makes panels
  std::string title;
  std::string measure;
  std::string y_label;
  std::vector<ChartGroup> groups;
  /// How much more these groups have than the one they are compared with: values are differences in pairs of runs.
  std::vector<ChartGroup> differences;
};

struct Chart {
  Show show = Show::Median;
  bool over_time = false;
  bool over_measure = false;  ///< x is a measure too
  bool log_x = false;
  bool from_zero = false;   ///< the y-axis begins at 0
  bool equal_axes = false;  ///< a unit is as long along x as along y
  bool numbers = true;      ///< every label begins with a number: x is it; else x counts the labels
  std::string title;
  std::string x_name;   ///< the column
  std::string x_label;  ///< below the figure; empty: the name with its unit
  double x_unit = 1.0;  ///< of the figure's x-axis, in seconds where x is time
  std::string base;     ///< the group that others are compared with, in pairs; empty: none
  std::vector<ChartPanel> panels;
  std::vector<std::string> groups;  ///< names in all panels, numbers by their size
  std::vector<std::string> labels;  ///< of x in all panels, in their order
};

/// Adds the panels of one measure to a chart, called so on the y-axis. Errors: there is no group `base`, or no run of
/// it has a pair.
hal::Status add_panels(Chart& chart, const std::vector<Observation>& observations, const Selection& selection,
                       const std::string& y_label = "");
/// The same over a measure.
void add_panels(Chart& chart, const std::vector<Way>& ways, const Selection& selection,
                const std::string& y_label = "");
/// Whether x stands for labels, which are written at whole numbers, with groups side by side.
bool counts_places(const Chart& chart);
/// To be called after the last panel: places that are no numbers are counted, in all panels alike.
void place_labels(Chart& chart);

/// "panel, group, x, n, centre, low, high, least, most" as lines of a table; over time and over a measure of its end.
std::string chart_table(const Chart& chart);
/// One sentence for each two groups at each place, over time at its end; of pairs, for each group and `base`. Over a
/// measure, one for each group: whether both rise together.
std::vector<std::string> chart_differences(const Chart& chart);

/// The script that writes the chart to gnuplot's standard output.
std::string chart_script(const Chart& chart, core::FigureFormat format);

}  // namespace tandem::study
