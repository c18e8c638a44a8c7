#include "bench/figure.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <tuple>

#include "bench/partition.hpp"

namespace tandem::bench {
namespace {

/// What may be varied, each value once, in the order that figures show.
struct Varied {
  std::vector<std::string> engines;     // as they came
  std::vector<std::string> partitions;  // by their number of parts
  std::vector<std::int64_t> threads;    // rising
};

template <class T>
std::size_t index_in(const std::vector<T>& all, const T& value) {
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), value) - all.begin());
}

template <class T>
void add_once(std::vector<T>& all, const T& value) {
  if (index_in(all, value) == all.size()) all.push_back(value);
}

Varied varied_in(const std::vector<ResultLine>& lines) {
  Varied v;
  std::map<std::string, std::int64_t> parts;
  for (const ResultLine& line : lines) {
    add_once(v.engines, line.engine);
    add_once(v.partitions, line.partition);
    add_once(v.threads, line.threads);
    parts[line.partition] = parts_of(line.regions);
  }
  std::sort(v.threads.begin(), v.threads.end());
  std::stable_sort(v.partitions.begin(), v.partitions.end(),
                   [&](const std::string& a, const std::string& b) { return parts[a] < parts[b]; });
  return v;
}

enum class CurvesOf { Threads, Partitions, Engines };

/// Chooses what curves stand for, and lays out panels for the rest: engines from top to bottom, partitions from left
/// to right; where only one of both is varied, in a square.
class Layout {
 public:
  explicit Layout(const std::vector<ResultLine>& lines) : v_(varied_in(lines)) {
    if (v_.threads.size() > 1)
      curves_ = CurvesOf::Threads;
    else if (v_.partitions.size() > 1)
      curves_ = CurvesOf::Partitions;
    else if (v_.engines.size() > 1)
      curves_ = CurvesOf::Engines;
    across_ = curves_ == CurvesOf::Partitions ? 1 : v_.partitions.size();
    const std::size_t down = curves_ == CurvesOf::Engines ? 1 : v_.engines.size();
    count_ = across_ * down;
    if (across_ == 1 || down == 1)
      columns_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count_))));
    else
      columns_ = across_;
  }

  void describe(Figure& figure) const {
    figure.columns = columns_;
    figure.lines = (count_ + columns_ - 1) / columns_;
    switch (curves_) {
      case CurvesOf::Threads:
        figure.legend = "threads";
        for (const std::int64_t threads : v_.threads) figure.labels.push_back("P = " + std::to_string(threads));
        break;
      case CurvesOf::Partitions:
        figure.legend = "partition";
        figure.labels = v_.partitions;
        break;
      case CurvesOf::Engines:
        figure.legend = "engine";
        figure.labels = v_.engines;
        break;
    }
  }

  std::size_t curve_of(const ResultLine& line) const {
    switch (curves_) {
      case CurvesOf::Threads:
        return index_in(v_.threads, line.threads);
      case CurvesOf::Partitions:
        return index_in(v_.partitions, line.partition);
      case CurvesOf::Engines:
        break;
    }
    return index_in(v_.engines, line.engine);
  }

  std::size_t panel_of(const ResultLine& line) const {
    const std::size_t x = curves_ == CurvesOf::Partitions ? 0 : index_in(v_.partitions, line.partition);
    const std::size_t y = curves_ == CurvesOf::Engines ? 0 : index_in(v_.engines, line.engine);
    return y * across_ + x;
  }

  FigurePanel panel(const ResultLine& line) const {
    FigurePanel p;
    const auto add = [&p](const std::string& part) { p.title += (p.title.empty() ? "" : ", ") + part; };
    if (curves_ != CurvesOf::Engines) add(line.engine);
    if (curves_ != CurvesOf::Partitions) add(line.partition == "auto" ? "automatic split" : line.partition);
    if (curves_ != CurvesOf::Threads) add("P = " + std::to_string(line.threads));
    p.column = panel_of(line) % columns_;
    p.line = panel_of(line) / columns_;
    return p;
  }

 private:
  Varied v_;
  CurvesOf curves_ = CurvesOf::Threads;
  std::size_t across_ = 1;
  std::size_t count_ = 1;
  std::size_t columns_ = 1;
};

/// The runs of one point.
struct Runs {
  std::vector<double> wall, speedup;
};

std::vector<std::string> notes_of(const std::vector<ResultLine>& lines, std::size_t fewest, std::size_t most) {
  const ResultLine& first = lines.front();
  std::string scene = first.bench + ", " + first.robot;
  if (first.density == "equal") scene += ", arena grows with N";
  if (first.assignment != "static") scene += ", " + first.assignment + " assignment";
  const std::string runs = fewest == most ? fmt::format("{}", most) : fmt::format("{} to {}", fewest, most);
  scene += most == 1 ? "; one run each" : "; medians of " + runs + " runs, bars: smallest to largest";
  return {scene, fmt::format("{}, {} {}", first.cpu_model, first.cores, first.cores == 1 ? "core" : "cores")};
}

}  // namespace

Figure figure_of(const std::vector<ResultLine>& lines) {
  const Layout layout(lines);
  Figure figure;
  layout.describe(figure);
  const double simulated_s = lines.front().virtual_s;
  const bool relative =
      std::any_of(lines.begin(), lines.end(), [&](const ResultLine& line) { return line.virtual_s != simulated_s; });
  figure.wall_axis = relative ? "wall time / simulated time" : "wall time [s]";
  figure.real_time = relative ? 1.0 : simulated_s;
  figure.real_time_mark = relative ? "real time" : fmt::format("real time, T = {} s", simulated_s);

  std::map<std::size_t, FigurePanel> panels;
  std::map<std::tuple<std::size_t, std::size_t, std::int64_t>, Runs> points;  // by panel, curve, robots
  for (const ResultLine& line : lines) {
    panels.emplace(layout.panel_of(line), layout.panel(line));
    Runs& runs = points[{layout.panel_of(line), layout.curve_of(line), line.robots}];
    runs.wall.push_back(relative ? line.wall_s / line.virtual_s : line.wall_s);
    runs.speedup.push_back(line.speedup());
  }
  std::size_t fewest = lines.size();
  std::size_t most = 1;
  for (const auto& [key, runs] : points) {
    const auto& [panel, curve, robots] = key;
    auto& curves = panels.at(panel).curves;
    if (curves.empty() || curves.back().label != curve) curves.push_back({curve, {}});
    curves.back().points.push_back({static_cast<double>(robots), spread_of(runs.wall), spread_of(runs.speedup)});
    fewest = std::min(fewest, runs.wall.size());
    most = std::max(most, runs.wall.size());
  }
  for (auto& [number, panel] : panels) figure.panels.push_back(std::move(panel));
  figure.notes = notes_of(lines, fewest, most);
  return figure;
}

}  // namespace tandem::bench
