#include "bench/figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <tuple>

#include "bench/partition.hpp"

namespace tandem::bench {
namespace {

/// What may be varied.
enum What : std::size_t { kEngines, kPartitions, kThreads };

std::string value_of(const ResultLine& line, What what) {
  return what == kEngines ? line.engine : what == kPartitions ? line.partition : fmt::format("P = {}", line.threads);
}

/// Chooses what curves stand for, and lays out panels for the rest: engines from top to bottom, partitions from left
/// to right; where only one of both is varied, in a square.
class Layout {
 public:
  explicit Layout(const std::vector<ResultLine>& lines) {
    for (const What what : {kEngines, kPartitions, kThreads}) {
      std::map<std::string, std::int64_t> rank;  // engines as they came
      for (const ResultLine& line : lines) {
        const std::string value = value_of(line, what);
        const std::int64_t place = what == kEngines ? 0 : what == kThreads ? line.threads : parts_of(line.regions);
        if (rank.emplace(value, place).second) values_[what].push_back(value);
      }
      std::stable_sort(values_[what].begin(), values_[what].end(),
                       [&](const std::string& a, const std::string& b) { return rank[a] < rank[b]; });
      if (values_[what].size() > 1) curves_ = what;
    }
    across_ = curves_ == kPartitions ? 1 : values_[kPartitions].size();
    const std::size_t down = curves_ == kEngines ? 1 : values_[kEngines].size();
    count_ = across_ * down;
    columns_ =
        across_ > 1 && down > 1 ? across_ : static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count_))));
  }

  void describe(Figure& figure) const {
    static constexpr std::array<const char*, 3> kLegends = {"engine", "partition", "threads"};
    figure.columns = columns_;
    figure.lines = (count_ + columns_ - 1) / columns_;
    figure.legend = kLegends[curves_];
    figure.labels = values_[curves_];
  }
  std::size_t curve_of(const ResultLine& line) const { return place_of(line, curves_); }
  std::size_t panel_of(const ResultLine& line) const {
    const std::size_t x = curves_ == kPartitions ? 0 : place_of(line, kPartitions);
    return (curves_ == kEngines ? 0 : place_of(line, kEngines)) * across_ + x;
  }
  FigurePanel panel(const ResultLine& line) const {
    FigurePanel p;
    for (const What what : {kEngines, kPartitions, kThreads}) {
      if (what == curves_) continue;
      const std::string value = value_of(line, what);
      p.title += (p.title.empty() ? "" : ", ") + (what == kPartitions && value == "auto" ? "automatic split" : value);
    }
    p.column = panel_of(line) % columns_;
    p.line = panel_of(line) / columns_;
    return p;
  }

 private:
  std::size_t place_of(const ResultLine& line, What what) const {
    const auto& all = values_[what];
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), value_of(line, what)) - all.begin());
  }

  std::array<std::vector<std::string>, 3> values_;  // each once, in the order that figures show
  What curves_ = kThreads;
  std::size_t across_ = 1, count_ = 1, columns_ = 1;
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
