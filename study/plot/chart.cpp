#include "study/plot/chart.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "hal/element.hpp"

namespace tandem::study {
namespace {

constexpr std::size_t kComparedGroups = 6;  // 15 sentences a place

/// "2.5 m" -> 2.5
std::optional<double> leading_number(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
  if (end != text.data() + text.size() && *end == ',') return std::nullopt;  // a vector
  return number;
}

template <class T, class Same>
T& of_name(std::vector<T>& all, Same&& same, const T& fresh) {
  const auto found = std::find_if(all.begin(), all.end(), same);
  return found != all.end() ? *found : all.emplace_back(fresh);
}

void note(std::vector<std::string>& all, const std::string& name) {
  if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
}

/// Numbers by their size, before words.
bool before(const std::string& a, const std::string& b) {
  const auto x = leading_number(a), y = leading_number(b);
  if (x && y && *x != *y) return *x < *y;
  if (x.has_value() != y.has_value()) return x.has_value();
  return a < b;
}

Summary summary_of(const Chart& chart, const ChartPoint& point) {
  return chart.show == Show::Mean ? mean_and_confidence(point.values) : median_and_quartiles(point.values);
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 0, ' ');
}

std::string short_number(double value) {
  char text[40];
  const int n = std::snprintf(text, sizeof text, "%.5g", value);
  return {text, static_cast<std::size_t>(n)};
}

std::string or_dash(const std::string& text) {
  return text.empty() ? "-" : text;
}

using TableRows = std::vector<std::vector<std::string>>;

std::string aligned(const TableRows& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += padded(row[i], widths[i] + 2);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

/// The group of an observation, in its panel; both are made where there are none.
ChartGroup& group_of(Chart& chart, std::size_t first, const Selection& selection, const std::string& panel_value,
                     const std::string& group) {
  const std::string title = selection.panel.empty() ? "" : selection.panel + " = " + panel_value;
  if (chart.panels.size() == first || chart.panels.back().title != title)
    chart.panels.push_back({panel_value, title, selection.measure, selection.measure, {}, {}});
  note(chart.groups, group);
  return of_name(
      chart.panels.back().groups, [&](const ChartGroup& g) { return g.name == group; }, ChartGroup{group, {}, {}});
}

/// Adds a value at the place of this name. Rows come in the order of x: a new place is the last.
void add_value(ChartGroup& group, const std::string& label, double value) {
  if (group.points.empty() || group.points.back().label != label) group.points.push_back({label, 0.0, {}});
  group.points.back().values.push_back(value);
}

/// What was read in the order of texts, in that of numbers.
void sort_panels(Chart& chart, std::size_t first) {
  const auto by_name = [](const ChartGroup& a, const ChartGroup& b) { return before(a.name, b.name); };
  const auto begin = chart.panels.begin() + static_cast<std::ptrdiff_t>(first);
  std::sort(begin, chart.panels.end(),
            [](const ChartPanel& a, const ChartPanel& b) { return before(a.value, b.value); });
  for (auto panel = begin; panel != chart.panels.end(); ++panel) {
    std::sort(panel->groups.begin(), panel->groups.end(), by_name);
    std::sort(panel->differences.begin(), panel->differences.end(), by_name);
  }
}

void sort_values(std::vector<ChartGroup>& groups) {
  for (ChartGroup& group : groups) {
    for (ChartPoint& point : group.points) std::sort(point.values.begin(), point.values.end());
  }
}

/// What the runs of other groups have more than those of the base that they are pairs with.
hal::Status add_differences(Chart& chart, std::size_t first, const std::vector<Observation>& observations,
                            const Selection& selection) {
  if (std::find(chart.groups.begin(), chart.groups.end(), chart.base) == chart.groups.end()) {
    return hal::Error{"--difference: there is no group '" + chart.base + "'; there are: " + hal::listed(chart.groups) +
                      hal::did_you_mean(chart.base, chart.groups)};
  }
  using Place = std::tuple<std::string_view, std::string_view, std::string_view>;
  std::map<Place, double> of_base;
  for (const Observation& o : observations) {
    if (o.group == chart.base) of_base[{o.panel, o.x, o.pair}] = o.value;
  }
  bool any = false;
  for (const Observation& o : observations) {
    const auto base = of_base.find({o.panel, o.x, o.pair});
    if (o.group == chart.base || base == of_base.end()) continue;
    any = true;
    const std::string title = selection.panel.empty() ? "" : selection.panel + " = " + o.panel;
    const auto panel = std::find_if(chart.panels.begin() + static_cast<std::ptrdiff_t>(first), chart.panels.end(),
                                    [&](const ChartPanel& p) { return p.title == title; });
    ChartGroup& group = of_name(
        panel->differences, [&](const ChartGroup& g) { return g.name == o.group; }, ChartGroup{o.group, {}, {}});
    add_value(group, o.x, o.value - base->second);
  }
  for (std::size_t i = first; i < chart.panels.size(); ++i) sort_values(chart.panels[i].differences);
  if (any) return {};
  return hal::Error{"--difference: no run of another group makes a pair with one of '" + chart.base +
                    "': a pair has the same seed and the same settings, but for " + selection.by};
}

/// "2 m" -> "m"
std::string unit_of(const std::string& label) {
  const std::size_t space = label.find(' ');
  return space == std::string::npos ? "" : label.substr(space + 1);
}

/// Name and unit of the x-axis but time's.
std::string label_of_x(const Chart& chart) {
  if (!chart.numbers || chart.labels.empty()) return chart.x_name;
  const std::string unit = unit_of(chart.labels.front());
  const bool same = std::all_of(chart.labels.begin(), chart.labels.end(),
                                [&](const std::string& label) { return unit_of(label) == unit; });
  return same && !unit.empty() && !counts_places(chart) ? chart.x_name + " (" + unit + ")" : chart.x_name;
}

/// "throughput, panel = 3, carry 2 m"
std::string place_in_words(const Chart& chart, const ChartPanel& panel, const std::string& label) {
  std::string where = panel.measure + (panel.title.empty() ? "" : ", " + panel.title);
  if (!label.empty()) where += ", " + chart.x_name + " " + label + (chart.over_time ? " s" : "");
  return where;
}

const ChartPoint* point_at(const ChartGroup& group, const std::string& label) {
  for (const ChartPoint& point : group.points) {
    if (point.label == label) return &point;
  }
  return nullptr;
}

}  // namespace

hal::Status add_panels(Chart& chart, const std::vector<Observation>& observations, const Selection& selection,
                       const std::string& y_label) {
  const std::size_t first = chart.panels.size();
  const bool ways = chart.show == Show::Runs && chart.over_time;
  for (const Observation& o : observations) {
    ChartGroup& group = group_of(chart, first, selection, o.panel, o.group);
    add_value(group, o.x, o.value);
    if (!ways) continue;
    auto way = std::lower_bound(group.ways.begin(), group.ways.end(), o.run,
                                [](const ChartWay& w, std::int64_t run) { return w.run < run; });
    if (way == group.ways.end() || way->run != o.run) way = group.ways.insert(way, ChartWay{o.run, {}});
    way->places.emplace_back(leading_number(o.x).value_or(0.0), o.value);
  }
  for (std::size_t i = first; i < chart.panels.size(); ++i) {
    sort_values(chart.panels[i].groups);
    if (!y_label.empty()) chart.panels[i].y_label = y_label;
  }
  hal::Status done = chart.base.empty() ? hal::Status{} : add_differences(chart, first, observations, selection);
  sort_panels(chart, first);
  return done;
}

void add_panels(Chart& chart, const std::vector<Way>& ways, const Selection& selection, const std::string& y_label) {
  const std::size_t first = chart.panels.size();
  for (const Way& way : ways) {
    ChartGroup& group = group_of(chart, first, selection, way.panel, way.group);
    group.ways.push_back({way.run, way.places});
    add_value(group, "", way.places.back().second);
  }
  for (std::size_t i = first; i < chart.panels.size(); ++i) {
    sort_values(chart.panels[i].groups);
    if (!y_label.empty()) chart.panels[i].y_label = y_label;
  }
  sort_panels(chart, first);
}

bool counts_places(const Chart& chart) {
  if (chart.over_time || chart.over_measure) return false;
  return !chart.numbers || chart.show == Show::Box || chart.show == Show::Runs;
}

void place_labels(Chart& chart) {
  std::sort(chart.groups.begin(), chart.groups.end(), before);
  if (chart.over_measure) {
    chart.labels = {""};
    if (chart.x_label.empty()) chart.x_label = chart.x_name;
    return;
  }
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartGroup& group : panel.groups) {
      for (const ChartPoint& point : group.points) chart.labels.push_back(point.label);
    }
  }
  std::sort(chart.labels.begin(), chart.labels.end(), before);
  chart.labels.erase(std::unique(chart.labels.begin(), chart.labels.end()), chart.labels.end());
  chart.numbers = std::all_of(chart.labels.begin(), chart.labels.end(),
                              [](const auto& l) { return leading_number(l).has_value(); });
  const auto place = [&](const std::string& label) {
    if (!counts_places(chart)) return *leading_number(label);
    return static_cast<double>(std::find(chart.labels.begin(), chart.labels.end(), label) - chart.labels.begin());
  };
  const auto place_all = [&](std::vector<ChartGroup>& groups) {
    for (ChartGroup& group : groups) {
      for (ChartPoint& point : group.points) point.x = place(point.label);
      std::sort(group.points.begin(), group.points.end(),
                [](const ChartPoint& a, const ChartPoint& b) { return a.x < b.x; });
    }
  };
  for (ChartPanel& panel : chart.panels) {
    place_all(panel.groups);
    place_all(panel.differences);
  }
  if (!chart.x_label.empty()) return;
  if (!chart.over_time) {
    chart.x_label = label_of_x(chart);
    return;
  }
  const double end_s = chart.labels.empty() ? 0.0 : leading_number(chart.labels.back()).value_or(0.0);
  const auto [unit, seconds] = end_s < 600.0        ? std::pair("s", 1.0)
                               : end_s < 4 * 3600.0 ? std::pair("min", 60.0)
                                                    : std::pair("h", 3600.0);
  chart.x_unit = seconds;
  chart.x_label = chart.x_name + " (" + unit + ")";
}

std::string chart_table(const Chart& chart) {
  const bool mean = chart.show == Show::Mean;
  const std::string x = chart.over_measure ? "x" : chart.over_time ? "time (s)" : or_dash(chart.x_name);
  const auto last = [&](const ChartGroup& group, const ChartPoint& point) {
    return !chart.over_time || &point == &group.points.back();  // thousands, maybe: the last one is shown
  };
  TableRows rows = {{"measure", "panel", "group", x, "n", mean ? "mean" : "median", mean ? "95 % from" : "quartile",
                     mean ? "to" : "quartile", "least", "most"}};
  TableRows pairs = {{"measure", "panel", "difference", x, "pairs", "shift", "95 % from", "to", "least", "most"}};
  for (const ChartPanel& panel : chart.panels) {
    const auto add = [&](TableRows& to, const std::string& group, const ChartPoint& point, const Summary& s) {
      to.push_back({panel.measure, or_dash(panel.title), or_dash(group), or_dash(point.label), std::to_string(s.n),
                    short_number(s.centre), short_number(s.low), short_number(s.high),
                    short_number(point.values.front()), short_number(point.values.back())});
    };
    for (const ChartGroup& group : panel.groups) {
      for (const ChartPoint& point : group.points) {
        if (last(group, point)) add(rows, group.name, point, summary_of(chart, point));
      }
    }
    for (const ChartGroup& group : panel.differences) {
      for (const ChartPoint& point : group.points) {
        if (last(group, point)) add(pairs, group.name + " - " + chart.base, point, shift_of_pairs(point.values));
      }
    }
  }
  return aligned(rows) + (pairs.size() > 1 ? "\n" + aligned(pairs) : "");
}

std::vector<std::string> chart_differences(const Chart& chart) {
  // What is read together is judged together: each sentence waits until the tests of the chart are known.
  std::vector<double> p;
  std::vector<std::function<std::string(const AmongTests&)>> sentences;
  const auto add = [&](const std::string& where, const auto& found, const std::string& one, const std::string& other) {
    p.push_back(found.p);
    sentences.emplace_back([=](const AmongTests& among) { return where + in_words(found, one, other, among); });
  };
  for (const ChartPanel& panel : chart.panels) {
    if (chart.over_measure) {
      for (const ChartGroup& group : panel.groups) {
        std::vector<double> x, y;
        for (const ChartWay& way : group.ways) {
          x.push_back(way.places.back().first);
          y.push_back(way.places.back().second);
        }
        const std::string title =
            (panel.title.empty() ? "" : panel.title + ", ") + (group.name.empty() ? "" : group.name);
        add(title.empty() ? "" : title + ": ", spearman(x, y), chart.x_name, panel.measure);
      }
      continue;
    }
    const std::size_t n = std::min(panel.groups.size(), kComparedGroups);
    for (const std::string& label : chart.labels) {
      if (chart.over_time && label != chart.labels.back()) continue;
      const std::string where = place_in_words(chart, panel, label);
      for (const ChartGroup& group : panel.differences) {
        if (const ChartPoint* point = point_at(group, label))
          add(where + ": ", signed_rank(point->values), group.name, chart.base);
      }
      for (std::size_t i = 0; i < n && chart.base.empty(); ++i) {
        for (std::size_t k = i + 1; k < n; ++k) {
          const ChartPoint *a = point_at(panel.groups[i], label), *b = point_at(panel.groups[k], label);
          if (a == nullptr || b == nullptr) continue;
          add(where + ": ", mann_whitney(a->values, b->values), panel.groups[i].name, panel.groups[k].name);
        }
      }
    }
  }
  std::vector<std::string> all;
  const std::vector<AmongTests> among = holm(p);
  for (std::size_t i = 0; i < sentences.size(); ++i) all.push_back(sentences[i](among[i]));
  return all;
}

}  // namespace tandem::study
