#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "bench/gnuplot.hpp"

namespace tandem::bench {
namespace {

// In points of core::FigurePage.
constexpr double kPanelWidth = 560.0;
constexpr double kPanelHeight = 660.0;
constexpr double kLegendWidth = 170.0;
constexpr double kNoteHeight = 50.0;
constexpr double kLeft = 90.0, kRight = 20.0, kTop = 45.0, kBottom = 78.0;  // room around the diagrams of a panel
constexpr double kBetween = 22.0;
constexpr double kUpperShare = 0.62;
constexpr double kFontSize = 16.0;
constexpr std::size_t kFirstNote = 2;  // labels' numbers; 1 marks real time

struct Range {
  double low = 0.0, high = 0.0;
};

/// What all diagrams of a figure share.
struct Axes {
  Range robots, wall, speedup;
};

Axes axes_of(const Figure& figure) {
  Axes a{{INFINITY, 0.0}, {figure.real_time, figure.real_time}, {0.0, 1.0}};
  for (const FigurePanel& panel : figure.panels) {
    for (const FigureCurve& curve : panel.curves) {
      for (const FigurePoint& p : curve.points) {
        a.robots = {std::min(a.robots.low, p.robots), std::max(a.robots.high, p.robots)};
        a.wall = {std::min(a.wall.low, p.wall.smallest), std::max(a.wall.high, p.wall.largest)};
        a.speedup.high = std::max(a.speedup.high, p.speedup.largest);
      }
    }
  }
  const auto decades = [](double value, double up) {
    return std::pow(10.0, up > 0.0 ? std::ceil(std::log10(value) + 0.1) : std::floor(std::log10(value) - 0.1));
  };
  a.robots = {a.robots.low / 1.5, a.robots.high * 1.5};
  a.wall = {decades(a.wall.low, -1.0), decades(a.wall.high, 1.0)};
  a.speedup.high *= 1.15;
  return a;
}

class Script {
 public:
  explicit Script(const Figure& figure, core::FigureFormat format)
      : figure_(figure),
        axes_(axes_of(figure)),
        width_(static_cast<double>(figure.columns) * kPanelWidth + kLegendWidth),
        height_(static_cast<double>(figure.lines) * kPanelHeight + kNoteHeight) {
    begin(format);
    for (std::size_t i = 0; i < figure.panels.size(); ++i) add_panel(i);
    add("unset multiplot\n");
  }
  std::string text() const { return std::string(text_.begin(), text_.end()); }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }

  void begin(core::FigureFormat format) {
    add("{}", core::gnuplot_terminal(format, {width_, height_, "Arial", kFontSize}));
    add("set encoding utf8\nset border linewidth 0.8\nset tics scale 0.7\nset errorbars small\n");
    add("set grid xtics ytics linetype 1 linewidth 0.4 linecolor '#d0d0d0'\n");
    for (std::size_t i = 0; i < figure_.labels.size(); ++i) {
      const double above = static_cast<double>(std::min<std::size_t>(i, 5));  // thinner: those below shine through
      add("set style line {} linewidth {} pointsize {} linecolor '{}' pointtype {} linetype 1\n", i + 1,
          3.0 - 0.3 * above, 1.15 - 0.1 * above, core::figure_colour(i), core::figure_shape(i));
    }
    add("set logscale x\nset xrange [{}:{}]\n", axes_.robots.low, axes_.robots.high);
    const double note_size = 0.8 * kFontSize * (format == core::FigureFormat::Png ? core::kFontPoint : 1.0);
    for (std::size_t i = 0; i < figure_.notes.size(); ++i) {
      add("set label {} {} at screen {},{} left noenhanced font ',{}' textcolor '#606060'\n", kFirstNote + i,
          core::gnuplot_text(figure_.notes[i]), kLeft / width_,
          (kNoteHeight - 12.0 - 20.0 * static_cast<double>(i)) / height_, note_size);
    }
    add("set multiplot\n");
  }

  void add_panel(std::size_t number) {
    const FigurePanel& panel = figure_.panels[number];
    const double left = static_cast<double>(panel.column) * kPanelWidth + kLeft;
    const double right = left + kPanelWidth - kLeft - kRight;
    const double top = height_ - static_cast<double>(panel.line) * kPanelHeight - kTop;
    const double bottom = top - kPanelHeight + kTop + kBottom;
    const double upper = (top - bottom - kBetween) * kUpperShare;
    add_data(number);
    add("set lmargin at screen {}\nset rmargin at screen {}\n", left / width_, right / width_);

    add("set tmargin at screen {}\nset bmargin at screen {}\n", top / height_, (top - upper) / height_);
    add("set title {} noenhanced offset 0,-0.4\n", core::gnuplot_text(panel.title));
    add("set logscale y\nset yrange [{}:{}]\nset ytics auto format '10^{{%L}}'\n", axes_.wall.low, axes_.wall.high);
    add("set ylabel {} offset 0.5,0\nunset xlabel\nset format x ''\n", core::gnuplot_text(figure_.wall_axis));
    add("set arrow 1 from graph 0,first {0} to graph 1,first {0} nohead dashtype 2 linewidth 1.5 linecolor '#404040'\n",
        figure_.real_time);
    add("set label 1 {} at graph 0.02,first {} offset 0,-0.7 left noenhanced textcolor '#404040'\n",
        core::gnuplot_text(figure_.real_time_mark), figure_.real_time);
    if (number == 0)
      add("set key at screen {},{} left top Left reverse samplen 2 spacing 1.2 title {} noenhanced\n",
          (width_ - kLegendWidth + 5.0) / width_, (height_ - kTop) / height_, core::gnuplot_text(figure_.legend));
    plot(number, 2, number == 0);

    add("unset key\nunset arrow 1\nunset label\nunset title\n");
    add("set tmargin at screen {}\nset bmargin at screen {}\n", (top - upper - kBetween) / height_, bottom / height_);
    add("unset logscale y\nset yrange [0:{}]\nset ytics auto format '%g'\n", axes_.speedup.high);
    add("set ylabel 'speed-up (CPU / wall)' offset 0.5,0\nset xlabel 'number of robots N' offset 0,0.3\nset format x "
        "'10^{{%L}}'\n");
    plot(number, 5, false);
  }

  void add_data(std::size_t number) {
    for (const FigureCurve& curve : figure_.panels[number].curves) {
      add("$d{}_{} << END\n", number, curve.label);
      for (const FigurePoint& p : curve.points) {
        add("{} {} {} {} {} {} {}\n", p.robots, p.wall.median, p.wall.smallest, p.wall.largest, p.speedup.median,
            p.speedup.smallest, p.speedup.largest);
      }
      add("END\n");
    }
  }

  /// Every curve of a panel, its median in `column`, with bars below; `all` names in the legend also those that other
  /// panels have.
  void plot(std::size_t number, int column, bool all) {
    const char* separator = "plot";
    const auto next = [&] { add("{} ", std::exchange(separator, ", \\\n ")); };
    const auto& curves = figure_.panels[number].curves;
    for (const FigureCurve& curve : curves) {
      if (std::none_of(curve.points.begin(), curve.points.end(),
                       [](const FigurePoint& p) { return p.wall.smallest < p.wall.largest; }))
        continue;
      next();
      add("$d{}_{} using 1:{}:{}:{} with yerrorbars pointtype -1 linewidth 0.8 linecolor '{}' notitle", number,
          curve.label, column, column + 1, column + 2, core::figure_colour(curve.label));
    }
    for (std::size_t label = 0; label < figure_.labels.size(); ++label) {
      const bool drawn =
          std::any_of(curves.begin(), curves.end(), [&](const FigureCurve& c) { return c.label == label; });
      if (!drawn && !all) continue;
      next();
      if (drawn)
        add("$d{}_{} using 1:{}", number, label, column);
      else
        add("keyentry");
      add(" with linespoints linestyle {} title {}", label + 1, core::gnuplot_text(figure_.labels[label]));
    }
    add("\n");
  }

  const Figure& figure_;
  Axes axes_;
  double width_, height_;
  fmt::memory_buffer text_;
};

}  // namespace

std::string gnuplot_script(const Figure& figure, core::FigureFormat format) {
  return Script(figure, format).text();
}

}  // namespace tandem::bench
