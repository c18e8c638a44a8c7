// Engines against closed forms: a table a scene, a row a series, with the error at each value and the order.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "core/view/gnuplot.hpp"
#include "validate/parallel.hpp"
#include "validate/parts.hpp"
#include "validate/scene.hpp"
#include "validate/trial.hpp"

namespace tandem::validate {
namespace {

/// A series that was run.
struct Made {
  std::vector<double> errors;  ///< in the scene's unit; NaN: not made
  std::string failure;
  double expected = 0.0;

  /// Whether an error is none but of rounding.
  bool none(std::size_t i) const { return std::abs(errors[i]) <= 1e-9 * std::max(1.0, std::abs(expected)); }
  bool exact() const {
    for (std::size_t i = 0; i < errors.size(); ++i)
      if (!none(i)) return false;
    return true;
  }
};

/// Of the error as a power of the tick, by least squares over the logarithms; NaN where it does not fall with each
/// shorter tick.
double order_of(const Series& series, const Made& made) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < made.errors.size(); ++i) {
    const double error = std::abs(made.errors[i]);
    if (made.none(i) || !(i == 0 || error < std::abs(made.errors[i - 1]))) return NAN;
    const double x = -std::log(series.values[i]), y = std::log(error);
    n += 1.0, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double spread = n * sxx - sx * sx;
  return n < 3.0 || spread <= 0.0 ? NAN : (n * sxy - sx * sy) / spread;
}

Made make(const Scene& scene, const Series& series) {
  Scene changed = scene;
  for (const auto& [name, value] : series.figures) changed.given.set(name, value);
  changed.given.set("t", scene.seconds - (changed.given.has("since") ? changed.given("since") : 0.0));
  Made made;
  const auto expected = closed_form(changed.form, changed.given);
  if (!expected.ok()) {
    made.failure = expected.error().message;
    made.errors.assign(series.values.size(), NAN);
    return made;
  }
  const double unit = per_si(scene.unit);
  made.expected = unit * expected.value();
  for (const double value : series.values) {
    const auto measured = measure(changed, series, value);
    if (!measured.ok() && made.failure.empty()) made.failure = measured.error().message;
    made.errors.push_back(measured.ok() ? unit * measured.value() - made.expected : NAN);
  }
  return made;
}

std::string contract_of(const Series& s, const std::string& unit) {
  std::vector<std::string> all;
  if (s.worst) all.push_back(fmt::format("at most {:g} {} everywhere", *s.worst, unit));
  if (s.within) all.push_back(fmt::format("at most {:g} {} at {:g}", *s.within, unit, s.values.back()));
  if (s.order) all.push_back(fmt::format("order at least {:g}", *s.order));
  return fmt::format("{}", fmt::join(all, "; "));
}

Verdict judge(const Series& s, const Made& made, double order) {
  if (!made.failure.empty()) return Verdict::NotMade;
  if (!s.worst && !s.within && !s.order) return Verdict::Told;
  const auto within = [](double error, double most) { return std::abs(error) <= most; };  // false of NaN
  bool met = true;
  if (s.worst)
    met &= std::all_of(made.errors.begin(), made.errors.end(), [&](double e) { return within(e, *s.worst); });
  if (s.within) met &= within(made.errors.back(), *s.within);
  if (s.order) met &= order >= *s.order;
  return verdict_of(met);
}

std::string setting_of(const Series& s) {
  std::string text = s.engine;
  for (const auto& [name, value] : s.attributes) text += fmt::format(", {} {}", name, value);
  return text;
}

std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.size() > 160 ? line.substr(0, 160) + "…" : line;
}

Row row_of(const Scene& scene, const Series& s, const Made& made) {
  const double order = s.over == "ticks" ? order_of(s, made) : NAN;
  std::vector<std::string> errors;
  for (std::size_t i = 0; i < s.values.size(); ++i)
    errors.push_back(fmt::format("{:g}: {}", s.values[i],
                                 std::isnan(made.errors[i]) ? "–"
                                 : made.none(i)             ? "0"
                                                            : fmt::format("{:+.3g}", made.errors[i])));
  Row row;
  row.cells = {setting_of(s), s.over == "ticks" ? "Hz" : s.over, fmt::format("{:.4g} {}", made.expected, scene.unit),
               made.failure.empty() ? fmt::format("{}", fmt::join(errors, ", ")) : first_line(made.failure),
               std::isnan(order) ? "" : fmt::format("{:.2f}", order)};
  row.contract = contract_of(s, scene.unit);
  row.verdict = judge(s, made, order);
  return row;
}

/// Errors over the tick's length, all series of a scene that vary it and are not exact.
std::optional<Figure> figure_of(const Scene& scene, const std::vector<Made>& made) {
  std::string data, plot, exact;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (scene.series[i].over != "ticks" || !made[i].failure.empty()) continue;
    if (made[i].exact()) {
      exact += (exact.empty() ? "" : "; ") + setting_of(scene.series[i]);
      continue;
    }
    data += fmt::format("$s{} << END\n", i);
    for (std::size_t k = 0; k < made[i].errors.size(); ++k)
      if (!made[i].none(k))
        data += fmt::format("{} {}\n", 1.0 / scene.series[i].values[k], std::abs(made[i].errors[k]));
    data += "END\n";
    plot += fmt::format("{}$s{} using 1:2 with linespoints pointtype 7 title {}", plot.empty() ? "plot " : ", ", i,
                        core::gnuplot_text(setting_of(scene.series[i])));
  }
  if (plot.empty() || scene.form == "zero") return std::nullopt;
  return Figure{scene.name,
                fmt::format("{}: error over the length of a tick.{}", scene.title,
                            exact.empty() ? "" : " Without error, and so not drawn: " + exact + "."),
                data + fmt::format("set logscale xy\nset xlabel 'tick (s)'\nset ylabel {}\nset format y '%g'\n"
                                   "set key noenhanced\n{}\n",
                                   core::gnuplot_text("error (" + scene.unit + ")"), plot)};
}

}  // namespace

Part engine_part(Depth) {
  std::vector<Scene> scenes;
  Part part{
      "Engines against closed forms",
      "Each scene is run with each engine, over tick lengths or iterations. The error is what was measured less what "
      "the closed form says, 0 where it is one of rounding (1e-9); the order is that of the error as a power of the "
      "tick, where it falls with "
      "each shorter tick."};
  for (const hal::CarriedFile& file : scene_files()) {
    if (!file.name.starts_with("scenes/")) continue;
    auto scene = read_scene(file.name, std::string(file.text));
    if (scene.ok())
      scenes.push_back(std::move(scene).value());
    else
      part.tables.push_back({std::string(file.name), "", {"error"}, {{{scene.error().message}, "", Verdict::NotMade}}});
  }
  std::vector<std::pair<std::size_t, std::size_t>> work;  // scene, series
  std::vector<std::vector<Made>> made(scenes.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    made[i].resize(scenes[i].series.size());
    for (std::size_t k = 0; k < made[i].size(); ++k) work.emplace_back(i, k);
  }
  in_parallel(work.size(), [&](std::size_t n) {
    const auto [i, k] = work[n];
    made[i][k] = make(scenes[i], scenes[i].series[k]);
  });
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    Table table{
        scenes[i].title, "", {"engine", "over", "closed form", fmt::format("error ({})", scenes[i].unit), "order"}, {}};
    for (std::size_t k = 0; k < made[i].size(); ++k)
      table.rows.push_back(row_of(scenes[i], scenes[i].series[k], made[i][k]));
    part.tables.push_back(std::move(table));
    if (auto figure = figure_of(scenes[i], made[i])) part.figures.push_back(std::move(*figure));
  }
  return part;
}

}  // namespace tandem::validate
