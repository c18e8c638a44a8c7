// Reads <physics_engines> with their regions, and <media>.
#include <algorithm>
#include <map>

#include "core/config/reading.hpp"
#include "core/scenario/polygon.hpp"
#include "core/scenario/split.hpp"

namespace tandem::core {
namespace {

bool good_regions(const std::string& text) {
  return text.empty() || text == "auto" || parse_split(text).has_value();
}

/// What is wrong with an outline, or empty.
std::string flaw_of(const std::vector<BoundarySide>& sides) {
  std::vector<Point2> corners;
  for (const BoundarySide& side : sides) corners.push_back({side.x_m, side.y_m});
  const OutlineFlaw flaw = core::flaw_of(corners);
  const auto line = [&](std::size_t corner) { return std::to_string(sides[corner].line); };
  switch (flaw.kind) {
    case OutlineFlaw::Kind::None:
      break;
    case OutlineFlaw::Kind::TooFew:
      return "an outline needs at least three vertices";
    case OutlineFlaw::Kind::TooMany:
      return "more than 1000 vertices";
    case OutlineFlaw::Kind::SameCorners:
      return "the vertices on lines " + line(flaw.a) + " and " + line(flaw.b) + " are the same";
    case OutlineFlaw::Kind::NoArea:
      return "the outline has no area";
    case OutlineFlaw::Kind::FoldsBack:
      return "the side from line " + line(flaw.a) + " goes back along the one before it";
    case OutlineFlaw::Kind::SidesMeet:
      return "the sides from lines " + line(flaw.a) + " and " + line(flaw.b) + " cross or touch";
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
