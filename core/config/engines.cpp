// Reads <physics_engines> with their regions, and <media>.
#include <algorithm>
#include <map>

#include "core/config/reading.hpp"
#include "core/scenario/split.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kMostVertices = 1000;

bool good_regions(const std::string& text) {
  return text.empty() || text == "auto" || parse_split(text).has_value();
}

std::optional<std::array<double, 2>> point_of(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const auto x = hal::parse_quantity(std::string_view(text).substr(0, comma), hal::unit::m);
  const auto y = hal::parse_quantity(std::string_view(text).substr(comma + 1), hal::unit::m);
  if (!x.ok() || !y.ok()) return std::nullopt;
  return std::array<double, 2>{x.value(), y.value()};
}

/// Positive when c lies to the left of the line from a to b.
double side_of(const BoundarySide& a, const BoundarySide& b, const BoundarySide& c) {
  return (b.x_m - a.x_m) * (c.y_m - a.y_m) - (b.y_m - a.y_m) * (c.x_m - a.x_m);
}

bool cross(const BoundarySide& a, const BoundarySide& b, const BoundarySide& c, const BoundarySide& d) {
  return side_of(a, b, c) * side_of(a, b, d) < 0.0 && side_of(c, d, a) * side_of(c, d, b) < 0.0;
}

/// Whether c lies on the side from a to b.
bool lies_on(const BoundarySide& a, const BoundarySide& b, const BoundarySide& c) {
  return side_of(a, b, c) == 0.0 && (c.x_m - a.x_m) * (c.x_m - b.x_m) <= 0.0 &&
         (c.y_m - a.y_m) * (c.y_m - b.y_m) <= 0.0;
}

bool meet(const BoundarySide& a, const BoundarySide& b, const BoundarySide& c, const BoundarySide& d) {
  return cross(a, b, c, d) || lies_on(a, b, c) || lies_on(a, b, d) || lies_on(c, d, a) || lies_on(c, d, b);
}

/// Whether the side from b to c goes back along the one from a to b.
bool folds_back(const BoundarySide& a, const BoundarySide& b, const BoundarySide& c) {
  return side_of(a, b, c) == 0.0 && (b.x_m - a.x_m) * (c.x_m - b.x_m) + (b.y_m - a.y_m) * (c.y_m - b.y_m) < 0.0;
}

/// What is wrong with an outline, or empty.
std::string flaw_of(const std::vector<BoundarySide>& sides) {
  if (sides.size() < 3) return "an outline needs at least three vertices";
  if (sides.size() > kMostVertices) return "more than 1000 vertices";
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const BoundarySide& a = sides[i];
    const BoundarySide& b = sides[(i + 1) % sides.size()];
    if (a.x_m == b.x_m && a.y_m == b.y_m)
      return "the vertices on lines " + std::to_string(a.line) + " and " + std::to_string(b.line) + " are the same";
  }
  if (std::all_of(sides.begin() + 2, sides.end(),
                  [&](const BoundarySide& c) { return side_of(sides[0], sides[1], c) == 0.0; }))
    return "the outline has no area";
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const BoundarySide& a = sides[i];
    const BoundarySide& b = sides[(i + 1) % sides.size()];
    if (folds_back(a, b, sides[(i + 2) % sides.size()]))
      return "the side from line " + std::to_string(b.line) + " goes back along the one before it";
    for (std::size_t k = i + 2; k < sides.size(); ++k) {
      const BoundarySide& c = sides[k];
      const std::size_t next = (k + 1) % sides.size();
      if (next != i && meet(a, b, c, sides[next]))
        return "the sides from lines " + std::to_string(a.line) + " and " + std::to_string(c.line) + " cross or touch";
    }
  }
  return "";
}

void read_boundaries(Reading& reading, Element& e, EngineConfig& config) {
  reading.read<schema::Boundaries>(e);
  reading.once(e, "top", [&](Element& c) { config.top_m = reading.read<schema::Top>(c).height_m; });
  reading.once(e, "bottom", [&](Element& c) { config.bottom_m = reading.read<schema::Bottom>(c).height_m; });
  if (config.top_m && config.bottom_m && *config.top_m <= *config.bottom_m)
    reading.error(e, "<boundaries>: <top> is not above <bottom>");
  reading.once(e, "sides", [&](Element& sides) {
    reading.read<schema::Sides>(sides);
    bool good = true;
    for (Element& c : sides.children) {
      if (c.name != "vertex") continue;
      const auto vertex = reading.read<schema::Vertex>(c);
      const auto point = point_of(vertex.point);
      if (point)
        config.sides.push_back({(*point)[0], (*point)[1], vertex.gate, c.line});
      else if (!vertex.point.empty())
        reading.error(c, "point", "'" + vertex.point + "' must be two lengths, \"x,y\"");
      good = good && point;
    }
    const std::string flaw = good ? flaw_of(config.sides) : "";
    if (!flaw.empty()) reading.error(sides, "<sides>: " + flaw);
  });
}

void check_gates(Reading& reading) {
  std::vector<std::string> ids;
  for (const EngineConfig& engine : reading.out().engines) ids.push_back(engine.id);
  for (const EngineConfig& engine : reading.out().engines) {
    for (const BoundarySide& side : engine.sides) {
      if (side.gate.empty()) continue;
      Element at;
      at.name = "vertex";
      at.file = reading.out().file;
      at.line = side.line;
      if (std::find(ids.begin(), ids.end(), side.gate) == ids.end()) {
        reading.error(
            at, "gate",
            "there is no engine with id '" + side.gate + "'; there are: " + listed(ids) + did_you_mean(side.gate, ids));
      } else if (side.gate == engine.id) {
        reading.error(at, "gate", "leads back into its own engine '" + side.gate + "'");
      }
    }
  }
}

void read_engine(Reading& reading, Element& e) {
  EngineConfig config;
  const std::vector<std::string>& names = reading.known().engines;
  config.kind = e.name;
  for (const KnownEngine* engine : reading.known().catalog.all<KnownEngine>()) {
    if (engine->argos_name == e.name) config.kind = engine->kind;
  }
  config.line = e.line;
  // A program without any engine simulates nothing, and does not judge what others are to simulate with.
  if (!names.empty() && reading.known().engine(config.kind) == nullptr) {
    reading.error(
        e, "unknown physics engine <" + e.name + ">; known: " + listed(names) + did_you_mean(config.kind, names));
  }
  auto attributes = reading.read_open<schema::Engine>(e);
  ElementWriter writer(e);
  attributes.describe(writer);
  config.id = attributes.id;
  config.regions = attributes.regions;
  if (!good_regions(config.regions))
    reading.error(e, "regions", "'" + config.regions + "' must be like \"4x4\", or \"auto\"");
  reading.once(e, "boundaries", [&](Element& c) { read_boundaries(reading, c, config); });
  config.options = e;
  reading.out().engines.push_back(std::move(config));
}

}  // namespace

void read_engines(Reading& reading, Element& engines) {
  reading.read<schema::Engines>(engines);
  if (engines.children.empty() && !reading.known().engines.empty()) {
    const std::string& usual = reading.known().engines.front();
    Reading::add_child(engines, usual).attributes.push_back({"id", usual, 0});
  }
  std::map<std::string, int> lines;
  for (Element& e : engines.children) {
    read_engine(reading, e);
    const std::string* id = e.attribute("id");
    if (id == nullptr || id->empty()) continue;
    const auto [first, fresh] = lines.emplace(*id, e.line);
    if (!fresh)
      reading.error(e, "id", "a second engine '" + *id + "'; the first is on line " + std::to_string(first->second));
  }
  check_gates(reading);
}

void read_media(Reading& reading, Element& media) {
  constexpr std::size_t kMost = 255;
  reading.read<schema::Media>(media);
  std::map<std::string, int> lines;
  for (Element& e : media.children) {
    const auto* const type = reading.catalog().find<MediumType>(e.name);
    const auto medium =
        type == nullptr ? reading.read_open<schema::Medium>(e) : reading.read_with<schema::Medium>(e, type->describe);
    const auto [first, fresh] = lines.emplace(medium.id, e.line);
    if (!fresh && !medium.id.empty()) {
      reading.error(e, "id",
                    "a second medium '" + medium.id + "'; the first is on line " + std::to_string(first->second));
    }
    reading.out().media.push_back({e.name, medium.id, e, e.line});
  }
  if (media.children.size() > kMost)
    reading.error(media, "<media> holds more than " + std::to_string(kMost) + " media");
}

void connect_media(Reading& reading) {
  const auto check = [&reading](std::string_view name, int line, const std::string& medium) {
    const auto number = medium_number(reading.out().media, "led", medium);
    if (number.ok()) return;
    Element at;
    at.name = name;
    at.file = reading.out().file;
    at.line = line;
    reading.error(at, "medium", number.error().message);
  };
  for (const ObjectItem& object : reading.out().objects) check("leds", object.led_line, object.led_medium);
  for (const LightItem& light : reading.out().lights) check("light", light.line, light.medium);
}

}  // namespace tandem::core
