#include "bridges/footbot/map_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "bridges/aseba/message.hpp"
#include "bridges/footbot/robot.hpp"
#include "bridges/footbot/words.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::bridges::footbot {
namespace {

using hal::Element;
using hal::ElementReader;

constexpr std::int64_t kMostWords = 1024;
constexpr std::array<std::string_view, 5> kForms = {"int16", "uint16", "int32", "int32_high_first", "bytes"};
constexpr std::array<std::string_view, 3> kNeeds = {"always", "used", "never"};

std::vector<std::string> split(const std::string& names) {
  std::vector<std::string> all;
  for (std::size_t at = 0; at <= names.size();) {
    const std::size_t end = std::min(names.find('|', at), names.size());
    std::string name = names.substr(at, end - at);
    name.erase(0, std::min(name.find_first_not_of(' '), name.size()));
    name.erase(name.find_last_not_of(' ') + 1);
    if (!name.empty()) all.push_back(std::move(name));
    at = end + 1;
  }
  return all;
}

bool is_stamp(const hal::Field& field) {
  return field.name == "taken_ns" || field.name == "validity";
}

class MapReader {
 public:
  explicit MapReader(hal::Problems& problems) : problems_(problems) {}

  FootbotMap read(const Element& root) {
    FootbotMap map;
    if (root.name != "footbot_map") error(root, "the root element is <" + root.name + ">, not <footbot_map>");
    double refresh_s = hal::to_seconds(map.refresh_ns);
    ElementReader reader(root, problems_);
    reader.text("profile", map.profile, "");
    reader.number("refresh", refresh_s, hal::unit::s, {0.02, 60.0}, "");
    reader.finish_attributes();
    map.refresh_ns = to_ns(refresh_s);
    for (const Element& child : children(root, {"node"})) map.nodes.push_back(node(child));
    if (map.nodes.empty()) error(root, "there is no <node>");
    return map;
  }

 private:
  static hal::TimeNs to_ns(double s) { return static_cast<hal::TimeNs>(std::llround(s * 1e9)); }
  void error(const Element& e, std::string message) { problems_.push_back(hal::problem_at(e, std::move(message))); }
  void error(const Element& e, std::string_view attribute, std::string message) {
    problems_.push_back(hal::problem_at(e, attribute, std::move(message)));
  }

  /// The children that may be there; others are problems.
  std::vector<Element> children(const Element& e, const std::vector<std::string>& names) {
    std::vector<Element> good;
    for (const Element& c : e.children) {
      if (std::ranges::find(names, c.name) != names.end()) {
        good.push_back(c);
      } else {
        error(c, "<" + e.name + "> has no <" + c.name + ">; there is: " + hal::listed(names) +
                     hal::did_you_mean(c.name, names));
      }
    }
    return good;
  }

  std::vector<std::string> names_of(const Element& e, ElementReader& reader) {
    std::string text;
    reader.text("names", text, "");
    std::vector<std::string> names = split(text);
    if (names.empty()) {
      error(e, "names", "missing; write the name, or several with | between them");
      names.emplace_back("?");
    }
    return names;
  }

  NodeMap node(const Element& e) {
    NodeMap node;
    node.line = e.line;
    std::int64_t id = 0;
    std::string needed = "used";
    ElementReader reader(e, problems_);
    node.names = names_of(e, reader);
    reader.integer("id", id, {0, 255}, "");
    reader.choice("needed", needed, kNeeds, "");
    reader.finish_attributes();
    node.id = static_cast<std::uint8_t>(id);
    node.need = needed == "always" ? Need::Always : needed == "never" ? Need::Never : Need::Used;
    claim(e, node.names, nodes_, "node");
    std::map<std::string, int> variables;
    std::map<int, int> numbers;
    int dead_men = 0;
    for (const Element& child : children(e, {"variable", "event", "dead_man"})) {
      if (child.name == "dead_man") {
        if (dead_men++ > 0) error(child, "", "a node has one");
        node.dead_man = dead_man(child);
      } else if (child.name == "variable") {
        node.variables.push_back(variable(child));
        claim(child, node.variables.back().names, variables, "variable");
      } else {
        node.packets.push_back(event(child));
        const auto [first, fresh] = numbers.emplace(node.packets.back().number, child.line);
        if (!fresh) error(child, "number", "is taken by the event on line " + std::to_string(first->second));
      }
    }
    if (node.variables.empty() && node.packets.empty()) error(e, "has neither a <variable> nor an <event>");
    const bool commanded = std::ranges::any_of(node.variables, [](const VariableMap& v) { return !v.writes.empty(); });
    if (dead_men > 0 && !commanded) error(e, "has a <dead_man>, and nothing is written to it");
    return node;
  }

  void claim(const Element& e, const std::vector<std::string>& names, std::map<std::string, int>& taken,
             const std::string& what) {
    for (const std::string& name : names) {
      const auto [first, fresh] = taken.emplace(name, e.line);
      if (!fresh && name != "?")
        error(e, "names", "'" + name + "' is the name of the " + what + " on line " + std::to_string(first->second));
    }
  }

  DeadManMap dead_man(const Element& e) {
    DeadManMap map;
    double period_s = 0.02, after_s = 0.5;
    ElementReader reader(e, problems_);
    reader.text("event", map.event, "");
    reader.number("period", period_s, hal::unit::s, {0.001, 1.0}, "");
    reader.number("after", after_s, hal::unit::s, {0.1, 60.0}, "");
    reader.finish_attributes();
    if (map.event.empty()) error(e, "event", "missing; write which of the node's own events comes again and again");
    if (after_s < 3.0 * period_s) error(e, "after", "is less than three periods");
    map.period_ns = to_ns(period_s);
    map.after_ns = to_ns(after_s);
    return map;
  }

  VariableMap variable(const Element& e) {
    VariableMap v;
    v.line = e.line;
    std::int64_t words = 0;
    double period_s = 0.0;
    ElementReader reader(e, problems_);
    v.names = names_of(e, reader);
    reader.integer("words", words, {1, static_cast<double>(kMostWords)}, "");
    reader.number("period", period_s, hal::unit::s, {0.0, 3600.0}, "");
    reader.flag("optional", v.optional, "");
    reader.flag("verify", v.verify, "");
    reader.finish_attributes();
    if (e.attribute("words") == nullptr) error(e, "words", "missing; write how many words the variable has");
    v.words = static_cast<std::size_t>(std::max<std::int64_t>(words, 1));
    v.period_ns = to_ns(period_s);
    for (const Element& child : children(e, {"read", "write"})) {
      const bool reads = child.name == "read";
      const auto field = field_map(child, reads ? hal::Role::Sensor : hal::Role::Actuator, v.words, words > 0);
      if (field) (reads ? v.reads : v.writes).push_back(*field);
    }
    if (e.children.empty()) error(e, "has neither a <read> nor a <write>: nobody needs it");
    if (v.verify && v.writes.empty()) error(e, "verify", "nothing is written to this variable");
    if (words > 0) check_writes(e, v);
    return v;
  }

  /// A SET_VARIABLES writes a row of words: all of the variable's, each from one place.
  void check_writes(const Element& e, const VariableMap& v) {
    if (v.writes.empty()) return;
    if (v.words > aseba::kMostWrite)
      return error(e, "words", "a variable that is written has at most " + std::to_string(aseba::kMostWrite));
    std::vector<std::int16_t> marks(v.words, 0);
    for (const FieldMap& f : v.writes) {
      for (std::size_t i = 0; i < f.count; ++i) {
        if (raw_number(f, marks, i) != 0) {
          return error(e, "two <write> elements, or two numbers of one, write the same word");
        }
        set_raw_number(f, marks, i, f.form == WordForm::Bytes ? 0xFF : 0x01010101);
      }
    }
    for (std::size_t i = 0; i < v.words; ++i) {
      const auto mark = static_cast<std::uint16_t>(marks[i]);
      if ((mark & 0xFFU) == 0 || (mark >> 8U) == 0)
        return error(e, "no <write> says what is to be in word " + std::to_string(i));
    }
  }

  const hal::PortType* port_of(const Element& e, const std::string& name, hal::Role role) {
    std::vector<std::string> names;
    for (const hal::PortType* type : port_types()) {
      if (type->role != role) continue;
      if (type->name == name) return type;
      names.emplace_back(type->name);
    }
    error(e, "port",
          "'" + name + "' is no port that a foot-bot " + (role == hal::Role::Sensor ? "reads" : "writes") +
              "; there is: " + hal::listed(names) + hal::did_you_mean(name, names));
    return nullptr;
  }

  const hal::Field* field_of(const Element& e, std::string_view attribute, const hal::PortType& port,
                             const std::string& name) {
    std::vector<std::string> names;
    for (const hal::Field& field : port.fields) {
      if (is_stamp(field)) continue;
      if (field.name == name) return &field;
      names.emplace_back(field.name);
    }
    error(e, attribute,
          "'" + name + "' is no field of the port '" + std::string(port.name) + "'; there is: " + hal::listed(names) +
              hal::did_you_mean(name, names));
    return nullptr;
  }

  /// A number in the field's unit.
  void quantity(const Element& e, ElementReader& reader, std::string_view attribute, const hal::Field* field,
                double& value) {
    reader.number(attribute, value, field != nullptr ? field->unit : hal::unit::none, hal::kAny, "");
    if (field == nullptr) return;
    if (attribute == "scale" && value == 0.0) error(e, attribute, "may not be 0");
  }

  /// What reads and writes have in common. Nothing when port or field is not known.
  std::optional<FieldMap> field_map(const Element& e, hal::Role role, std::size_t words, bool words_known) {
    FieldMap f;
    std::string port, field, form = "int16", rate, when;
    std::int64_t word = 0, word_step = 1, element = 0, element_step = 1, count = 0;
    std::int64_t least = f.least, most = f.most, rest = f.rest;
    // Quantities are in the field's unit, so the field comes first.
    const std::size_t problems_before = problems_.size();
    if (const std::string* p = e.attribute("port"); p != nullptr) {
      f.port = port_of(e, *p, role);
    } else {
      error(e, "port", "missing; write which port is meant");
    }
    if (const std::string* n = e.attribute("field"); n == nullptr) {
      error(e, "field", "missing; write which field of the port is meant");
    } else if (f.port != nullptr) {
      f.field = field_of(e, "field", *f.port, *n);
    }
    ElementReader reader(e, problems_,
                         f.field == nullptr ? std::vector<std::string>{"scale", "offset", "min", "max", "fastest"}
                                            : std::vector<std::string>{});
    reader.text("port", port, "");
    reader.text("field", field, "");
    reader.choice("form", form, kForms, "");
    reader.integer("word", word, {0, static_cast<double>(kMostWords)}, "");
    reader.integer("word_step", word_step, {-kMostStep, kMostStep}, "");
    reader.integer("element", element, {0, static_cast<double>(kMostWords)}, "");
    reader.integer("element_step", element_step, {-kMostStep, kMostStep}, "");
    reader.integer("count", count, {1, static_cast<double>(kMostWords)}, "");
    if (f.field != nullptr) {
      quantity(e, reader, "scale", f.field, f.scale);
      quantity(e, reader, "offset", f.field, f.offset);
    }
    if (role == hal::Role::Sensor) {
      if (f.field != nullptr) {
        quantity(e, reader, "min", f.field, f.min);
        quantity(e, reader, "max", f.field, f.max);
        quantity(e, reader, "fastest", f.field, f.fastest);
      }
      reader.flag("accumulate", f.accumulate, "");
      reader.text("rate", rate, "");
    } else {
      reader.integer("least", least, kInt32, "");
      reader.integer("most", most, kInt32, "");
      reader.integer("rest", rest, kInt32, "");
      reader.text("when", when, "");
    }
    reader.finish_attributes();
    f.form = static_cast<WordForm>(std::ranges::find(kForms, form) - kForms.begin());
    f.word = static_cast<std::size_t>(word);
    f.word_step = static_cast<int>(word_step);
    f.element = static_cast<std::size_t>(element);
    f.element_step = static_cast<int>(element_step);
    f.least = static_cast<std::int32_t>(least);
    f.most = static_cast<std::int32_t>(most);
    f.rest = static_cast<std::int32_t>(rest);
    if (f.field == nullptr) return std::nullopt;
    f.count = count > 0 ? static_cast<std::size_t>(count) : as_many_as_fit(f, words);
    if (!rate.empty()) f.rate = field_of(e, "rate", *f.port, rate);
    if (!when.empty()) f.when = field_of(e, "when", *f.port, when);
    knots(e, f, role);
    if (problems_.size() > problems_before) return std::nullopt;
    check_field(e, f, role, words, words_known);
    return problems_.size() > problems_before ? std::nullopt : std::optional(f);
  }

  static std::size_t as_many_as_fit(const FieldMap& f, std::size_t words) {
    if (f.word_step == 0 || f.element_step == 0) return 1;
    FieldMap trial = f;
    std::size_t count = 1;
    for (; count < f.field->count; ++count) {
      trial.count = count + 1;
      const auto range = words_of(trial);
      const auto element = static_cast<std::ptrdiff_t>(f.element) + static_cast<std::ptrdiff_t>(count) * f.element_step;
      if (range.first < 0 || range.behind > static_cast<std::ptrdiff_t>(words)) break;
      if (element < 0 || element >= static_cast<std::ptrdiff_t>(f.field->count)) break;
    }
    return count;
  }

  void knots(const Element& e, FieldMap& f, hal::Role role) {
    const auto allowed =
        role == hal::Role::Sensor ? std::vector<std::string>{"knot", "special"} : std::vector<std::string>{};
    for (const Element& child : children(e, allowed)) {
      std::int64_t raw = 0;
      double value = 0.0;
      ElementReader reader(child, problems_);
      reader.integer("raw", raw, kInt32, "");
      reader.number("value", value, f.field->unit, hal::kAny, "");
      reader.finish();
      for (const char* attribute : {"raw", "value"}) {
        if (child.attribute(attribute) == nullptr) error(child, attribute, "missing");
      }
      auto& list = child.name == "knot" ? f.curve : f.specials;
      if (child.name == "knot" && !list.empty() && static_cast<double>(raw) <= list.back().raw)
        error(child, "raw", "knots must ascend: this one is not beyond the one before it");
      list.push_back({static_cast<double>(raw), value});
    }
    if (f.curve.size() == 1) error(e, "a curve has two <knot> at least");
    if (!f.curve.empty() && (e.attribute("scale") != nullptr || e.attribute("offset") != nullptr))
      error(e, "has both a curve of <knot> and scale or offset; only one of them can hold");
  }

  void check_field(const Element& e, const FieldMap& f, hal::Role role, std::size_t words, bool words_known) {
    const auto range = words_of(f);
    if (words_known && (range.first < 0 || range.behind > static_cast<std::ptrdiff_t>(words))) {
      error(e, "reaches from word " + std::to_string(range.first) + " to " + std::to_string(range.behind - 1) +
                   " of a variable of " + std::to_string(words) + " words");
    }
    if (!words_known) return;
    if (f.count > 1 && (f.word_step == 0 || f.element_step == 0))
      return error(e, "a step of 0 means the same place " + std::to_string(f.count) + " times");
    const auto reach =
        static_cast<std::ptrdiff_t>(f.element) + static_cast<std::ptrdiff_t>(f.count - 1) * f.element_step;
    const auto most = static_cast<std::ptrdiff_t>(f.field->count) - 1;
    if (reach < 0 || reach > most || static_cast<std::ptrdiff_t>(f.element) > most) {
      return error(e, "reaches from element " + std::to_string(f.element) + " to " + std::to_string(reach) +
                          " of the field '" + std::string(f.field->name) + "' of " + std::to_string(f.field->count));
    }
    if (f.min > f.max) error(e, "min", "is larger than max");
    if (f.least > f.most) error(e, "least", "is larger than most");
    if (f.rate != nullptr && f.rate->count != f.field->count)
      error(e, "rate", "'" + std::string(f.rate->name) + "' has another number of elements");
    if (f.when != nullptr && f.when->scalar != hal::Scalar::Bool)
      error(e, "when", "'" + std::string(f.when->name) + "' is no flag");
    if (f.accumulate && !f.curve.empty()) error(e, "accumulate", "a counter has no curve");
    if (f.rate != nullptr && !f.curve.empty()) error(e, "rate", "is known with a scale only, not with a curve");
    if (f.rest < smallest(f.form) || f.rest > largest(f.form)) error(e, "rest", "is no number of this form");
    for (std::size_t i = 0; i < f.count; ++i) claim_element(e, f, i, role);
  }

  void claim_element(const Element& e, const FieldMap& f, std::size_t i, hal::Role role) {
    if (role == hal::Role::Actuator) return;  // one command may go to several places
    const auto element = static_cast<std::ptrdiff_t>(f.element) + static_cast<std::ptrdiff_t>(i) * f.element_step;
    const auto [first, fresh] = elements_.emplace(std::tuple(f.port->name, f.field->name, element), e.line);
    if (!fresh && i == 0) {
      error(e, "element " + std::to_string(element) + " of '" + std::string(f.field->name) + "' of the port '" +
                   std::string(f.port->name) + "' is read on line " + std::to_string(first->second) + " already");
    }
  }

  PacketMap event(const Element& e) {
    PacketMap packet;
    packet.line = e.line;
    std::int64_t number = -1, words = 0;
    std::string port;
    ElementReader reader(e, problems_);
    reader.integer("number", number, {0, aseba::kFirstBootloader - 1}, "");
    reader.integer("words", words, {1, static_cast<double>(aseba::kMostWords)}, "");
    reader.text("port", port, "");
    reader.finish_attributes();
    for (const char* attribute : {"number", "words", "port"}) {
      if (e.attribute(attribute) == nullptr) error(e, attribute, "missing");
    }
    const hal::PortType& type = hal::port_type<hal::RangeAndBearing>();
    if (!port.empty() && port != type.name)
      error(e, "port", "events bring messages of 'range_and_bearing' alone, not of '" + port + "'");
    packet.number = static_cast<std::uint16_t>(std::max<std::int64_t>(number, 0));
    packet.words = static_cast<std::size_t>(std::max<std::int64_t>(words, 1));
    packet.range.count = packet.bearing.count = packet.elevation.count = packet.payload.count = 0;
    for (const Element& child : children(e, {"value"})) argument(child, packet, words > 0);
    if (packet.range.count == 0) error(e, "no <value> says where the field 'range' is");
    if (packet.payload.count == 0) error(e, "no <value> says where the field 'payload' is");
    return packet;
  }

  void argument(const Element& e, PacketMap& packet, bool words_known) {
    Element with_port = e;
    with_port.attributes.push_back({"port", std::string(hal::RangeAndBearing::kName), e.line});
    const auto taken = elements_;  // arguments of several events may mean the same
    auto field = field_map(with_port, hal::Role::Sensor, packet.words, words_known);
    elements_ = taken;
    if (!field) return;
    const std::string_view name = field->field->name;
    FieldMap* place = name == "range"       ? &packet.range
                      : name == "bearing"   ? &packet.bearing
                      : name == "elevation" ? &packet.elevation
                      : name == "payload"   ? &packet.payload
                                            : nullptr;
    if (place == nullptr) return error(e, "field", "an event tells range, bearing, elevation and payload, not this");
    if (place->count != 0) return error(e, "field", "'" + std::string(name) + "' is there twice");
    if (place != &packet.payload) {
      field->count = 1;
    } else if (field->count > hal::kRabPayloadMax) {
      if (e.attribute("count") != nullptr)
        return error(e, "count", "a message has at most " + std::to_string(hal::kRabPayloadMax) + " bytes");
      field->count = hal::kRabPayloadMax;
    }
    *place = *field;
  }

  static constexpr double kMostStep = 256;
  static constexpr hal::Range kInt32 = {-2147483648.0, 2147483647.0};

  hal::Problems& problems_;
  std::map<std::string, int> nodes_;
  std::map<std::tuple<std::string_view, std::string_view, std::ptrdiff_t>, int> elements_;
};

std::optional<FootbotMap> judged(const std::optional<Element>& root, hal::Problems& problems, std::size_t before) {
  if (!root) return std::nullopt;
  FootbotMap map = MapReader(problems).read(*root);
  if (hal::has_errors(problems, before)) return std::nullopt;
  return map;
}

}  // namespace

std::optional<FootbotMap> read_footbot_map(const std::string& path, hal::Problems& problems) {
  const std::size_t before = problems.size();
  return judged(hal::read_xml_file(path, problems), problems, before);
}

hal::Result<FootbotMap> footbot_map_for(const std::string& robot, const std::string& path) {
  hal::Problems problems;
  if (auto map = read_footbot_map(path, problems)) return std::move(*map);
  std::string message = "the map of the foot-bot '" + robot + "' cannot be used";
  for (const hal::Problem& p : problems) message += "\n" + to_text(p);
  return hal::Error{message};
}

std::optional<FootbotMap> read_footbot_map_text(const std::string& text, const std::string& name,
                                                hal::Problems& problems) {
  const std::size_t before = problems.size();
  return judged(hal::read_xml_text(text, name, problems), problems, before);
}

}  // namespace tandem::bridges::footbot
