#include "study/study.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <map>

#include "core/config/manual.hpp"
#include "hal/input_file.hpp"
#include "hal/xml/xml.hpp"
#include "study/schema.hpp"
#include "study/values.hpp"

namespace tandem::study {
namespace {

namespace fs = std::filesystem;
using core::Element;
using core::Reading;

/// Columns that every table has.
const std::vector<std::string> kColumns = {"run",     "experiment", "seed",      "state",       "ended",
                                           "failure", "ticks",      "virtual_s", "fingerprint", "version",
                                           "wall_s",  "cpu_s",      "measure",   "value",       "time"};

bool is_name(const std::string& text) {
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text.front())) != 0) return false;
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return (std::isalnum(c) != 0 && c < 0x80) || c == '_'; });
}

/// As SQLite compares names of columns.
std::string small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// "…params.carry" -> "carry"
std::string last_part(const std::string& path) {
  return path.substr(path.rfind('.') + 1);
}

/// A parameter and its attributes, before its values are known.
struct Read {
  schema::Parameter said;
  Parameter parameter;
};

Read read_parameter(Reading& reading, Element& e) {
  Read r;
  r.said = reading.read<schema::Parameter>(e);
  r.parameter.path = r.said.path;
  r.parameter.line = e.line;
  r.parameter.name = r.said.name.empty() ? last_part(r.said.path) : r.said.name;
  if (!r.said.path.empty() && !is_name(r.parameter.name)) {
    reading.error(e, "name",
                  "'" + r.parameter.name + "' cannot name a column; use letters, digits and _ in name=\"…\"");
  } else if (std::find(kColumns.begin(), kColumns.end(), small_letters(r.parameter.name)) != kColumns.end()) {
    reading.error(e, "name", "every table has a column '" + r.parameter.name + "'; choose another name=\"…\"");
  }
  return r;
}

hal::Result<Span> span_of(const schema::Parameter& p) {
  return study::span_of(p.from, p.to, p.scale == "log", p.whole);
}

/// The values of a parameter that has a list or a range of its own.
hal::Result<std::vector<std::string>> own_values(const schema::Parameter& p) {
  const bool range = !p.from.empty() || !p.to.empty() || !p.step.empty() || p.count != 0;
  if (p.values.empty() == !range)
    return hal::Error{"needs either a list, values=\"1, 2, 5\", or a range, from=\"0\" to=\"1\" with step or count"};
  if (!p.values.empty()) return list_of(p.values);
  if (p.from.empty() || p.to.empty() || p.step.empty() == (p.count == 0))
    return hal::Error{"a range needs 'from', 'to', and either 'step' or 'count'"};
  auto span = span_of(p);
  if (!span.ok()) return span.error();
  if (p.step.empty()) return spread(*span, p.count);
  return steps(*span, p.step);
}

void read_alone(Reading& reading, Element& e, Study& study) {
  Read r = read_parameter(reading, e);
  auto values = own_values(r.said);
  if (!values.ok()) return reading.error(e, "<parameter>: " + values.error().message);
  r.parameter.values = std::move(values).value();
  study.axes.push_back({{std::move(r.parameter)}});
}

void read_paired(Reading& reading, Element& e, Study& study) {
  reading.read<schema::Paired>(e);
  Axis axis;
  for (Element& child : e.children) {
    if (child.name != schema::Parameter::kElement.name) continue;
    Read r = read_parameter(reading, child);
    auto values = own_values(r.said);
    if (!values.ok()) {
      reading.error(child, "<parameter>: " + values.error().message);
      continue;
    }
    r.parameter.values = std::move(values).value();
    if (!axis.parameters.empty() && r.parameter.values.size() != axis.size()) {
      reading.error(child, "'" + r.parameter.name + "' has " + std::to_string(r.parameter.values.size()) +
                               " values, and '" + axis.parameters.front().name + "', with which it is paired, " +
                               std::to_string(axis.size()));
    }
    axis.parameters.push_back(std::move(r.parameter));
  }
  if (e.children.size() < 2) reading.error(e, "<paired> needs two <parameter> at least");
  study.axes.push_back(std::move(axis));
}

void read_latin_hypercube(Reading& reading, Element& e, Study& study) {
  const auto cube = reading.read<schema::LatinHypercube>(e);
  Axis axis;
  std::vector<Span> spans;
  for (Element& child : e.children) {
    if (child.name != schema::Parameter::kElement.name) continue;
    Read r = read_parameter(reading, child);
    if (r.said.from.empty() || r.said.to.empty() || !r.said.values.empty() || !r.said.step.empty() ||
        r.said.count != 0) {
      reading.error(child,
                    "<parameter> in <latin_hypercube> needs 'from' and 'to', and takes no values, step or count");
      continue;
    }
    auto span = span_of(r.said);
    if (!span.ok()) {
      reading.error(child, "<parameter>: " + span.error().message);
      continue;
    }
    spans.push_back(*span);
    axis.parameters.push_back(std::move(r.parameter));
  }
  if (e.children.empty()) reading.error(e, "<latin_hypercube> needs a <parameter>");
  if (cube.points < 1 || axis.parameters.empty()) return;
  auto values = latin_hypercube(spans, cube.points, static_cast<std::uint64_t>(cube.seed));
  for (std::size_t i = 0; i < values.size(); ++i) axis.parameters[i].values = std::move(values[i]);
  study.axes.push_back(std::move(axis));
}

void read_seeds(Reading& reading, Element& e, Study& study) {
  const bool first = e.attribute("first") != nullptr;
  const auto seeds = reading.read<schema::Seeds>(e);
  if (seeds.values.empty() == (seeds.count == 0) || (!seeds.values.empty() && first))
    return reading.error(e, "<seeds> needs either first and count, or values=\"1, 2, 3\"");
  study.seeds.clear();
  for (std::int64_t i = 0; i < seeds.count; ++i) study.seeds.push_back(static_cast<std::uint64_t>(seeds.first + i));
  if (seeds.values.empty()) return;
  auto values = list_of(seeds.values);
  if (!values.ok()) return reading.error(e, "values", values.error().message);
  for (const std::string& text : *values) {
    std::int64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error != std::errc() || end != text.data() + text.size() || seed < 1)
      return reading.error(e, "values", "'" + text + "' is no seed: a whole number from 1 on");
    study.seeds.push_back(static_cast<std::uint64_t>(seed));
  }
}

Over over_of(const std::string& word) {
  if (word == "sum") return Over::Sum;
  if (word == "min") return Over::Min;
  return word == "max" ? Over::Max : Over::Mean;
}

void read_measures(Reading& reading, Element& e, Study& study) {
  const auto measures = reading.read<schema::Measures>(e);
  study.sample_every_s = measures.every_s;
  if (auto names = list_of(measures.names); names.ok())
    study.measures = std::move(names).value();
  else
    reading.error(e, "names", names.error().message);
  for (Element& child : e.children) {
    if (child.name != schema::Measure::kElement.name) continue;
    const auto m = reading.read<schema::Measure>(child);
    study.published.push_back({m.name, m.published, over_of(m.over)});
  }
}

void read_experiment(Reading& reading, Element& e, Study& study) {
  const auto x = reading.read<schema::Experiment>(e);
  if (x.file.empty()) return;
  const std::string file = hal::path_beside(x.file, e.file);
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored))
    reading.error(e, "file", "there is no file '" + x.file + "', neither here nor beside the study");
  study.experiments.push_back({x.name.empty() ? fs::path(x.file).stem().string() : x.name, file, e.line});
}

/// Names and paths are there once.
void check_names(Reading& reading, const Element& root, const Study& study) {
  const auto once = [&](std::map<std::string, int>& lines, const std::string& word, int line, const std::string& what) {
    const auto [first, fresh] = lines.emplace(word, line);
    if (fresh) return;
    Element at = root;
    at.line = line;
    reading.error(at, "a second " + what + " '" + word + "'; the first is on line " + std::to_string(first->second) +
                          (what == "path" ? "" : "; name=\"…\" gives it another name"));
  };
  std::map<std::string, int> experiments, names, paths;
  for (const ExperimentChoice& x : study.experiments) once(experiments, x.name, x.line, "experiment");
  for (const Constant& c : study.constants) once(paths, c.path, c.line, "path");
  for (const Parameter* p : study.parameters()) {
    once(names, small_letters(p->name), p->line, "parameter");
    once(paths, p->path, p->line, "path");
  }
  std::map<std::string, int> measures;
  for (const PublishedMeasure& m : study.published) once(measures, m.name, root.line, "measure");
}

std::optional<Study> read_root(Element root, const std::string& text, const std::string& path,
                               core::Problems& problems) {
  const std::size_t before = problems.size();
  if (root.name != schema::Root::kElement.name) {
    problems.push_back(core::problem_at(root, "the root of a study is <study>, not <" + root.name + ">" +
                                                  (root.name == "tandem" || root.name == "argos-configuration"
                                                       ? "; an experiment is run by `tandem run`"
                                                       : "")));
    return std::nullopt;
  }
  const hal::Catalog nothing;
  Reading reading(nothing, problems);
  Study study;
  study.file = path;
  study.text = text;
  study.name = fs::path(path).stem().string();
  study.seeds = {1};
  study.measures = {"*"};
  const auto said = reading.read<schema::Root>(root);
  study.table = said.table.empty() ? study.name + ".sqlite" : said.table;
  study.isolate = said.isolate;
  study.time_limit_s = said.time_limit_s;
  study.step_limit_s = said.step_limit_s;
  for (Element& e : root.children) {
    if (e.name == schema::Experiment::kElement.name) read_experiment(reading, e, study);
    if (e.name == schema::Parameter::kElement.name) read_alone(reading, e, study);
    if (e.name == schema::Paired::kElement.name) read_paired(reading, e, study);
    if (e.name == schema::LatinHypercube::kElement.name) read_latin_hypercube(reading, e, study);
    if (e.name == schema::Set::kElement.name) {
      const auto set = reading.read<schema::Set>(e);
      study.constants.push_back({set.path, set.value, e.line});
    }
  }
  reading.once(root, schema::Seeds::kElement.name, [&](Element& e) { read_seeds(reading, e, study); });
  reading.once(root, schema::Measures::kElement.name, [&](Element& e) { read_measures(reading, e, study); });
  if (root.child(schema::Experiment::kElement.name) == nullptr)
    reading.error(root, "a study needs an <experiment file=\"…\"/> at least");
  check_names(reading, root, study);
  std::stable_sort(problems.begin() + static_cast<std::ptrdiff_t>(before), problems.end(),
                   [](const auto& a, const auto& b) { return a.line < b.line; });
  if (core::has_errors(problems, before)) return std::nullopt;
  return study;
}

}  // namespace

std::vector<const Parameter*> Study::parameters() const {
  std::vector<const Parameter*> all;
  for (const Axis& axis : axes) {
    for (const Parameter& p : axis.parameters) all.push_back(&p);
  }
  return all;
}

std::optional<Study> read_study(const std::string& path, core::Problems& problems) {
  auto root = hal::read_xml_file(path, problems);
  if (!root) return std::nullopt;
  const auto text = hal::read_whole_file(path, "");
  if (text.ok()) return read_root(std::move(*root), text.value(), path, problems);
  problems.push_back({path, 0, text.error().message, false});
  return std::nullopt;
}

std::optional<Study> read_study_text(const std::string& text, const std::string& path, core::Problems& problems) {
  auto root = hal::read_xml_text(text, path, problems);
  if (!root) return std::nullopt;
  return read_root(std::move(*root), text, path, problems);
}

std::vector<core::ElementManual> study_manuals() {
  using namespace schema;
  std::vector<core::ElementManual> all = {
      core::manual_of<Root>(),          core::manual_of<schema::Experiment>(), core::manual_of<schema::Parameter>(),
      core::manual_of<Paired>(),        core::manual_of<LatinHypercube>(),     core::manual_of<Set>(),
      core::manual_of<schema::Seeds>(), core::manual_of<schema::Measures>(),   core::manual_of<schema::Measure>()};
  for (core::ElementManual& m : all) {
    for (const core::ElementManual& other : all) {
      if (std::find(other.children.begin(), other.children.end(), m.name) != other.children.end())
        m.parent += (m.parent.empty() ? "" : " or ") + other.name;
    }
  }
  return all;
}

}  // namespace tandem::study
