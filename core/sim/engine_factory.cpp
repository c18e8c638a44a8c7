#include "core/sim/engine_factory.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/physics/engine.hpp"
#include "core/scenario/split.hpp"
#include "hal/rounded.hpp"

namespace tandem::core {
namespace {

// Arenas are split by default, since one Box2D world with 10,000 robots runs on one thread and slower than sixteen
// worlds do there. Results of engines with forces then differ in detail from those of one solver (`regions="1x1"`).
constexpr double kRobotsPerPart = 600.0;    // where a solver's data still fit the second-level cache
constexpr double kNarrowestPart_m = 4.0;    // narrower ones spend their time on bodies mirrored across borders
constexpr std::size_t kMostPartsASide = 8;  // … of a split chosen here
constexpr std::size_t kMostParts = 4096;    // of one that the file says

/// From the load alone, so that results are the same on any machine.
Split split_for(std::size_t robots, double width_m, double depth_m) {
  const auto along = [&](double length_m) {
    const double wanted = std::ceil(std::sqrt(static_cast<double>(robots) / kRobotsPerPart));
    const double room = std::max(1.0, std::floor(length_m / kNarrowestPart_m));
    return static_cast<std::size_t>(std::clamp(std::min(wanted, room), 1.0, static_cast<double>(kMostPartsASide)));
  };
  return {along(width_m), along(depth_m)};
}

Split split_of(const EngineConfig& config, std::size_t robots, const SpaceStores& stores) {
  if (const auto split = parse_split(config.regions)) return *split;
  return split_for(robots, stores.max_x_m - stores.min_x_m, stores.max_y_m - stores.min_y_m);
}

double cross(const RegionSide& a, const RegionSide& b, const RegionSide& c) {
  return (b.x_m - a.x_m) * (c.y_m - a.y_m) - (b.y_m - a.y_m) * (c.x_m - a.x_m);
}

/// A point inside an outline: near the middle of its first corner that is no dent.
std::pair<double, double> point_within(const Region& region) {
  const std::size_t n = region.sides.size();
  for (std::size_t i = 0; i < n; ++i) {
    const RegionSide& a = region.sides[i];
    const RegionSide& b = region.sides[(i + 1) % n];
    const RegionSide& c = region.sides[(i + 2) % n];
    if (cross(a, b, c) <= 0.0) continue;
    // Towards the corner b until nothing of the outline lies between.
    for (double t = 1.0; t > 1e-6; t *= 0.5) {
      const double x = b.x_m + t * ((a.x_m + b.x_m + c.x_m) / 3 - b.x_m);
      const double y = b.y_m + t * ((a.y_m + b.y_m + c.y_m) / 3 - b.y_m);
      if (region.contains(x, y)) return {x, y};
    }
  }
  return {region.sides[0].x_m, region.sides[0].y_m};
}

/// Where along the side from a to b, as shares of it, the outline of `other` touches or crosses it; with 0 and 1.
std::vector<double> cuts_of(const RegionSide& a, const RegionSide& b, const Region& other) {
  std::vector<double> cuts{0.0, 1.0};
  const double dx = b.x_m - a.x_m;
  const double dy = b.y_m - a.y_m;
  for (std::size_t k = 0; k < other.sides.size(); ++k) {
    const RegionSide& c = other.sides[k];
    const RegionSide& d = other.sides[(k + 1) % other.sides.size()];
    const double a_side = cross(c, d, a);
    const double b_side = cross(c, d, b);
    if (a_side != b_side) cuts.push_back(a_side / (a_side - b_side));                     // where it meets c-d
    cuts.push_back(((c.x_m - a.x_m) * dx + (c.y_m - a.y_m) * dy) / (dx * dx + dy * dy));  // where c lies beside it
  }
  std::erase_if(cuts, [](double t) { return !(t >= 0.0 && t <= 1.0); });
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// Where two outlines share more than their border, if they do. What two regions share is bounded by pieces of their
/// sides, and next to such a piece, inwards, lies a point of both.
std::optional<std::pair<double, double>> overlap(const Region& one, const Region& other) {
  constexpr double kInwards_m = 1e-6;
  constexpr double kShortest_m = 1e-5;  // pieces shorter than this are where corners meet, rounded
  if (one.top_m <= other.bottom_m || other.top_m <= one.bottom_m) return std::nullopt;
  if (one.everywhere()) return other.everywhere() ? std::pair{0.0, 0.0} : point_within(other);
  if (other.everywhere()) return point_within(one);
  for (const auto& [of, in] : {std::pair{&one, &other}, std::pair{&other, &one}}) {
    for (std::size_t i = 0; i < of->sides.size(); ++i) {
      const RegionSide& a = of->sides[i];
      const RegionSide& b = of->sides[(i + 1) % of->sides.size()];
      const double length = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
      const std::vector<double> cuts = cuts_of(a, b, *in);
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        if ((cuts[k + 1] - cuts[k]) * length < kShortest_m) continue;
        const double t = 0.5 * (cuts[k] + cuts[k + 1]);
        const double x = a.x_m + t * (b.x_m - a.x_m) - (b.y_m - a.y_m) / length * kInwards_m;
        const double y = a.y_m + t * (b.y_m - a.y_m) + (b.x_m - a.x_m) / length * kInwards_m;
        if (of->contains(x, y) && in->contains(x, y)) return std::pair{x, y};
      }
    }
  }
  return std::nullopt;
}

class Maker {
 public:
  Maker(const Scenario& scenario, const hal::Catalog& catalog, std::size_t robots, SpaceStores& stores,
        Problems& problems)
      : scenario_(scenario), catalog_(catalog), robots_(robots), stores_(stores), problems_(problems) {}

  std::vector<std::unique_ptr<Engine>> make() {
    const std::size_t before = problems_.size();
    stores_.regions.clear();
    if (configs_.empty()) {
      EngineConfig usual;
      const auto engines = catalog_.all<EngineType>();
      if (!engines.empty()) usual.kind = usual.id = engines.front()->kind;
      configs_.push_back(usual);
    }
    for (std::size_t i = 0; i < configs_.size(); ++i) add(configs_[i], i);
    if (stores_.regions.size() >= kNoRegion) problem(configs_.front().line, "more than 65534 regions");
    if (!has_errors(problems_, before)) check_overlaps();
    if (!has_errors(problems_, before)) {
      part_air_from_ground();
      open_gates();
    }
    if (!has_errors(problems_, before)) make_engines();
    return std::move(engines_);
  }

 private:
  void problem(int line, std::string message) {
    problems_.push_back({scenario_.file, line, std::move(message), false});
  }

  void add(const EngineConfig& config, std::size_t number) {
    const EngineType* type = catalog_.find<EngineType>(config.kind);
    if (type == nullptr) {
      problem(config.line,
              "unknown physics engine '" + config.kind + "'; known: " + listed(catalog_.names(EngineType::kCategory)));
      return;
    }
    Region region;
    region.air = type->traits.air;
    region.plane = type->traits.plane;
    region.forces = type->traits.forces;
    region.joints = type->traits.joints;
    region.listed = !type->whole;
    params_[number] = type->read(config.options, problems_);
    if (type->gravity != nullptr) region.gravity_m_s2 = type->gravity(params_[number].get());
    add_regions(config, number, region, !type->whole);
  }

  /// `splits`: whether a split of the arena makes any difference to the engine.
  void add_regions(const EngineConfig& config, std::size_t number, Region region, bool splits) {
    region.engine = number;
    region.name = config.id;
    region.line = config.line;
    if (config.bottom_m) region.bottom_m = *config.bottom_m;
    if (config.top_m) region.top_m = *config.top_m;
    if (!config.sides.empty()) {
      if (!config.regions.empty()) {
        problem(config.line, "<" + config.kind + " id=\"" + config.id + "\">: regions=\"" + config.regions +
                                 "\" splits the whole arena, so it cannot stand beside <sides>; give several engines");
        return;
      }
      for (const BoundarySide& side : config.sides) region.sides.push_back({side.x_m, side.y_m, false, kNoRegion});
      stores_.regions.push_back(std::move(region));
      return;
    }
    const Split split = splits ? split_of(config, robots_, stores_) : Split{};
    if (split.columns * split.lines > kMostParts) {
      problem(config.line, "regions=\"" + config.regions + "\" are more than " + std::to_string(kMostParts) + " parts");
      return;
    }
    if (split.columns * split.lines == 1) {
      stores_.regions.push_back(std::move(region));
      return;
    }
    const double width = stores_.max_x_m - stores_.min_x_m;
    const double depth = stores_.max_y_m - stores_.min_y_m;
    const auto x_at = [&](std::size_t column) {
      return column == split.columns
                 ? stores_.max_x_m
                 : stores_.min_x_m + width * static_cast<double>(column) / static_cast<double>(split.columns);
    };
    const auto y_at = [&](std::size_t line) {
      return line == split.lines
                 ? stores_.max_y_m
                 : stores_.min_y_m + depth * static_cast<double>(line) / static_cast<double>(split.lines);
    };
    for (std::size_t line = 0; line < split.lines; ++line) {
      for (std::size_t column = 0; column < split.columns; ++column) {
        Region part = region;
        part.name += "[" + std::to_string(column) + "," + std::to_string(line) + "]";
        // Parts at the arena's edge reach beyond it: what lies there has left the arena, not its region.
        const double west = column == 0 ? x_at(0) - width : x_at(column);
        const double east = column + 1 == split.columns ? x_at(split.columns) + width : x_at(column + 1);
        const double south = line == 0 ? y_at(0) - depth : y_at(line);
        const double north = line + 1 == split.lines ? y_at(split.lines) + depth : y_at(line + 1);
        part.sides = {{west, south}, {east, south}, {east, north}, {west, north}};
        stores_.regions.push_back(std::move(part));
      }
    }
  }

  void check_overlaps() {
    for (Region& region : stores_.regions) region.close();
    for (std::size_t i = 0; i < stores_.regions.size(); ++i) {
      const Region& one = stores_.regions[i];
      for (std::size_t k = 0; k < i; ++k) {
        const Region& other = stores_.regions[k];
        if (one.engine == other.engine || one.air != other.air) continue;
        const auto where = overlap(one, other);
        if (!where) continue;
        problem(one.line, "the region of engine '" + one.name + "' overlaps that of engine '" + other.name +
                              "' (line " + std::to_string(other.line) + "), as at " +
                              hal::place_text(where->first, where->second) +
                              "; every place belongs to one engine: give each its <boundaries>");
        return;
      }
    }
  }

  /// Regions for robots that fly are a world of their own where they lie over others. Where they lie beside them, they
  /// are regions like all, and robots on the ground meet across the border.
  void part_air_from_ground() {
    for (const Region& one : stores_.regions) {
      for (const Region& other : stores_.regions) {
        if (one.air && !other.air && overlap(one, other)) return;
      }
    }
    for (Region& region : stores_.regions) region.air = false;
  }

  std::uint16_t region_of_engine(const std::string& id) const {
    std::uint16_t found = kNoRegion;
    for (std::size_t i = 0; i < stores_.regions.size(); ++i) {
      const Region& region = stores_.regions[i];
      if (configs_[region.engine].id != id) continue;
      if (found != kNoRegion) return kNoRegion;  // several parts: whichever lies behind
      found = static_cast<std::uint16_t>(i);
    }
    return found;
  }

  /// Sides of a file that names gates are walls but for these. In a file that names none, as ARGoS 3's do not, sides
  /// are open where another engine's region lies behind.
  void open_gates() {
    bool named = false;
    for (const EngineConfig& config : configs_) {
      for (const BoundarySide& side : config.sides) named = named || !side.gate.empty();
    }
    for (Region& region : stores_.regions) {
      if (region.everywhere()) continue;
      const EngineConfig& config = configs_[region.engine];
      if (config.sides.empty()) continue;  // a part of a split: open all around
      for (std::size_t i = 0; i < region.sides.size(); ++i) {
        RegionSide& side = region.sides[i];
        if (!named) {
          side.wall = !something_behind(region, i);
          continue;
        }
        const std::string& gate = gate_of(config, side, region.sides[(i + 1) % region.sides.size()]);
        side.wall = gate.empty();
        if (!gate.empty()) side.gate = region_of_engine(gate);
      }
    }
  }

  /// The gate of the file's side between these two corners, whichever way round the file goes.
  static const std::string& gate_of(const EngineConfig& config, const RegionSide& a, const RegionSide& b) {
    static const std::string kNone;
    const auto at = [](const BoundarySide& s, const RegionSide& r) { return s.x_m == r.x_m && s.y_m == r.y_m; };
    for (std::size_t i = 0; i < config.sides.size(); ++i) {
      const BoundarySide& from = config.sides[i];
      const BoundarySide& to = config.sides[(i + 1) % config.sides.size()];
      if ((at(from, a) && at(to, b)) || (at(from, b) && at(to, a))) return from.gate;
    }
    return kNone;
  }

  bool something_behind(const Region& region, std::size_t i) const {
    constexpr int kSamples = 64;
    constexpr double kBehind_m = 1e-3;
    const RegionSide& a = region.sides[i];
    const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
    const double dx = b.x_m - a.x_m;
    const double dy = b.y_m - a.y_m;
    const double length = std::hypot(dx, dy);
    for (int k = 0; k < kSamples; ++k) {
      const double t = (k + 0.5) / kSamples;
      const double x = a.x_m + t * dx + dy / length * kBehind_m;  // to the right of the side: outside
      const double y = a.y_m + t * dy - dx / length * kBehind_m;
      for (const Region& other : stores_.regions) {
        if (&other != &region && other.air == region.air && other.contains(x, y)) return true;
      }
    }
    return false;
  }

  void make_engines() {
    const double tick_s = 1.0 / static_cast<double>(scenario_.ticks_per_second);
    for (const EngineType* type : catalog_.all<EngineType>()) {
      EngineOrder order{{}, stores_, tick_s, scenario_.file, problems_};
      for (std::size_t i = 0; i < stores_.regions.size(); ++i) {
        const std::size_t number = stores_.regions[i].engine;
        if (configs_[number].kind == type->kind) order.parts.push_back({i, params_[number], configs_[number].line});
      }
      if (!order.parts.empty()) engines_.push_back(type->make(*type, order));
    }
  }

  const Scenario& scenario_;
  std::vector<EngineConfig> configs_ = scenario_.engines;
  const hal::Catalog& catalog_;
  std::size_t robots_;
  SpaceStores& stores_;
  Problems& problems_;
  std::map<std::size_t, std::shared_ptr<const void>> params_;  // by number of the engine
  std::vector<std::unique_ptr<Engine>> engines_;
};

}  // namespace

std::string lacks_joints(const hal::Catalog& catalog, const Region& region, JointKinds needed) {
  if ((region.joints & needed) == needed) return "";
  return "its engine '" + region.name + "' has " +
         (region.joints == 0 ? "no joints" : "only " + words_of(region.joints) + " joints") + ", but " +
         words_of(needed) + " ones are needed; use " +
         engines_that(catalog, [needed](const EngineTraits& traits) { return traits.has(needed); });
}

std::string unfit_for(const hal::Catalog& catalog, std::string_view kind, const Object& object) {
  const auto* const type = catalog.find<EngineType>(kind);
  return type == nullptr || type->unfit == nullptr ? "" : type->unfit(object);
}

std::vector<std::unique_ptr<Engine>> make_engines(const Scenario& scenario, const hal::Catalog& catalog,
                                                  std::size_t robots, SpaceStores& stores, Problems& problems) {
  return Maker(scenario, catalog, robots, stores, problems).make();
}

}  // namespace tandem::core
