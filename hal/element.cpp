#include "hal/element.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>

#include "hal/markup.hpp"
#include "hal/open_params.hpp"
#include "hal/printable.hpp"

namespace tandem::hal {
namespace {

constexpr double kFarthest = 1e6;  // SI, of each number of a vector: beyond it a step of physics is lost in rounding

/// Levenshtein's distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
    }
  }
  return row[b.size()];
}

std::string range_text(Range range, const Unit& unit) {
  const bool low = range.min > -std::numeric_limits<double>::infinity();
  const bool high = range.max < std::numeric_limits<double>::infinity();
  if (low && high) return "from " + format_quantity(range.min, unit) + " to " + format_quantity(range.max, unit);
  if (low) return "at least " + format_quantity(range.min, unit);
  return "at most " + format_quantity(range.max, unit);
}

const Element::Attribute* find_attribute(const Element& element, std::string_view name) {
  for (const Element::Attribute& a : element.attributes) {
    if (a.name == name) return &a;
  }
  return nullptr;
}

Problem problem_of(const Element& element, const Element::Attribute* attribute, std::string message) {
  if (attribute != nullptr && !attribute->origin.empty()) return {attribute->origin, 0, std::move(message)};
  const int line = attribute != nullptr && attribute->line > 0 ? attribute->line : element.line;
  return {element.file, line, std::move(message)};
}

/// Of what nothing reads. What was set beside the file, which has no line, is meant to be read.
Problem unread(const Element& element, Problem problem) {
  problem.ignored = problem.warning = element.argos && problem.line > 0;
  return problem;
}

}  // namespace

std::string to_text(const Problem& problem) {
  std::string text = problem.file;
  if (problem.line > 0) text += ":" + std::to_string(problem.line);
  return text + (problem.warning ? ": warning: " : ": error: ") + shortened(problem.message);
}

bool has_errors(const Problems& problems, std::size_t first) noexcept {
  return std::any_of(problems.begin() + static_cast<std::ptrdiff_t>(std::min(first, problems.size())), problems.end(),
                     [](const Problem& p) { return !p.warning; });
}

void count_ignored(Problems& problems) {
  for (std::size_t i = 0; i < problems.size(); ++i) {
    if (!problems[i].ignored) continue;
    const auto same = [&](const Problem& p) { return p.ignored && p.message == problems[i].message; };
    const auto more = std::remove_if(problems.begin() + static_cast<std::ptrdiff_t>(i) + 1, problems.end(), same);
    const auto count = std::distance(more, problems.end());
    problems.erase(more, problems.end());
    if (count > 0) problems[i].message += " (and " + std::to_string(count) + " more such)";
  }
}

void refuse_ignored(Problems& problems) {
  for (Problem& problem : problems) problem.warning = problem.warning && !problem.ignored;
}

const std::string* Element::attribute(std::string_view attribute_name) const noexcept {
  for (const Attribute& a : attributes) {
    if (a.name == attribute_name) return &a.value;
  }
  return nullptr;
}

const Element* Element::child(std::string_view child_name) const noexcept {
  for (const Element& c : children) {
    if (c.name == child_name) return &c;
  }
  return nullptr;
}

Problem problem_at(const Element& element, std::string message) {
  return {element.file, element.line, std::move(message)};
}

Problem unread_at(const Element& element, std::string message) {
  return unread(element, problem_at(element, std::move(message)));
}

Problem unread_at(const Element& element, std::string_view attribute, std::string message) {
  return unread(element, problem_at(element, attribute, std::move(message)));
}

Problem problem_at(const Element& element, std::string_view attribute, std::string message) {
  return problem_of(element, find_attribute(element, attribute),
                    "<" + element.name + " " + std::string(attribute) + ">: " + std::move(message));
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 20;
  if (names.empty()) return "none";
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > kShown ? text + ", …" : text;
}

std::string cannot_hold(const Element& parent, const Element& child, const std::vector<std::string>& allowed) {
  return "<" + parent.name + "> cannot hold <" + child.name + ">; it may hold: " + listed(allowed) +
         did_you_mean(child.name, allowed);
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string near = closest(word, candidates);
  return near.empty() ? "" : ". Did you mean '" + near + "'?";
}

namespace {

/// "random_seed" for "seed": the only candidate that has the word between underscores; empty: none, or several.
std::string with_part(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string part = "_" + std::string(word) + "_";
  std::string found;
  for (const std::string& candidate : candidates) {
    if (("_" + candidate + "_").find(part) == std::string::npos) continue;
    if (!found.empty()) return {};
    found = candidate;
  }
  return found;
}

}  // namespace

std::string closest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() > 64) return {};
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > word.size() + 8) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best.empty() ? with_part(word, candidates) : best;
}

std::string path_beside(const std::string& path, const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (path.empty() || fs::path(path).is_absolute() || fs::exists(path, ignored)) return path;
  return (fs::path(file).parent_path() / path).string();
}

namespace {

void write_xml(const Element& element, std::string& xml) {
  xml += "<" + element.name;
  for (const Element::Attribute& a : element.attributes) xml += " " + a.name + "=\"" + escaped_markup(a.value) + "\"";
  xml += ">" + escaped_markup(element.text);
  for (const Element& child : element.children) write_xml(child, xml);
  xml += "</" + element.name + ">";
}

}  // namespace

ElementReader::ElementReader(const Element& element, Problems& problems, std::vector<std::string> ignore,
                             std::vector<std::string> ignore_children)
    : element_(element), problems_(problems), known_(std::move(ignore)), known_children_(std::move(ignore_children)) {}

void ElementReader::problem(std::string_view attribute, std::string message) {
  problems_.push_back(problem_at(element_, attribute, std::move(message)));
}

bool ElementReader::in_range(std::string_view name, const std::string& text, double value, Range range,
                             const Unit& unit) {
  constexpr double kSlack = 1e-12;  // 12.9 cm passes where 0.129 m is the limit
  if (value >= range.min - kSlack * std::fabs(range.min) && value <= range.max + kSlack * std::fabs(range.max))
    return true;
  problem(name, "'" + text + "' is out of range; it may be " + range_text(range, unit));
  return false;
}

void ElementReader::visit(const Param& param) {
  if (const Param::Group* const group = param.group(); group != nullptr) return read_group(param.name, *group);
  if (ParamList* const list = param.list(); list != nullptr) return read_list(param.name, *list);
  auto* const words = param.as<std::string>();
  if (words != nullptr && param.name == kPathParam) {
    *words = path_beside(*words, element_.file);
    return;
  }
  if (words != nullptr && param.name == kOtherParams) return take_others(*words);
  if (words != nullptr && param.name == kWholeElement) {
    write_xml(element_, *words);
    for (const Element::Attribute& a : element_.attributes) known_.push_back(a.name);
    for (const Element& child : element_.children) known_children_.push_back(child.name);
    return;
  }
  if (param.name == kArgosParam) {
    *param.as<bool>() = element_.argos;
    return;
  }
  known_.emplace_back(param.name);
  const std::string* const text = element_.attribute(param.name);
  if (text == nullptr) return;
  if (words != nullptr)
    *words = *text;
  else if (const auto* const choice = std::get_if<Param::Choice>(&param.value); choice != nullptr)
    read(param, *text, *choice);
  else if (auto* const number = param.as<double>(); number != nullptr)
    read(param, *text, *number);
  else if (auto* const whole = param.as<std::int64_t>(); whole != nullptr)
    read(param, *text, *whole);
  else if (auto* const flag = param.as<bool>(); flag != nullptr)
    read(param, *text, *flag);
  else if (auto* const triple = param.as<std::array<double, 3>>(); triple != nullptr)
    read(param, *text, *triple);
  else if (auto* const interval = param.as<Interval>(); interval != nullptr)
    read(param, *text, *interval);
}

void ElementReader::read(const Param& param, const std::string& text, double& value) {
  const auto parsed = parse_quantity(text, *param.bare);
  if (!parsed.ok()) return problem(param.name, parsed.error().message);
  if (in_range(param.name, text, parsed.value(), param.range, *param.bare))
    value = std::clamp(parsed.value(), param.range.min, param.range.max);
}

void ElementReader::read(const Param& param, const std::string& text, std::int64_t& value) {
  std::string_view digits = trimmed(text);
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  std::int64_t parsed = 0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), parsed);
  if (status == std::errc::result_out_of_range) return problem(param.name, "'" + text + "' is too large a number");
  if (status != std::errc{} || end != digits.data() + digits.size())
    return problem(param.name, "'" + text + "' is not a whole number");
  if (in_range(param.name, text, static_cast<double>(parsed), param.range, unit::none)) value = parsed;
}

void ElementReader::read(const Param& param, const std::string& text, bool& value) {
  const std::string_view word = trimmed(text);
  if (word == "true" || word == "1")
    value = true;
  else if (word == "false" || word == "0")
    value = false;
  else
    problem(param.name, "'" + text + "' is neither \"true\" nor \"false\"");
}

/// All attributes that nothing has asked for so far.
void ElementReader::take_others(std::string& value) {
  for (const Element::Attribute& a : element_.attributes) {
    if (std::find(known_.begin(), known_.end(), a.name) != known_.end()) continue;
    std::string in_a_line = a.value;
    std::replace(in_a_line.begin(), in_a_line.end(), '\n', ' ');
    value += a.name + "\n" + in_a_line + "\n";
    known_.push_back(a.name);
  }
}

void ElementReader::read(const Param& param, const std::string& text, const Param::Choice& choice) {
  const std::vector<std::string> names(choice.options.begin(), choice.options.end());
  const std::string word(trimmed(text));
  if (std::find(names.begin(), names.end(), word) == names.end())
    return problem(param.name, "'" + text + "' is not one of: " + listed(names) + did_you_mean(word, names));
  *choice.value = word;
}

void ElementReader::read(const Param& param, const std::string& text, std::array<double, 3>& value) {
  std::array<double, 3> parsed{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i == 2))
      return problem(param.name, "'" + text + "' must be three numbers, \"x,y,z\"");
    const auto part = parse_quantity(rest.substr(0, comma), *param.bare);
    if (!part.ok()) return problem(param.name, part.error().message);
    if (std::fabs(part.value()) > kFarthest)
      return problem(param.name, "'" + text + "': every number must be within " +
                                     (param.bare->dim == Dim::Length ? "1000 km" : "a million") + " of 0");
    parsed[i] = part.value();
    if (i < 2) rest.remove_prefix(comma + 1);
  }
  value = parsed;
}

void ElementReader::read(const Param& param, const std::string& text, Interval& value) {
  const std::size_t colon = text.find(':');
  const auto first = parse_quantity(std::string_view(text).substr(0, colon), *param.bare);
  if (!first.ok()) return problem(param.name, first.error().message);
  const double least = colon == std::string::npos ? -first.value() : first.value();
  double most = first.value();
  if (colon != std::string::npos) {
    const auto second = parse_quantity(std::string_view(text).substr(colon + 1), *param.bare);
    if (!second.ok()) return problem(param.name, second.error().message);
    most = second.value();
  }
  if (least > most)
    return problem(param.name, "'" + text +
                                   "' is no range: write its least value first, \"-0.1:0.2\", or one number "
                                   "that is not negative, \"0.1\", for -0.1:0.1");
  if (in_range(param.name, text, least, param.range, *param.bare) &&
      in_range(param.name, text, most, param.range, *param.bare))
    value = {least, most};
}

void ElementReader::read_group(std::string_view name, const Param::Group& group) {
  known_children_.emplace_back(name);
  const Element* first = nullptr;
  for (const Element& child : element_.children) {
    if (child.name != name) continue;
    if (first != nullptr) {
      problems_.push_back(
          unread_at(child, "a second <" + child.name + ">; the first is on line " + std::to_string(first->line)));
      continue;
    }
    first = &child;
    ElementReader reader(child, problems_);
    group.describe(group.value, reader);
    reader.finish();
  }
}

void ElementReader::read_list(std::string_view name, ParamList& list) {
  known_children_.emplace_back(name);
  bool any = false;
  for (const Element& child : element_.children) {
    if (child.name != name) continue;
    if (!std::exchange(any, true)) list.clear();
    ElementReader reader(child, problems_);
    list.add(reader);
    reader.finish();
  }
}

void ElementReader::finish() {
  finish_attributes();
  for (const Element& child : element_.children) {
    if (std::find(known_children_.begin(), known_children_.end(), child.name) != known_children_.end()) continue;
    problems_.push_back(unread_at(child, cannot_hold(element_, child, known_children_)));
  }
}

void ElementReader::finish_attributes() {
  for (const Element::Attribute& a : element_.attributes) {
    if (std::find(known_.begin(), known_.end(), a.name) != known_.end()) continue;
    problems_.push_back(unread(element_, problem_of(element_, &a,
                                                    "<" + element_.name + "> has no attribute '" + a.name + "'" +
                                                        did_you_mean(a.name, known_))));
  }
}

namespace {

/// A value as text: numbers by `number`, flags by their two words, parts of a vector with `between`.
template <class Number>
std::string value_text(const Param& p, const Number& number, const char* yes, const char* no, const char* between) {
  if (const auto* const v = p.as<double>(); v != nullptr) return number(*v);
  if (const auto* const v = p.as<std::int64_t>(); v != nullptr) return std::to_string(*v);
  if (const auto* const v = p.as<bool>(); v != nullptr) return *v ? yes : no;
  if (const auto* const v = p.as<std::array<double, 3>>(); v != nullptr)
    return number((*v)[0]) + between + number((*v)[1]) + between + number((*v)[2]);
  if (const auto* const v = p.as<Interval>(); v != nullptr)
    return v->least == -v->most ? number(v->most) : number(v->least) + ":" + number(v->most);
  return *p.text();
}

}  // namespace

void ElementWriter::visit(const Param& param) {
  if (const Param::Group* const group = param.group(); group != nullptr) {
    const auto found = std::find_if(element_.children.begin(), element_.children.end(),
                                    [&](const Element& child) { return child.name == param.name; });
    ElementWriter writer(found != element_.children.end() ? *found : add_child(param.name));
    return group->describe(group->value, writer);
  }
  if (ParamList* const list = param.list(); list != nullptr) {
    bool any = false;
    for (Element& child : element_.children) {
      if (child.name != param.name) continue;
      any = true;
      ElementWriter writer(child);
      list->describe_default(writer);
    }
    for (std::size_t i = 0; !any && i < list->size(); ++i) {
      ElementWriter writer(add_child(param.name));
      list->describe(i, writer);
    }
    return;
  }
  if (param.name == kArgosParam) *param.as<bool>() = element_.argos;
  if (is_no_attribute(param.name)) return;  // written already
  if (element_.attribute(param.name) != nullptr) return;
  const auto exactly = [&](double v) { return format_exactly(v, *param.bare); };
  element_.attributes.push_back({std::string(param.name), value_text(param, exactly, "true", "false", ","), 0});
}

Element& ElementWriter::add_child(std::string_view name) {
  Element& child = element_.children.emplace_back();
  child.name = name;
  child.file = element_.file;
  child.line = element_.line;
  child.argos = element_.argos;
  return child;
}

namespace {

/// What a value may be, for people.
std::string range_of(const Param& p) {
  if (p.as<bool>() != nullptr) return "true or false";
  if (const auto* const choice = std::get_if<Param::Choice>(&p.value); choice != nullptr) {
    std::string list;
    for (const std::string_view option : choice->options) list += (list.empty() ? "" : ", ") + std::string(option);
    return list;
  }
  const std::string symbol(p.bare->symbol);
  if (p.as<std::array<double, 3>>() != nullptr) return "three numbers" + (symbol.empty() ? "" : " in " + symbol);
  if (p.as<Interval>() != nullptr)
    return "LEAST:MOST, or one number for -x:x" + (symbol.empty() ? "" : "; in " + symbol);
  const bool bounded =
      p.range.min > -std::numeric_limits<double>::infinity() || p.range.max < std::numeric_limits<double>::infinity();
  const std::string limits = bounded ? range_text(p.range, *p.bare) : "";
  const std::string unit = symbol.empty() ? "" : "a bare number is in " + symbol;
  return limits + (limits.empty() || unit.empty() ? "" : "; ") + unit;
}

}  // namespace

void ManualWriter::visit(const Param& param) {
  const std::string name(param.name), doc = indent_ + "    " + std::string(param.doc) + "\n";
  const Param::Group* const group = param.group();
  ParamList* const list = param.list();
  if (group != nullptr || list != nullptr) {
    text_ += indent_ + "<" + name + ">  (" +
             (list != nullptr ? "any number of elements inside; left out: " + std::to_string(list->size())
                              : "an element inside") +
             ")\n" + doc;
    indent_ += "    ";
    if (list != nullptr)
      list->describe_default(*this);
    else
      group->describe(group->value, *this);
    indent_.resize(indent_.size() - 4);
    return;
  }
  if (name == kPathParam || name == kArgosParam) return;
  if (name == kOtherParams || name == kWholeElement) {
    text_ += indent_ + "NAME=\"TEXT\"  (any other name)\n" + doc;
    return;
  }
  const bool several = param.as<std::array<double, 3>>() != nullptr || param.as<Interval>() != nullptr;
  const auto number = [&](double v) {
    return several ? format_number(v / param.bare->to_si) : format_quantity(v, *param.bare);
  };
  const std::string range = range_of(param);
  text_ += indent_ + name + "=\"" + value_text(param, number, "true", "false", ",") + "\"" +
           (range.empty() ? "" : "  (" + range + ")") + "\n" + doc;
}

void FactWriter::visit(const Param& param) {
  const std::string name(param.name), doc(param.doc);
  if (const Param::Group* const group = param.group(); group != nullptr) {
    text_ += indent_ + name + ": " + doc + "\n";
    indent_ += "  ";
    group->describe(group->value, *this);
    indent_.resize(indent_.size() - 2);
    return;
  }
  if (ParamList* const list = param.list(); list != nullptr) {
    if (list->size() > 0) text_ += indent_ + doc + "\n";
    in_line_ = true;
    for (std::size_t i = 0; i < list->size(); ++i) {
      text_ += indent_ + "  " + name + " " + std::to_string(i) + ":";
      list->describe(i, *this);
      text_ += "\n";
    }
    in_line_ = false;
    return;
  }
  const bool triple = param.as<std::array<double, 3>>() != nullptr;
  const auto number = [&](double v) { return format_quantity(!triple && std::fabs(v) < 1e-15 ? 0.0 : v, *param.bare); };
  const std::string value = value_text(param, number, "yes", "no", ", ");
  if (in_line_) {
    text_ += " " + name + " " + value;
    return;
  }
  const std::string what = indent_ + name + ": " + value;
  constexpr std::size_t kColumn = 32;
  const std::size_t gap = name == "source" || what.size() + 2 > kColumn ? 2 : kColumn - what.size();
  text_ += what + (name == "source" ? "" : std::string(gap, ' ') + doc) + "\n";
}

}  // namespace tandem::hal
