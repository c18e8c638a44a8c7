// Reads <arena>: the space and what is in it.
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/config/reading.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/element_options.hpp"
#include "hal/named_colors.hpp"

namespace tandem::core {
namespace {

/// Reads the things in the arena; `distribute` is what they stand in, if anything.
class ArenaReader {
 public:
  explicit ArenaReader(Reading& reading) : reading_(reading), out_(reading.out()) {
    for (std::size_t i = 0; i < out_.controllers.size(); ++i) controllers_.emplace(out_.controllers[i].id, i);
  }

  void arena(Element& e) {
    const auto a = reading_.read<schema::Arena>(e);
    out_.arena_size = a.size;
    out_.arena_center = a.center;
    out_.escape = a.escape == "stop"     ? EscapePolicy::Stop
                  : a.escape == "remove" ? EscapePolicy::Remove
                                         : EscapePolicy::Error;
    check_lengths(e, a.size);
    for (const FieldType* type : reading_.catalog().all<FieldType>()) {
      if (type->describe != nullptr) reading_.once_or_default(e, type->name, [&](Element& c) { field(c, *type); });
    }
    for (Element& c : e.children) {
      if (c.name == "distribute")
        distribute(c);
      else
        thing(c, nullptr);
    }
    check_total(e);
  }

 private:
  void check_lengths(const Element& e, const Vec3& size) {
    for (const double length : size) {
      if (length > 0.0 && length <= schema::kLargestArena_m) continue;
      return reading_.error(e, "size",
                            "'" + *e.attribute("size") + "': every length must be above 0 and at most 1000 km");
    }
  }

  void check_total(const Element& e) {
    std::int64_t robots = 0;
    for (const RobotItem& r : out_.robots) robots += r.distribute ? r.distribute->quantity : 1;
    if (robots > static_cast<std::int64_t>(schema::kLargestQuantity)) {
      reading_.error(e, std::to_string(robots) + " robots in all; at most 100000000 can be numbered");
    }
  }

  void field(Element& e, const FieldType& type) {
    for (Element::Attribute& a : e.attributes) {
      if (a.name == "path" && !a.value.empty()) a.value = hal::path_beside(a.value, out_.file);
    }
    reading_.read_with<schema::FieldElement>(e, type.describe);
    out_.fields.push_back(e);
  }

  void thing(Element& e, const Distribute* distribute) {
    if (e.name == "box")
      object(box(e, distribute), e, distribute);
    else if (e.name == "cylinder")
      object(cylinder(e, distribute), e, distribute);
    else if (e.name == "light")
      light(e, distribute);
    else if (e.name == "sound")
      sound(e);
    else if (reading_.is_robot(e.name))
      robot(e, distribute);
  }

  // --- where things start ---

  Placement body(Element& e, const Distribute* distribute) {
    Element* given = reading_.only(e, "body");
    if (given == nullptr) {
      if (distribute == nullptr)
        reading_.error(e, "<" + e.name + "> needs a <body position=\"x,y,z\" orientation=\"z,y,x\"/>");
      return {};
    }
    if (distribute != nullptr)
      reading_.warn(*given, "<body> has no effect: the <distribute> around it places the <" + e.name + ">");
    else if (given->attribute("position") == nullptr)
      reading_.error(*given, "<body> needs the attribute 'position'");
    const auto b = reading_.read<schema::Body>(*given);
    return {b.position, b.orientation[0], b.orientation[1], b.orientation[2]};
  }

  void distribute(Element& e) {
    reading_.read<schema::DistributeElement>(e);
    for (const std::string_view needed : {"position", "orientation", "entity"}) {
      if (e.child(needed) == nullptr) reading_.error(e, "<distribute> needs <" + std::string(needed) + ">");
    }
    Distribute d;
    d.order = distributes_++;
    d.line = e.line;
    reading_.once(e, "position", [&](Element& c) { d.position = distribution<schema::PositionDraw>(c); });
    reading_.once(e, "orientation", [&](Element& c) { d.orientation = distribution<schema::OrientationDraw>(c); });
    reading_.once(e, "entity", [&](Element& c) {
      const auto attributes = reading_.read<schema::Entity>(c);
      d.quantity = attributes.quantity;
      d.max_trials = attributes.max_trials;
      d.base_num = attributes.base_num;
      check_places(c, d);
      reading_.number_things(true);
      if (c.children.size() == 1)
        thing(c.children.front(), &d);
      else
        reading_.error(c, "<entity> needs exactly one robot, box, cylinder or light inside; it has " +
                              std::to_string(c.children.size()));
      reading_.number_things(false);
    });
  }

  void check_places(const Element& entity, const Distribute& d) {
    if (d.position.method != Distribution::Method::Grid) return;
    const std::int64_t places = std::int64_t{1} * d.position.layout[0] * d.position.layout[1] * d.position.layout[2];
    if (d.quantity > places)
      reading_.error(entity, "quantity", "the grid has only " + std::to_string(places) + " places");
  }

  template <class Schema>
  Distribution distribution(Element& e) {
    const auto draw = reading_.read_open<Schema>(e);
    Distribution d;
    d.line = e.line;
    d.min = draw.min;
    d.max = draw.max;
    d.mean = draw.mean;
    d.std_dev = draw.std_dev;
    d.values = draw.values;
    d.center = draw.center;
    d.distances = draw.distances;
    if (draw.method == "uniform") d.method = Distribution::Method::Uniform;
    if (draw.method == "gaussian") d.method = Distribution::Method::Gaussian;
    if (draw.method == "grid") d.method = Distribution::Method::Grid;
    check_draw_attributes(e, draw.method);
    check_draw_values(e, draw, d);
    return d;
  }

  /// Each method needs its own attributes, and takes no others.
  void check_draw_attributes(const Element& e, const std::string& method) {
    std::vector<std::string> own{"method"};
    for (const schema::DrawAttribute& a : schema::kDrawAttributes) {
      if (a.method == method) own.emplace_back(a.name);
    }
    if (own.size() == 1) return;  // an unknown method was reported
    for (std::size_t i = 1; i < own.size(); ++i) {
      if (e.attribute(own[i]) == nullptr)
        reading_.error(e, "<" + e.name + " method=\"" + method + "\"> needs the attribute '" + own[i] + "'");
    }
    for (const Element::Attribute& a : e.attributes) {
      if (std::find(own.begin(), own.end(), a.name) != own.end()) continue;
      reading_.unread(e, a.name,
                      "method=\"" + method + "\" has no such attribute; it takes: " +
                          listed({own.begin() + 1, own.end()}) + did_you_mean(a.name, own));
    }
  }

  void check_draw_values(const Element& e, const schema::Draw& draw, Distribution& d) {
    static constexpr std::array<std::string_view, 3> kOrdinal = {"first", "second", "third"};
    for (std::size_t i = 0; i < 3; ++i) {
      if (d.method == Distribution::Method::Uniform && draw.min[i] > draw.max[i])
        reading_.error(e, "min", "above max in its " + std::string(kOrdinal[i]) + " number");
      if (d.method == Distribution::Method::Gaussian && draw.std_dev[i] < 0.0)
        reading_.error(e, "std_dev", "negative in its " + std::string(kOrdinal[i]) + " number");
      const double n = draw.layout[i];
      if (n >= 1.0 && n <= 1e6 && n == std::floor(n))
        d.layout[i] = static_cast<int>(n);
      else
        reading_.error(e, "layout", "its " + std::string(kOrdinal[i]) + " number must be whole and from 1 to 1000000");
    }
  }

  // --- things ---

  ObjectItem box(Element& e, const Distribute* distribute) {
    const auto b = reading_.read<schema::Box>(e);
    check_lengths(e, b.size);
    return {ShapeKind::Box, b.id, b.size, b.movable, b.mass_kg, body(e, distribute), {}, e.line};
  }

  ObjectItem cylinder(Element& e, const Distribute* distribute) {
    const auto c = reading_.read<schema::Cylinder>(e);
    return {ShapeKind::Cylinder,
            c.id,
            {c.radius_m, c.radius_m, c.height_m},
            c.movable,
            c.mass_kg,
            body(e, distribute),
            {},
            e.line};
  }

  void object(ObjectItem item, Element& e, const Distribute* distribute) {
    if (item.movable) check_movable(e);
    if (distribute != nullptr) item.distribute = *distribute;
    reading_.once(e, "leds", [&](Element& c) { leds(c, item); });
    out_.objects.push_back(std::move(item));
  }

  void leds(Element& e, ObjectItem& item) {
    item.led_medium = reading_.read<schema::Leds>(e).medium;
    item.led_line = e.line;
    for (Element& c : e.children) {
      if (c.name != schema::Led::kElement.name) continue;
      const auto l = reading_.read<schema::Led>(c);
      LedItem led;
      led.p_O = l.offset;
      read_color(c, l.color, led.rgb);
      if (inside(item, l.offset))
        reading_.warn(c, "the LED lies inside its <" + std::string(item.shape == ShapeKind::Box ? "box" : "cylinder") +
                             ">, where no camera sees it; offset is from the middle of the base");
      item.leds.push_back(led);
    }
  }

  void read_color(const Element& e, const std::string& text, std::array<std::uint8_t, 3>& rgb) {
    if (const auto color = hal::parse_color(text))
      rgb = {color->r, color->g, color->b};
    else
      reading_.error(e, "color", "'" + text + "' is neither a colour's name nor \"r,g,b\"");
  }

  /// Whether a point is deep in the object, from the middle of its base.
  static bool inside(const ObjectItem& item, const Vec3& p) {
    constexpr double kDeep_m = 0.002;
    if (p[2] < kDeep_m || p[2] > item.size[2] - kDeep_m) return false;
    if (item.shape == ShapeKind::Cylinder) return std::hypot(p[0], p[1]) < item.size[0] - kDeep_m;
    return std::fabs(p[0]) < 0.5 * item.size[0] - kDeep_m && std::fabs(p[1]) < 0.5 * item.size[1] - kDeep_m;
  }

  /// Objects need an engine with forces.
  void check_movable(const Element& e) {
    std::string kinds;
    for (const EngineConfig& engine : out_.engines) {
      const KnownEngine* known = reading_.known().engine(engine.kind);
      if (known == nullptr || known->traits.forces) return;  // an unknown one is a problem of its own
      if (kinds.find(engine.kind) == std::string::npos) kinds += (kinds.empty() ? "" : " and ") + engine.kind;
    }
    const auto moves = [](const EngineTraits& traits) { return traits.forces; };
    reading_.error(e, "movable",
                   kinds + (kinds.find(' ') == std::string::npos ? " moves" : " move") +
                       " no objects; use one of the engines that do (" + engines_that(reading_.known().catalog, moves) +
                       "), or say movable=\"false\"");
  }

  void light(Element& e, const Distribute* distribute) {
    const bool positioned = e.attribute("position") != nullptr;
    const auto l = reading_.read<schema::Light>(e);
    LightItem item;
    item.id = l.id;
    item.p_W = l.position;
    item.intensity = l.intensity;
    item.medium = l.medium;
    item.line = e.line;
    read_color(e, l.color, item.rgb);
    if (distribute != nullptr)
      item.distribute = *distribute;
    else if (!positioned)
      reading_.error(e, "<light> needs the attribute 'position'");
    out_.lights.push_back(std::move(item));
  }

  void sound(Element& e) {
    const auto s = reading_.read<schema::Sound>(e);
    out_.sounds.push_back({s.id, s.position, s.level, e.line});
  }

  // --- robots ---

  /// The id, and what the element says of the robot's parts: a kind of its own in `item`, where that is anything new.
  void attributes_of_robot(Element& e, RobotItem& item) {
    const auto* const kind = reading_.catalog().find<hal::RobotKind>(e.name);
    auto own = std::make_shared<hal::RobotKind>(*kind);
    const std::string usual = attributes_of(*own);
    if (e.argos && e.child("controller") != nullptr && e.child("bridge") == nullptr) add_extras(item, *own);
    if (e.argos && own->drive() != nullptr && e.child("bridge") == nullptr) lift_limit(e, *own);
    item.id = reading_.read(e, schema::RobotOfKind{{}, *own}).id;
    const auto* const board = own->part<hal::RangeAndBearingPart>();
    if (e.child("bridge") != nullptr && board != nullptr && board->payload > std::int64_t{hal::kRabPayloadMax})
      reading_.error(e, "rab_data_size",
                     "real robots send messages of " + std::to_string(hal::kRabPayloadMax) +
                         " bytes at most: leave out the <bridge>, or more bytes");
    const std::string said = attributes_of(*own);
    const auto* const fitted = reading_.fitted(e.name);
    if (fitted != nullptr) {
      for (const hal::AnyPart& part : *fitted) replace(*own, part);
    }
    if (said != usual || fitted != nullptr)
      item.own_kind = own_kinds_.try_emplace(e.name + said, std::move(own)).first->second;
  }

  /// Parts that robots of the kind may have besides, and that the configuration of its controller means.
  void add_extras(const RobotItem& item, hal::RobotKind& kind) {
    if (item.controller >= out_.controllers.size()) return;
    const ControllerConfig& config = out_.controllers[item.controller];
    for (const std::vector<DeviceChoice>* choices : {&config.sensors, &config.actuators}) {
      for (const DeviceChoice& choice : *choices) {
        for (const std::string& device : {choice.device, choice.options.name}) {
          const auto* const extra = reading_.catalog().find<hal::ExtraPart>(hal::ExtraPart::entry(kind.name, device));
          if (extra != nullptr) replace(kind, extra->make());
        }
      }
    }
  }

  static void replace(hal::RobotKind& kind, const hal::AnyPart& part) {
    kind.remove(part.name());
    kind.add(part);
  }

  /// ARGoS limits no wheel.
  void lift_limit(const Element& e, hal::RobotKind& kind) {
    const double most_m_s = std::exchange(std::get<hal::DifferentialDrive>(kind.locomotion).max_speed_m_s,
                                          hal::DifferentialDrive::kNoLimit_m_s);
    if (e.attribute("max_speed") != nullptr || !unlimited_.insert(kind.name).second) return;
    const std::string most = hal::format_quantity(most_m_s, hal::unit::cm_s);
    reading_.warn(e, "the wheels of <" + e.name + "> have no limit, as in ARGoS; those of a real one turn with " +
                         most + " at most: max_speed=\"" + most + "\" limits these, too");
  }

  static std::string attributes_of(hal::RobotKind& kind) {
    Element e;
    ElementWriter writer(e);
    kind.attributes(writer);
    std::string text;
    for (const auto& a : e.attributes) text += ' ' + a.name + '=' + a.value;
    return text;
  }

  void robot(Element& e, const Distribute* distribute) {
    RobotItem item;
    reading_.once(e, "controller", [&](Element& c) { controller(c, item); });
    attributes_of_robot(e, item);
    item.kind = e.name;
    item.line = e.line;
    item.placement = body(e, distribute);
    if (distribute != nullptr) item.distribute = *distribute;
    if (e.child("controller") == nullptr) reading_.error(e, "<" + e.name + "> needs a <controller config=\"…\"/>");
    reading_.once_or_default(e, "battery", [&](Element& c) { item.battery = battery(c); });
    reading_.once(e, "bridge", [&](Element& c) {
      std::shared_ptr<const void> own;
      const auto* const options = reading_.catalog().find<hal::ElementOptions>("bridge of " + bridged_as(out_, e.name));
      const auto b = reading_.read_with<schema::Bridge>(c, [&](hal::ParamVisitor& v) {
        if (options == nullptr) return;
        auto read = options->read(v);
        if (own == nullptr) own = std::move(read);
      });
      item.bridge = BridgeConfig{b.link, b.timeout_s, c, c.line, std::move(own)};
      item.bridge->rearm = b.rearm;
      item.bridge->settle_s = b.settle_s;
      item.bridge->ramp_m_s2 = b.ramp_m_s2;
      item.bridge->if_missing = b.missing == "simulate" ? IfMissing::Simulate
                                : b.missing == "wait"   ? IfMissing::Wait
                                                        : IfMissing::Refuse;
      item.bridge->connect_s = b.connect_s;
      item.bridge->stop_s = b.stop_s;
      if (distribute != nullptr) reading_.error(c, "a <bridge> stands for one real robot; it cannot be distributed");
    });
    reading_.once(e, "tracker", [&](Element& c) {
      const auto t = reading_.read<schema::Tracker>(c);
      item.tracker = TrackerConfig{t.source, c, c.line, words(t.id), t.turn_rad, t.lost_m, t.offset, {}};
      if (t.height_m >= 0.0) item.tracker->tag_m = t.height_m;
    });
    reading_.once(e, "peer", [&](Element& c) {
      item.peer = PeerConfig{reading_.read<schema::Peer>(c).link, c.line};
      if (distribute != nullptr && !item.peer->link.empty() && !item.peer->link.starts_with("emulated"))
        reading_.error(c, "link", "'" + item.peer->link + "' leads to one peer; distributed robots leave it out");
    });
    out_.robots.push_back(std::move(item));
  }

  void controller(Element& e, RobotItem& item) {
    const auto attributes = reading_.read<schema::RobotController>(e);
    const auto found = controllers_.find(attributes.config);
    if (found == controllers_.end()) {
      std::vector<std::string> ids;
      for (const auto& [id, index] : controllers_) ids.push_back(id);
      if (!attributes.config.empty()) {
        reading_.error(e, "config",
                       "there is no controller with id '" + attributes.config + "'; there are: " + listed(ids) +
                           did_you_mean(attributes.config, ids));
      }
      return;
    }
    item.controller = found->second;
    reading_.once(e, "params", [&](const Element& params) {
      // ARGoS takes a robot's own instead of the configuration's.
      item.params = params.argos ? params : overridden(out_.controllers[item.controller].params, params);
    });
  }

  /// The configuration's parameters with the robot's own in their place.
  static Element overridden(const Element& base, const Element& own) {
    Element merged = own;
    for (const Element::Attribute& a : base.attributes) {
      if (own.attribute(a.name) == nullptr) merged.attributes.push_back(a);
    }
    for (const Element& c : base.children) {
      if (own.child(c.name) == nullptr) merged.children.push_back(c);
    }
    return merged;
  }

  BatteryConfig battery(Element& e) {
    const auto b = reading_.read<schema::Battery>(e);
    BatteryConfig config = b.c;
    if (b.time_factor > 0.0) config.delta = b.time_factor;
    if (b.pos_factor > 0.0) config.pos_delta = b.pos_factor;
    if (b.orient_factor > 0.0) config.orient_delta = b.orient_factor;
    if (config.start_charge > config.full_charge) reading_.error(e, "start_charge", "above full_charge");
    return config;
  }

  Reading& reading_;
  Scenario& out_;
  std::map<std::string, std::size_t> controllers_;                          // by id
  std::map<std::string, std::shared_ptr<const hal::RobotKind>> own_kinds_;  // by what elements say
  std::set<std::string> unlimited_;                                         // kinds that a warning has named
  int distributes_ = 0;
};

}  // namespace

void read_arena(Reading& reading, Element& arena) {
  ArenaReader(reading).arena(arena);
}

void read_trackers(Reading& reading, Element& trackers) {
  reading.read<schema::Trackers>(trackers);
  for (Element& e : trackers.children) {
    const auto* const options = reading.catalog().find<hal::ElementOptions>("tracker of " + e.name);
    std::shared_ptr<const void> own;
    const auto t = reading.read_with<schema::TrackerElement>(e, [&](hal::ParamVisitor& v) {
      if (options == nullptr) return;
      auto read = options->read(v);
      if (own == nullptr) own = std::move(read);
    });
    TrackerItem item{e.name,
                     t.id.empty() ? e.name : t.id,
                     t.clock,
                     t.latency_s,
                     t.sd_m,
                     t.sd_rad,
                     t.origin,
                     t.turn_rad,
                     e,
                     e.line,
                     std::move(own)};
    for (const TrackerItem& other : reading.out().trackers) {
      if (other.id == item.id)
        reading.error(e, "id",
                      "a second tracker '" + item.id + "'; the first is on line " + std::to_string(other.line));
    }
    reading.out().trackers.push_back(std::move(item));
  }
}

void read_desk(Reading& reading, Element& desk) {
  const auto d = reading.read<schema::Desk>(desk);
  DeskConfig& out = reading.out().desk;
  out = {d.lcm, d.channel, d.hold, {}};
  constexpr std::size_t kLongestChannel = 57;  // LCM has 63 characters, and answers go to CHANNEL/reply
  if (d.channel.empty() || d.channel.size() > kLongestChannel)
    reading.error(desk, "channel", "a channel has 1 to 57 characters");
  for (Element& e : desk.children) {
    if (e.name != schema::Spare::kElement.name) continue;
    const auto s = reading.read<schema::Spare>(e);
    const auto taken = [&](const auto& other) { return other.id == s.id && !s.id.empty(); };
    const auto& robots = reading.out().robots;
    if (std::any_of(out.spares.begin(), out.spares.end(), taken) || std::any_of(robots.begin(), robots.end(), taken))
      reading.error(e, "id", "'" + s.id + "' is the id of another robot already");
    for (const SpareItem& other : out.spares) {
      if (other.link == s.link)
        reading.error(e, "link", "the spare '" + other.id + "' on line " + std::to_string(other.line) + " is there");
    }
    for (const RobotItem& robot : robots) {
      if (robot.bridge && robot.bridge->link == s.link)
        reading.error(e, "link", "the robot '" + robot.id + "' on line " + std::to_string(robot.line) + " is there");
    }
    out.spares.push_back({s.id, s.link, words(s.seen_as), e.line});
  }
}

}  // namespace tandem::core
