#include "bench/result_line.hpp"

#include <cmath>
#include <fstream>

#include "hal/json/json.hpp"

namespace tandem::bench {
namespace {

/// Takes fields out of an object; what is missing first is kept.
class Fields {
 public:
  explicit Fields(const hal::Json& object) : object_(object) {}

  void text(const char* name, std::string& out) {
    if (const hal::Json* v = find(name, true)) out = v->get<std::string>();
  }
  void seconds(const char* name, bool may_be_zero, double& out) {
    const hal::Json* v = find(name, false);
    if (v == nullptr) return;
    out = v->get<double>();
    if (out < 0.0 || (out == 0.0 && !may_be_zero))
      complain("\"" + std::string(name) + "\" must be " + (may_be_zero ? "0 or greater" : "greater than 0"));
  }
  void count(const char* name, std::int64_t lowest, std::int64_t& out) {
    constexpr double kMost = 1e15;
    const hal::Json* v = find(name, false);
    if (v == nullptr) return;
    const auto number = v->get<double>();
    if (number != std::floor(number) || number < static_cast<double>(lowest) || number > kMost)
      complain("\"" + std::string(name) + "\" must be a whole number from " + std::to_string(lowest));
    else
      out = static_cast<std::int64_t>(number);
  }
  const std::string& trouble() const { return trouble_; }

 private:
  /// A text, or a number.
  const hal::Json* find(const char* name, bool text) {
    const auto found = object_.find(name);
    if (found == object_.end())
      complain("there is no \"" + std::string(name) + "\" in it; is it a line of `tandem bench`?");
    else if (text ? found->is_string() : found->is_number())
      return &*found;
    else
      complain("\"" + std::string(name) + "\" must be a " + (text ? "text" : "number"));
    return nullptr;
  }
  void complain(const std::string& what) {
    if (trouble_.empty()) trouble_ = what;
  }

  const hal::Json& object_;
  std::string trouble_;
};

hal::Error at_line(const std::string& path, std::int64_t number, const std::string& what) {
  return {path + ":" + std::to_string(number) + ": error: " + what};
}

}  // namespace

hal::Result<ResultLine> parse_result_line(std::string_view text) {
  const auto object = hal::parse_json_object(text);
  if (!object.ok()) return object.error();
  if (object.value().contains("failure")) return hal::Error{"this run failed, so its times mean nothing; remove it"};
  Fields fields(object.value());
  ResultLine line;
  fields.text("bench", line.bench);
  fields.text("robot", line.robot);
  fields.text("engine", line.engine);
  fields.text("partition", line.partition);
  fields.text("regions", line.regions);
  if (object.value().contains("devices")) fields.text("devices", line.devices);  // older lines have none
  fields.text("density", line.density);
  fields.text("assignment", line.assignment);
  fields.count("robots", 1, line.robots);
  fields.count("threads", 0, line.threads);
  fields.seconds("virtual_s", false, line.virtual_s);
  fields.seconds("wall_s", false, line.wall_s);
  fields.seconds("cpu_s", true, line.cpu_s);  // clocks of processor time may be coarse
  fields.text("cpu_model", line.cpu_model);
  fields.count("cores", 0, line.cores);
  if (!fields.trouble().empty()) return hal::Error{fields.trouble()};
  return line;
}

hal::Result<std::vector<ResultLine>> read_result_lines(const std::string& path) {
  std::ifstream in(path);
  std::vector<ResultLine> lines;
  std::int64_t number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto line = parse_result_line(text);
    if (!line.ok()) return at_line(path, number, line.error().message);
    line->number = number;
    lines.push_back(std::move(line).value());
  }
  if (number == 0 || in.bad())
    return hal::Error{path + ": error: no line can be read; save them with `tandem bench diffusion > " + path + "`"};
  return lines;
}

hal::Status check_alike(const std::vector<ResultLine>& lines, const std::string& path) {
  struct Trait {
    const char* what;
    std::string ResultLine::*value;
  };
  static constexpr Trait kTraits[] = {{"benchmark", &ResultLine::bench},       {"robot", &ResultLine::robot},
                                      {"devices", &ResultLine::devices},       {"density", &ResultLine::density},
                                      {"assignment", &ResultLine::assignment}, {"processor", &ResultLine::cpu_model}};
  for (const ResultLine& line : lines) {
    const ResultLine& first = lines.front();
    const auto differs = [&](const char* what, const std::string& here, const std::string& there) {
      return at_line(path, line.number,
                     std::string(what) + " '" + here + "' here, '" + there + "' in line " +
                         std::to_string(first.number) + "; keep what cannot be compared in files of its own");
    };
    for (const Trait& trait : kTraits) {
      if (line.*trait.value != first.*trait.value) return differs(trait.what, line.*trait.value, first.*trait.value);
    }
    if (line.cores != first.cores) return differs("cores", std::to_string(line.cores), std::to_string(first.cores));
  }
  return {};
}

}  // namespace tandem::bench
