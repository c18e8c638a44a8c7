#include "hal/element.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>

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

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

const Element::Attribute* find_attribute(const Element& element, std::string_view name) {
  for (const Element::Attribute& a : element.attributes) {
    if (a.name == name) return &a;
  }
  return nullptr;
}

Problem problem_of(const Element& element, const Element::Attribute* attribute, std::string message) {
  if (attribute != nullptr && !attribute->origin.empty()) return {attribute->origin, 0, std::move(message), false};
  const int line = attribute != nullptr && attribute->line > 0 ? attribute->line : element.line;
  return {element.file, line, std::move(message), false};
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
  return {element.file, element.line, std::move(message), false};
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
  return best;
}

std::string path_beside(const std::string& path, const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (path.empty() || fs::path(path).is_absolute() || fs::exists(path, ignored)) return path;
  return (fs::path(file).parent_path() / path).string();
}

ElementReader::ElementReader(const Element& element, Problems& problems, std::vector<std::string> ignore,
                             std::vector<std::string> ignore_children)
    : element_(element), problems_(problems), known_(std::move(ignore)), known_children_(std::move(ignore_children)) {}

const std::string* ElementReader::find(std::string_view name) {
  known_.emplace_back(name);
  return element_.attribute(name);
}

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

void ElementReader::number(std::string_view name, double& value_si, const Unit& bare, Range range_si,
                           std::string_view) {
  const std::string* text = find(name);
  if (text == nullptr) return;
  const auto parsed = parse_quantity(*text, bare);
  if (!parsed.ok()) return problem(name, parsed.error().message);
  if (in_range(name, *text, parsed.value(), range_si, bare))
    value_si = std::clamp(parsed.value(), range_si.min, range_si.max);
}

void ElementReader::integer(std::string_view name, std::int64_t& value, Range range, std::string_view) {
  const std::string* text = find(name);
  if (text == nullptr) return;
  std::string_view digits = trimmed(*text);
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  std::int64_t parsed = 0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), parsed);
  if (status == std::errc::result_out_of_range) return problem(name, "'" + *text + "' is too large a number");
  if (status != std::errc{} || end != digits.data() + digits.size())
    return problem(name, "'" + *text + "' is not a whole number");
  if (in_range(name, *text, static_cast<double>(parsed), range, unit::none)) value = parsed;
}

void ElementReader::flag(std::string_view name, bool& value, std::string_view) {
  const std::string* text = find(name);
  if (text == nullptr) return;
  const std::string_view word = trimmed(*text);
  if (word == "true" || word == "1")
    value = true;
  else if (word == "false" || word == "0")
    value = false;
  else
    problem(name, "'" + *text + "' is neither \"true\" nor \"false\"");
}

void ElementReader::text(std::string_view name, std::string& value, std::string_view) {
  if (name == kPathParam) {
    value = path_beside(value, element_.file);
    return;
  }
  if (name == kOtherParams) {
    for (const Element::Attribute& a : element_.attributes) {
      if (std::find(known_.begin(), known_.end(), a.name) != known_.end()) continue;
      std::string in_a_line = a.value;
      std::replace(in_a_line.begin(), in_a_line.end(), '\n', ' ');
      value += a.name + "\n" + in_a_line + "\n";
      known_.push_back(a.name);
    }
    return;
  }
  if (const std::string* text = find(name); text != nullptr) value = *text;
}

void ElementReader::choice(std::string_view name, std::string& value, std::span<const std::string_view> options,
                           std::string_view) {
  const std::string* text = find(name);
  if (text == nullptr) return;
  const std::vector<std::string> names(options.begin(), options.end());
  const std::string word(trimmed(*text));
  if (std::find(names.begin(), names.end(), word) == names.end()) {
    return problem(name, "'" + *text + "' is not one of: " + listed(names) + did_you_mean(word, names));
  }
  value = word;
}

void ElementReader::vector(std::string_view name, std::array<double, 3>& value_si, const Unit& bare, std::string_view) {
  const std::string* text = find(name);
  if (text == nullptr) return;
  std::array<double, 3> parsed{};
  std::string_view rest = *text;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i == 2))
      return problem(name, "'" + *text + "' must be three numbers, \"x,y,z\"");
    const auto part = parse_quantity(rest.substr(0, comma), bare);
    if (!part.ok()) return problem(name, part.error().message);
    if (std::fabs(part.value()) > kFarthest)
      return problem(name, "'" + *text + "': every number must be within " +
                               (bare.dim == Dim::Length ? "1000 km" : "a million") + " of 0");
    parsed[i] = part.value();
    if (i < 2) rest.remove_prefix(comma + 1);
  }
  value_si = parsed;
}

void ElementReader::visit_group(std::string_view name, void* value, Describe describe, std::string_view) {
  known_children_.emplace_back(name);
  const Element* first = nullptr;
  for (const Element& child : element_.children) {
    if (child.name != name) continue;
    if (first != nullptr) {
      problems_.push_back(
          problem_at(child, "a second <" + child.name + ">; the first is on line " + std::to_string(first->line)));
      continue;
    }
    first = &child;
    ElementReader reader(child, problems_);
    describe(value, reader);
    reader.finish();
  }
}

void ElementReader::visit_list(std::string_view name, ParamList& list, std::string_view) {
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
    problems_.push_back(problem_at(child, cannot_hold(element_, child, known_children_)));
  }
}

void ElementReader::finish_attributes() {
  for (const Element::Attribute& a : element_.attributes) {
    if (std::find(known_.begin(), known_.end(), a.name) != known_.end()) continue;
    problems_.push_back(problem_of(
        element_, &a, "<" + element_.name + "> has no attribute '" + a.name + "'" + did_you_mean(a.name, known_)));
  }
}

void ElementWriter::add(std::string_view name, std::string value) {
  if (element_.attribute(name) == nullptr) element_.attributes.push_back({std::string(name), std::move(value), 0});
}

void ElementWriter::number(std::string_view name, double& value_si, const Unit& bare, Range, std::string_view) {
  add(name, format_exactly(value_si, bare));
}
void ElementWriter::integer(std::string_view name, std::int64_t& value, Range, std::string_view) {
  add(name, std::to_string(value));
}
void ElementWriter::flag(std::string_view name, bool& value, std::string_view) {
  add(name, value ? "true" : "false");
}
void ElementWriter::text(std::string_view name, std::string& value, std::string_view) {
  if (name == kOtherParams || name == kPathParam) return;  // written already
  add(name, value);
}
void ElementWriter::choice(std::string_view name, std::string& value, std::span<const std::string_view>,
                           std::string_view) {
  add(name, value);
}
void ElementWriter::vector(std::string_view name, std::array<double, 3>& v, const Unit& bare, std::string_view) {
  add(name, format_exactly(v[0], bare) + "," + format_exactly(v[1], bare) + "," + format_exactly(v[2], bare));
}

Element& ElementWriter::add_child(std::string_view name) {
  Element& child = element_.children.emplace_back();
  child.name = name;
  child.file = element_.file;
  child.line = element_.line;
  return child;
}

void ElementWriter::visit_group(std::string_view name, void* value, Describe describe, std::string_view) {
  const auto same = [&](const Element& child) { return child.name == name; };
  const auto found = std::find_if(element_.children.begin(), element_.children.end(), same);
  ElementWriter writer(found != element_.children.end() ? *found : add_child(name));
  describe(value, writer);
}

void ElementWriter::visit_list(std::string_view name, ParamList& list, std::string_view) {
  bool any = false;
  for (Element& child : element_.children) {
    if (child.name != name) continue;
    any = true;
    ElementWriter writer(child);
    list.describe_default(writer);
  }
  for (std::size_t i = 0; !any && i < list.size(); ++i) {
    ElementWriter writer(add_child(name));
    list.describe(i, writer);
  }
}

void ManualWriter::line(std::string_view name, const std::string& value, const std::string& range,
                        std::string_view doc) {
  text_ += indent_ + std::string(name) + "=\"" + value + "\"";
  if (!range.empty()) text_ += "  (" + range + ")";
  text_ += "\n" + indent_ + "    " + std::string(doc) + "\n";
}

void ManualWriter::child(std::string_view name, std::string_view what, std::string_view doc) {
  text_ += indent_ + "<" + std::string(name) + ">  (" + std::string(what) + ")\n" + indent_ + "    " +
           std::string(doc) + "\n";
}

void ManualWriter::visit_group(std::string_view name, void* value, Describe describe, std::string_view doc) {
  child(name, "an element inside", doc);
  indent_ += "    ";
  describe(value, *this);
  indent_.resize(indent_.size() - 4);
}

void ManualWriter::visit_list(std::string_view name, ParamList& list, std::string_view doc) {
  child(name, "any number of elements inside; left out: " + std::to_string(list.size()), doc);
  indent_ += "    ";
  list.describe_default(*this);
  indent_.resize(indent_.size() - 4);
}

void ManualWriter::number(std::string_view name, double& value_si, const Unit& bare, Range range,
                          std::string_view doc) {
  const bool bounded =
      range.min > -std::numeric_limits<double>::infinity() || range.max < std::numeric_limits<double>::infinity();
  const std::string unit = bare.symbol.empty() ? "" : "a bare number is in " + std::string(bare.symbol);
  const std::string limits = bounded ? range_text(range, bare) : "";
  line(name, format_quantity(value_si, bare), limits + (limits.empty() || unit.empty() ? "" : "; ") + unit, doc);
}
void ManualWriter::integer(std::string_view name, std::int64_t& value, Range range, std::string_view doc) {
  const bool bounded =
      range.min > -std::numeric_limits<double>::infinity() || range.max < std::numeric_limits<double>::infinity();
  line(name, std::to_string(value), bounded ? range_text(range, unit::none) : "", doc);
}
void ManualWriter::flag(std::string_view name, bool& value, std::string_view doc) {
  line(name, value ? "true" : "false", "true or false", doc);
}
void ManualWriter::text(std::string_view name, std::string& value, std::string_view doc) {
  if (name == kPathParam) return;
  if (name == kOtherParams) return line("NAME", "TEXT", "any other name", doc);
  line(name, value, "", doc);
}
void ManualWriter::choice(std::string_view name, std::string& value, std::span<const std::string_view> options,
                          std::string_view doc) {
  std::string list;
  for (const std::string_view option : options) list += (list.empty() ? "" : ", ") + std::string(option);
  line(name, value, list, doc);
}
void ManualWriter::vector(std::string_view name, std::array<double, 3>& v, const Unit& bare, std::string_view doc) {
  line(name,
       format_number(v[0] / bare.to_si) + "," + format_number(v[1] / bare.to_si) + "," +
           format_number(v[2] / bare.to_si),
       "three numbers" + (bare.symbol.empty() ? std::string() : " in " + std::string(bare.symbol)), doc);
}

void FactWriter::fact(std::string_view name, const std::string& value, std::string_view doc) {
  if (in_line_) {
    text_ += " " + std::string(name) + " " + value;
    return;
  }
  const std::string what = indent_ + std::string(name) + ": " + value;
  constexpr std::size_t kColumn = 32;
  const std::size_t gap = name == "source" || what.size() + 2 > kColumn ? 2 : kColumn - what.size();
  text_ += what + (name == "source" ? "" : std::string(gap, ' ') + std::string(doc)) + "\n";
}

void FactWriter::number(std::string_view name, double& value_si, const Unit& bare, Range, std::string_view doc) {
  fact(name, format_quantity(std::fabs(value_si) < 1e-15 ? 0.0 : value_si, bare), doc);
}
void FactWriter::integer(std::string_view name, std::int64_t& value, Range, std::string_view doc) {
  fact(name, std::to_string(value), doc);
}
void FactWriter::flag(std::string_view name, bool& value, std::string_view doc) {
  fact(name, value ? "yes" : "no", doc);
}
void FactWriter::text(std::string_view name, std::string& value, std::string_view doc) {
  fact(name, value, doc);
}
void FactWriter::choice(std::string_view name, std::string& value, std::span<const std::string_view>,
                        std::string_view doc) {
  fact(name, value, doc);
}
void FactWriter::vector(std::string_view name, std::array<double, 3>& v, const Unit& bare, std::string_view doc) {
  fact(name, format_quantity(v[0], bare) + ", " + format_quantity(v[1], bare) + ", " + format_quantity(v[2], bare),
       doc);
}

void FactWriter::visit_group(std::string_view name, void* value, Describe describe, std::string_view doc) {
  text_ += indent_ + std::string(name) + ": " + std::string(doc) + "\n";
  indent_ += "  ";
  describe(value, *this);
  indent_.resize(indent_.size() - 2);
}

void FactWriter::visit_list(std::string_view name, ParamList& list, std::string_view doc) {
  if (list.size() > 0) text_ += indent_ + std::string(doc) + "\n";
  in_line_ = true;
  for (std::size_t i = 0; i < list.size(); ++i) {
    text_ += indent_ + "  " + std::string(name) + " " + std::to_string(i) + ":";
    list.describe(i, *this);
    text_ += "\n";
  }
  in_line_ = false;
}

}  // namespace tandem::hal
