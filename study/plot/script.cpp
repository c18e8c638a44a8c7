// Charts as scripts for gnuplot.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hal/unit.hpp"
#include "study/plot/chart.hpp"

namespace tandem::study {
namespace {

// In points of core::FigurePage.
constexpr double kPanelWidth = 640.0, kPanelHeight = 430.0, kPairedHeight = 330.0;
constexpr double kTitleHeight = 34.0;
constexpr std::size_t kMarkedLabels = 12;
constexpr double kFontSize = 15.0;

std::string text_of(double value) {
  return hal::format_number(value);
}

class Script {
 public:
  Script(const Chart& chart, core::FigureFormat format) : chart_(chart) {
    columns_ = chart.panels.size() > 1 ? 2 : 1;
    rows_ = (chart.panels.size() + columns_ - 1) / columns_;
    const bool pairs = !chart.base.empty();
    const double panel_height = pairs ? kPairedHeight : kPanelHeight;
    const std::size_t lines = pairs ? 2 * rows_ : rows_;
    width_ = static_cast<double>(columns_) * kPanelWidth;
    height_ = static_cast<double>(lines) * panel_height + (chart.title.empty() ? 0.0 : kTitleHeight);
    begin(format, lines);
    for (std::size_t row = 0; row < rows_; ++row) {
      of_row(row, [&](std::size_t i) { panel(i); });
      if (pairs) of_row(row, [&](std::size_t i) { differences(i); });
    }
    text_ += "unset multiplot\n";
  }
  std::string take() { return std::move(text_); }

 private:
  template <class Draw>
  void of_row(std::size_t row, const Draw& draw) {
    for (std::size_t i = row * columns_; i < (row + 1) * columns_; ++i) {
      if (i < chart_.panels.size())
        draw(i);
      else
        text_ += "set multiplot next\n";
    }
  }

  void begin(core::FigureFormat format, std::size_t lines) {
    text_ += core::gnuplot_terminal(format, {width_, height_, "sans-serif", kFontSize});
    text_ += "set encoding utf8\nset grid linecolor '#dddddd'\nset border linewidth 0.8\nset errorbars small\n";
    text_ += "set key noenhanced tmargin center horizontal\n";
    if (chart_.log_x && !counted()) log_x();
    if (chart_.over_time) text_ += "set autoscale xfix\n";
    if (chart_.equal_axes) text_ += "set size ratio -1\n";
    if (!chart_.base.empty()) text_ += "set lmargin 11\n";
    text_ += "set multiplot layout " + std::to_string(lines) + "," + std::to_string(columns_);
    if (!chart_.title.empty()) text_ += " title " + core::gnuplot_text(chart_.title) + " noenhanced";
    text_ += "\n";
  }

  /// A few values have marks of their own, which powers of ten would seldom meet.
  void log_x() {
    text_ += "set logscale x\n";
    if (chart_.over_time || chart_.over_measure || chart_.labels.size() > kMarkedLabels) return;
    std::string marks;
    double least = HUGE_VAL, most = 0.0;
    for (const ChartPanel& p : chart_.panels) {
      for (const ChartGroup& group : p.groups) {
        for (const ChartPoint& point : group.points) {
          marks += (marks.empty() ? "" : ",") + text_of(point.x);
          least = std::min(least, point.x);
          most = std::max(most, point.x);
        }
      }
    }
    if (least > 0.0)
      text_ += "set xtics (" + marks + ")\nset xrange [" + text_of(least / 1.1) + ":" + text_of(most * 1.1) + "]\n";
  }

  bool counted() const { return counts_places(chart_); }
  double shift(std::size_t group) const {
    const auto n = static_cast<double>(chart_.groups.size());
    return counted() ? (static_cast<double>(group) - 0.5 * (n - 1.0)) * 0.8 / n : 0.0;
  }
  std::size_t number_of(const ChartGroup& group) const {
    return static_cast<std::size_t>(std::find(chart_.groups.begin(), chart_.groups.end(), group.name) -
                                    chart_.groups.begin());
  }

  void axes(const std::string& title, const std::string& y_label, const std::string& x_label, const char* y_range) {
    text_ += "set title " + core::gnuplot_text(title) + " noenhanced\n";
    text_ += "set ylabel " + core::gnuplot_text(y_label) + " noenhanced\nset xlabel " + core::gnuplot_text(x_label) +
             " noenhanced\nset yrange " + y_range + "\n";
    const bool beside = !counted() && !chart_.over_time && !chart_.log_x;
    if (!chart_.equal_axes)
      text_ += std::string("set offsets ") + (beside ? "graph 0.02,graph 0.02" : "0,0") + ",graph 0.02,0\n";
    if (!counted()) return;
    text_ +=
        "set xrange [-0.6:" + text_of(static_cast<double>(chart_.labels.size()) - 0.4) + "]\nset xtics noenhanced (";
    for (std::size_t i = 0; i < chart_.labels.size(); ++i)
      text_ += (i > 0 ? "," : "") + core::gnuplot_text(chart_.labels[i]) + " " + std::to_string(i);
    text_ += ")\n";
  }

  void panel(std::size_t index) {
    const ChartPanel& p = chart_.panels[index];
    axes(p.title, p.y_label, chart_.base.empty() ? chart_.x_label : "", chart_.from_zero ? "[0:*]" : "[*:*]");
    std::string plots;
    for (std::size_t g = 0; g < p.groups.size(); ++g) {
      const ChartGroup& group = p.groups[g];
      const std::string data = "$d" + std::to_string(index) + "_" + std::to_string(g);
      if (chart_.show == Show::Runs) runs(group, data, plots);
      if (chart_.show == Show::Box)
        boxes(group, data, group.name, plots);
      else if (chart_.show != Show::Runs)
        lines(group, data, group.name, plots, [&](const ChartPoint& point) { return middle(point); });
    }
    text_ += "plot " + plots + "\n";
  }

  /// Below the panel of the same number.
  void differences(std::size_t index) {
    const ChartPanel& p = chart_.panels[index];
    if (p.differences.empty()) {
      text_ += "set multiplot next\n";
      return;
    }
    axes("", "difference in pairs", chart_.x_label, "[*:*]");
    std::string plots;
    for (std::size_t g = 0; g < p.differences.size(); ++g) {
      const ChartGroup& group = p.differences[g];
      const std::string data = "$p" + std::to_string(index) + "_" + std::to_string(g);
      const std::string title = group.name + " − " + chart_.base;
      if (chart_.show == Show::Box)
        boxes(group, data, title, plots);
      else
        lines(group, data, title, plots, [](const ChartPoint& point) { return shift_of_pairs(point.values); });
    }
    add_plot(plots, "0 with lines linecolor '#000000' dashtype 2 notitle");
    text_ += "plot " + plots + "\n";
  }

  std::string x_text(double x) const { return text_of(x / chart_.x_unit); }

  Summary middle(const ChartPoint& point) const {
    return chart_.show == Show::Mean ? mean_and_confidence(point.values) : median_and_quartiles(point.values);
  }

  std::string colour_of(const ChartGroup& group, const char* transparency = "") const {
    const std::string colour = core::figure_colour(number_of(group));
    return " linecolor rgb '#" + (transparency + colour.substr(1)) + "'";
  }
  std::string shape_of(const ChartGroup& group) const {
    return " pointtype " + std::to_string(core::figure_shape(number_of(group))) + " pointsize 0.7";
  }
  static std::string title_of(const std::string& name) {
    return name.empty() ? " notitle" : " title " + core::gnuplot_text(name);
  }

  void add_plot(std::string& plots, const std::string& plot) { plots += (plots.empty() ? "" : ", \\\n ") + plot; }

  /// Where the point of a run stands beside the place of its group, so that equal values do not hide one another.
  double aside(std::size_t run) const {
    constexpr double kGolden = 0.6180339887;  // its multiples fill the width evenly, however many there are
    const double part = kGolden * static_cast<double>(run);
    return (part - std::floor(part) - 0.5) * 0.6 / static_cast<double>(std::max<std::size_t>(1, chart_.groups.size()));
  }

  /// Every run by itself: over time with the median of all, over a measure with their ends.
  void runs(const ChartGroup& group, const std::string& data, std::string& plots) {
    std::string places, marks;
    for (const ChartWay& way : group.ways) {
      for (const auto& [x, y] : way.places) places += x_text(x) + " " + text_of(y) + "\n";
      places += "\n";
      if (chart_.over_measure)
        marks += text_of(way.places.back().first) + " " + text_of(way.places.back().second) + "\n";
    }
    for (const ChartPoint& point : group.points) {
      if (chart_.over_time) marks += x_text(point.x) + " " + text_of(quantile(point.values, 0.5)) + "\n";
      if (chart_.over_time || chart_.over_measure) continue;
      for (std::size_t i = 0; i < point.values.size(); ++i)
        marks += text_of(point.x + shift(number_of(group)) + aside(i)) + " " + text_of(point.values[i]) + "\n";
    }
    if (!places.empty()) {
      text_ += data + "w << END\n" + places + "END\n";
      add_plot(plots, data + "w using 1:2 with lines" + colour_of(group, "B0") + " linewidth 1 notitle");
    }
    text_ += data + " << END\n" + marks + "END\n";
    add_plot(plots, data + " using 1:2 with " + (chart_.over_time ? "lines linewidth 2" : "points" + shape_of(group)) +
                        colour_of(group) + title_of(group.name));
  }

  template <class Summarise>
  void lines(const ChartGroup& group, const std::string& data, const std::string& name, std::string& plots,
             const Summarise& summarise) {
    const double aside = shift(number_of(group));
    text_ += data + " << END\n";
    for (const ChartPoint& point : group.points) {
      const Summary s = summarise(point);
      text_ += x_text(point.x + aside) + " " + text_of(s.centre) + " " + text_of(s.low) + " " + text_of(s.high) + "\n";
    }
    text_ += "END\n";
    if (chart_.over_time) {
      add_plot(plots, data + " using 1:3:4 with filledcurves" + colour_of(group) +
                          " fillstyle transparent solid 0.22 notitle");
      add_plot(plots, data + " using 1:2 with lines" + colour_of(group) + " linewidth 2" + title_of(name));
    } else {
      add_plot(plots, data + " using 1:2:3:4 with " + (counted() ? "yerrorbars" : "yerrorlines") + colour_of(group) +
                          " linewidth 2" + shape_of(group) + title_of(name));
    }
  }

  void boxes(const ChartGroup& group, const std::string& data, const std::string& name, std::string& plots) {
    const double aside = shift(number_of(group));
    std::string outliers;
    text_ += data + " << END\n";
    for (const ChartPoint& point : group.points) {
      const Box b = box_of(point.values);
      const std::string x = x_text(point.x + aside);
      text_ += x + " " + text_of(b.box.low) + " " + text_of(b.whisker_low) + " " + text_of(b.whisker_high) + " " +
               text_of(b.box.high) + " " + text_of(b.box.centre) + "\n";
      for (const double v : b.outliers) outliers += x + " " + text_of(v) + "\n";
    }
    text_ += "END\n";
    const std::string width = text_of(0.6 / static_cast<double>(std::max<std::size_t>(1, chart_.groups.size())));
    add_plot(plots, data + " using 1:2:3:4:5:(" + width + ") with candlesticks whiskerbars 0.5" + colour_of(group) +
                        " linewidth 1.5 fillstyle transparent solid 0.22" + title_of(name));
    add_plot(plots, data + " using ($1-" + width + "/2):6:(" + width + "):(0) with vectors nohead" + colour_of(group) +
                        " linewidth 3 notitle");
    if (outliers.empty()) return;
    text_ += data + "o << END\n" + outliers + "END\n";
    add_plot(plots, data + "o using 1:2 with points" + colour_of(group) + " pointtype 6 pointsize 0.5 notitle");
  }

  const Chart& chart_;
  std::size_t columns_ = 1, rows_ = 1;
  double width_ = 0.0, height_ = 0.0;
  std::string text_;
};

}  // namespace

std::string chart_script(const Chart& chart, core::FigureFormat format) {
  return Script(chart, format).take();
}

}  // namespace tandem::study
