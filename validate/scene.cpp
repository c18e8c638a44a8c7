#include "validate/scene.hpp"

#include <fmt/format.h>
#include <sstream>
#include <stdexcept>

#include "hal/xml/xml.hpp"

namespace tandem::validate {
namespace {

std::string text_of(const hal::Element& element, std::string_view name, const std::string& otherwise = "") {
  const std::string* const found = element.attribute(name);
  return found != nullptr ? *found : otherwise;
}

std::optional<double> number_of(const hal::Element& element, std::string_view name) {
  const std::string* const found = element.attribute(name);
  if (found == nullptr) return std::nullopt;
  return std::stod(*found);
}

std::vector<std::string> words_of(std::string text) {
  for (char& c : text)
    if (c == ',') c = ' ';
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::vector<std::pair<std::string, std::string>> pairs_of(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& word : words_of(text)) {
    const std::size_t at = word.find('=');
    if (at == std::string::npos) throw std::invalid_argument("'" + word + "' is no name=value");
    pairs.emplace_back(word.substr(0, at), word.substr(at + 1));
  }
  return pairs;
}

Series series_of(const hal::Element& e) {
  Series s;
  s.engine = text_of(e, "engine");
  s.attributes = pairs_of(text_of(e, "attributes"));
  if (const std::string* const fixed = e.attribute("iterations")) s.attributes.emplace_back("iterations", *fixed);
  for (const auto& [name, value] : pairs_of(text_of(e, "figures"))) s.figures.emplace_back(name, std::stod(value));
  s.over = text_of(e, "over", "ticks");
  for (const std::string& word : words_of(text_of(e, "values"))) s.values.push_back(std::stod(word));
  if (s.engine.empty() || s.values.empty()) throw std::invalid_argument("a series needs engine and values");
  s.within = number_of(e, "within");
  s.worst = number_of(e, "worst");
  s.order = number_of(e, "order");
  return s;
}

std::array<double, 3> vector_of(const std::string& text) {
  std::array<double, 3> v{};
  const auto words = words_of(text);
  for (std::size_t i = 0; i < 3; ++i) v[i] = std::stod(words.at(i));
  return v;
}

Flight flight_of(const hal::Element& e) {
  Flight flight{text_of(e, "id"), {}, number_of(e, "thrust")};
  if (const std::string to = text_of(e, "to"); !to.empty()) flight.to_m = vector_of(to);
  if (const std::string velocity = text_of(e, "velocity"); !velocity.empty()) flight.velocity_m_s = vector_of(velocity);
  flight.pitch_rad = number_of(e, "pitch").value_or(0.0);
  flight.turn_rad_s = number_of(e, "turn").value_or(0.0);
  flight.until_s = number_of(e, "until").value_or(1e9);
  return flight;
}

void read_child(Scene& scene, const hal::Element& e) {
  if (e.name == "given") {
    for (const auto& a : e.attributes) scene.given.set(a.name, std::stod(a.value));
  } else if (e.name == "push") {
    scene.pushes.push_back({text_of(e, "id"), vector_of(text_of(e, "velocity"))});
  } else if (e.name == "drive") {
    scene.drives.push_back({text_of(e, "id"), number_of(e, "left").value(), number_of(e, "right").value(),
                            number_of(e, "until").value_or(1e9)});
  } else if (e.name == "fly") {
    scene.flights.push_back(flight_of(e));
  } else if (e.name == "gather") {
    scene.gather_m_s = number_of(e, "speed").value();
  } else if (e.name == "bisect") {
    scene.bisect = {text_of(e, "path"), number_of(e, "low").value(), number_of(e, "high").value(),
                    number_of(e, "moved").value()};
  } else if (e.name == "tandem") {
    scene.experiment = e;
  } else if (e.name == "series") {
    scene.series.push_back(series_of(e));
  } else {
    throw std::invalid_argument("<" + e.name + "> is unknown");
  }
}

/// The child of that name, which a scene has.
hal::Element& child_of(hal::Element& parent, std::string_view name) {
  for (hal::Element& child : parent.children)
    if (child.name == name) return child;
  throw std::out_of_range("a scene lacks <" + std::string(name) + ">");
}

}  // namespace

hal::Result<Scene> read_scene(std::string_view name, const std::string& text) {
  hal::Problems problems;
  const auto root = hal::read_xml_text(text, std::string(name), problems);
  if (!root) return hal::Error{problems.empty() ? "no XML" : hal::to_text(problems.front())};
  Scene scene;
  const std::size_t folder = name.find('/') + 1;
  scene.name = name.substr(folder, name.find('.') - folder);
  scene.title = text_of(*root, "title");
  scene.form = text_of(*root, "form");
  scene.measure = text_of(*root, "measure");
  scene.of = text_of(*root, "of");
  scene.unit = text_of(*root, "unit");
  try {
    scene.seconds = number_of(*root, "seconds").value();
    for (const hal::Element& e : root->children) {
      try {
        read_child(scene, e);
      } catch (const std::exception& wrong) {
        return hal::Error{fmt::format("{}:{}: <{}>: {}", name, e.line, e.name, wrong.what())};
      }
    }
  } catch (const std::exception&) {
    return hal::Error{fmt::format("{}: <scene> needs seconds", name)};
  }
  return scene;
}

std::string experiment_of(const Scene& scene, const Series& series, double value) {
  hal::Element experiment = scene.experiment;
  hal::Element engine;
  engine.name = series.engine;
  engine.attributes.push_back({"id", "engine"});
  for (const auto& [name, text] : series.attributes) engine.attributes.push_back({name, text});
  const std::string written = fmt::format("{}", value);
  if (series.over == "ticks") {
    for (auto& a : child_of(child_of(experiment, "framework"), "experiment").attributes)
      if (a.name == "ticks_per_second") a.value = written;
  } else {
    engine.attributes.push_back({series.over, written});
  }
  child_of(experiment, "physics_engines").children = {engine};
  return hal::to_xml(experiment);
}

double per_si(std::string_view unit) {
  if (unit == "mm" || unit == "mrad" || unit == "g") return 1000.0;
  return unit == "%" ? 100.0 : 1.0;
}

}  // namespace tandem::validate
