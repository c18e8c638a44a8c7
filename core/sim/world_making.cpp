// Makes a steppable world from a scenario.
#include <algorithm>
#include <cmath>
#include <random>
#include <system_error>
#include <utility>

#include "core/medium/led/led.hpp"
#include "core/placement/placement.hpp"
#include "core/scenario/field_type.hpp"
#include "core/sim/device_media.hpp"
#include "core/sim/engine_factory.hpp"
#include "core/sim/settings.hpp"
#include "core/sim/world_impl.hpp"
#include "core/space/attitude.hpp"
#include "hal/rounded.hpp"
#include "hal/vector.hpp"

namespace tandem::core {
namespace {

std::uint64_t seed_from_clock() {
  std::random_device device;
  return (static_cast<std::uint64_t>(device()) << 32 | device()) >> 11;  // exact as a double, easy to write in a file
}

std::uint16_t led_medium(const Scenario& scenario, const std::string& id) {
  const auto number = medium_number(scenario.media, LedMedium::kKind, id);
  return number.ok() ? number.value() : std::uint16_t{0};
}

Object object_of(const Scenario& scenario, const ObjectItem& item, const PlacedObject& placed) {
  Object shape;
  shape.kind = item.shape == ShapeKind::Box ? Object::Kind::Box : Object::Kind::Cylinder;
  shape.id = placed.number < 0 ? item.id : item.id + std::to_string(placed.number);
  shape.x_m = placed.p_W[0];
  shape.y_m = placed.p_W[1];
  shape.cos_h = std::cos(placed.yaw_rad);
  shape.sin_h = std::sin(placed.yaw_rad);
  shape.half_x_m = 0.5 * item.size[0];
  shape.half_y_m = 0.5 * item.size[1];
  shape.radius_m = item.size[0];
  shape.z_low_m = placed.p_W[2];
  shape.z_high_m = placed.p_W[2] + item.size[2];
  if (const hal::Quaternion& q = placed.q_WB; leans(hal::array_of(q))) {
    // It turns about the middle of its base, as in ARGoS; its place is that of its middle.
    const hal::Vector3 up = q * hal::Vector3(0.0, 0.0, 0.5 * item.size[2]);
    const hal::Vector3 ahead = q * hal::Vector3(1.0, 0.0, 0.0);
    shape.x_m += up.x();
    shape.y_m += up.y();
    shape.z_low_m += up.z() - 0.5 * item.size[2];
    shape.z_high_m = shape.z_low_m + item.size[2];
    const double level = std::hypot(ahead.x(), ahead.y());
    shape.cos_h = level > 1e-9 ? ahead.x() / level : 1.0;
    shape.sin_h = level > 1e-9 ? ahead.y() / level : 0.0;
  }
  shape.movable = item.movable;
  shape.mass_kg = item.mass_kg;
  const std::uint16_t medium = led_medium(scenario, item.led_medium);
  for (const LedItem& led : item.leds)
    shape.leds.push_back({led.p_O[0], led.p_O[1], led.p_O[2], {led.rgb[0], led.rgb[1], led.rgb[2]}, medium});
  return shape;
}

BodySize size_of_kind(const Scenario& scenario, const hal::Catalog& catalog, const std::string& name) {
  const hal::RobotKind* kind = find_kind(scenario, catalog, name);
  return kind != nullptr ? BodySize{kind->body.radius_m, kind->body.height_m, kind->flies()} : BodySize{};
}

/// Some devices work by joints: robots whose controller takes one need an engine that has them. One problem an item.
void check_joints(const Scenario& scenario, const hal::Catalog& catalog, const SpaceStores& s, Problems& problems) {
  std::uint32_t complained = 0xFFFFFFFFU;
  std::vector<bool> usable;  // by group: anywhere
  for (const RobotGroup& group : s.groups) usable.push_back(device_without_joints(group, 0) == nullptr);
  for (const RobotEntity& e : s.robots) {
    const RobotBlock& block = s.blocks[e.block];
    const std::uint16_t region = s.bodies.region[block.first_row + e.slot];
    if (usable[block.group] || region == kNoRegion || e.item == complained) continue;
    const DeviceType* device = device_without_joints(s.groups[block.group], s.regions[region].joints);
    if (device == nullptr) continue;
    complained = e.item;
    const std::string name = s.names[e.item].prefix + (e.number < 0 ? "" : std::to_string(e.number));
    problems.push_back({scenario.file, scenario.robots[e.item].line,
                        "robot '" + name + "' has a " + std::string(device->device) + ", but " +
                            lacks_joints(catalog, s.regions[region], device->joints),
                        false});
  }
}

/// What engines of the plane leave out of a place: its height, and tilts.
void warn_of_upright(const Scenario& scenario, const Region& region, int line, const std::string& who,
                     const Placement& placement, bool tilts, Problems& problems) {
  const auto warn = [&](const std::string& what) {
    problems.push_back({scenario.file, line,
                        who + " " + what + ", but its engine '" + region.name +
                            "' knows the plane alone: it stands upright on the ground",
                        true});
  };
  if (placement.p_W[2] > 0.0) warn("is " + hal::rounded(placement.p_W[2]) + " m above the ground");
  if (tilts && (placement.pitch_rad != 0.0 || placement.roll_rad != 0.0)) warn("is tilted");
}

/// Bodies that turn in space need an engine that knows it, wherever they are.
void refuse_to_lean(const Scenario& scenario, const SpaceStores& s, std::size_t number, const ObjectItem& item,
                    Problems& problems) {
  const Object& o = s.objects[number];
  for (std::size_t i = 0; i < s.regions.size(); ++i) {
    const Region& region = s.regions[i];
    const bool there = o.movable ? s.object_region[number] == i : region.touches(o, s.border_reach_m);
    if (!there || (region.forces && !region.plane)) continue;
    problems.push_back(
        {scenario.file, item.line,
         "'" + item.id + "' is tilted, but its engine '" + region.name +
             "' knows upright boxes and cylinders alone; use one of space and forces there, or an orientation of "
             "the form \"angle,0,0\"",
         false});
    return;
  }
}

/// One warning an item.
void check_upright(const Scenario& scenario, const Placements& placements, const SpaceStores& s, Problems& problems) {
  std::uint32_t told = 0xFFFFFFFFU;
  for (const RobotEntity& e : s.robots) {
    const std::uint16_t region = s.bodies.region[s.blocks[e.block].first_row + e.slot];
    const RobotItem& item = scenario.robots[e.item];
    if (e.item == told || item.distribute || region == kNoRegion || !s.regions[region].plane) continue;
    told = e.item;
    warn_of_upright(scenario, s.regions[region], item.line, "robot '" + item.id + "'", item.placement, true, problems);
  }
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    const ObjectItem& item = scenario.objects[placements.objects[i].item];
    const std::uint16_t region = s.object_region[i];
    if (leans(s.object_motion[i].q_WB)) refuse_to_lean(scenario, s, i, item, problems);
    if (!s.objects[i].movable || item.distribute || region == kNoRegion || !s.regions[region].plane) continue;
    warn_of_upright(scenario, s.regions[region], item.line, "'" + item.id + "'", item.placement, false, problems);
  }
}

/// How wide the narrowest strip is that lets an object through, in m.
double narrowest_width_m(const Object& object) {
  return 2.0 * (object.kind == Object::Kind::Box ? std::min(object.half_x_m, object.half_y_m) : object.radius_m);
}

/// What keeps a body of this width from fitting into the region: the arena, or walls on all sides. Empty: nothing.
std::string too_wide_for(const SpaceStores& s, const Region& region, double width_m) {
  const auto between = [](double x_m, double y_m) {
    return " (" + hal::rounded(x_m) + " m x " + hal::rounded(y_m) + " m)";
  };
  const double arena_x_m = s.max_x_m - s.min_x_m;
  const double arena_y_m = s.max_y_m - s.min_y_m;
  if (width_m > std::min(arena_x_m, arena_y_m)) return "is larger than the arena" + between(arena_x_m, arena_y_m);
  const bool walled = !region.everywhere() && std::all_of(region.sides.begin(), region.sides.end(),
                                                          [](const RegionSide& side) { return side.wall; });
  const double x_m = region.max_x_m - region.min_x_m;
  const double y_m = region.max_y_m - region.min_y_m;
  if (walled && width_m > std::min(x_m, y_m))
    return "does not fit into the region '" + region.name + "'" + between(x_m, y_m);
  return "";
}

/// Every body's region; robots and movable objects that lie in none, or are too large for theirs, are problems.
void assign_regions(const Scenario& scenario, const hal::Catalog& catalog, const Placements& placements,
                    const RegionAssigner& assigner, SpaceStores& s, Problems& problems) {
  constexpr std::size_t kShown = 20;
  std::size_t bad = 0;
  const auto complain = [&](int line, const std::string& who, double x_m, double y_m, const std::string& why) {
    if (++bad > kShown) return;
    problems.push_back({scenario.file, line, who + " at " + hal::place_text(x_m, y_m) + " " + why, false});
  };
  const bool any_solid = std::any_of(s.regions.begin(), s.regions.end(), [](const Region& r) { return !r.plane; });
  for (const RobotEntity& e : s.robots) {
    const std::size_t row = s.blocks[e.block].first_row + e.slot;
    s.bodies.region[row] = assigner.find(s, BodyKey::robot(row));
    std::string why;
    if (s.bodies.region[row] != kNoRegion) {
      why = too_wide_for(s, s.regions[s.bodies.region[row]], 2.0 * static_cast<double>(s.bodies.radius_m[row]));
      if (why.empty()) continue;
    }
    const std::string name = s.names[e.item].prefix + (e.number < 0 ? "" : std::to_string(e.number));
    const bool flies = s.groups[s.blocks[e.block].group].kind->flies();
    if (why.empty()) {
      why = flies && !any_solid ? "flies: it needs an engine of three dimensions: " +
                                      engines_that(catalog, [](const EngineTraits& traits) { return !traits.plane; })
                                : "lies in no engine's region";
    }
    complain(scenario.robots[e.item].line, "robot '" + name + "'", s.bodies.x_m[row], s.bodies.y_m[row], why);
  }
  check_joints(scenario, catalog, s, problems);
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    if (!s.objects[i].movable) continue;
    s.object_region[i] = assigner.find(s, BodyKey::object(i));
    std::string why = "lies in no region of an engine that moves objects; use " +
                      engines_that(catalog, [](const EngineTraits& traits) { return traits.forces; });
    if (s.object_region[i] != kNoRegion) {
      const Region& region = s.regions[s.object_region[i]];
      why = too_wide_for(s, region, narrowest_width_m(s.objects[i]));
      if (why.empty() && !scenario.engines.empty())
        why = unfit_for(catalog, scenario.engines[region.engine].kind, s.objects[i]);
      if (why.empty()) continue;
    }
    complain(scenario.objects[placements.objects[i].item].line,
             std::string(s.objects[i].kind == Object::Kind::Box ? "movable box '" : "movable cylinder '") +
                 s.objects[i].id + "'",
             s.objects[i].x_m, s.objects[i].y_m, why);
  }
  check_upright(scenario, placements, s, problems);
  if (bad > kShown)
    problems.push_back({scenario.file, 0,
                        "... and " + std::to_string(bad - kShown) + " more bodies in no region or too large for theirs",
                        false});
}

void name_hook_made(const void* config, std::size_t /*part*/, std::size_t /*index*/, hal::FixedText& out) noexcept {
  const auto& c = *static_cast<const HookConfig*>(config);
  out << "hook '" << c.label << "' (library '" << c.library << "'), while it was made,";
}

/// What is in the arena besides robots.
Things furnish(const Scenario& scenario, const Placements& placements) {
  Things all;
  for (const PlacedObject& placed : placements.objects)
    all.objects.push_back(object_of(scenario, scenario.objects[placed.item], placed));
  for (const PlacedLight& placed : placements.lights) {
    const LightItem& item = scenario.lights[placed.item];
    all.lights.push_back({placed.number < 0 ? item.id : item.id + std::to_string(placed.number),
                          placed.p_W[0],
                          placed.p_W[1],
                          placed.p_W[2],
                          item.intensity,
                          {item.rgb[0], item.rgb[1], item.rgb[2]},
                          true,
                          led_medium(scenario, item.medium)});
  }
  for (const SoundItem& item : scenario.sounds)
    all.sounds.push_back({item.id, item.p_W[0], item.p_W[1], item.p_W[2], item.level});
  return all;
}

/// Ids: entities in the order of the file.
std::vector<RobotRequest> name_robots(const Scenario& scenario, const Placements& placements, SpaceStores& s) {
  std::vector<RobotRequest> requests;
  requests.reserve(placements.robots.size());
  s.robots.resize(placements.robots.size());
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const RobotItem& item = scenario.robots[i];
    s.names.push_back({item.id, item.distribute ? item.distribute->base_num : -1, 0, 0});
  }
  for (std::size_t i = 0; i < placements.robots.size(); ++i) {
    const PlacedRobot& placed = placements.robots[i];
    NameRange& name = s.names[placed.item];
    if (name.count == 0) name.first_entity = static_cast<std::uint32_t>(i);
    ++name.count;
    s.robots[i].item = placed.item;
    s.robots[i].number = placed.number;
    s.living.push_back(static_cast<std::uint32_t>(i));
    requests.push_back(
        {placed.item, static_cast<std::uint32_t>(i), placed.x_m, placed.y_m, placed.z_m, placed.yaw_rad});
  }
  return requests;
}

}  // namespace

std::unique_ptr<World> World::make(const Scenario& scenario, hal::PluginLoader& loader, const WorldOptions& options,
                                   Problems& problems) {
  auto impl = std::make_unique<Impl>();
  Impl& w = *impl;
  const std::size_t before = problems.size();
  const auto bad = [&] { return has_errors(problems, before); };
  w.scenario = scenario;
  w.loader = &loader;
  w.options = options;
  w.seed = options.seed ? *options.seed : scenario.seed ? *scenario.seed : seed_from_clock();
  const std::int64_t threads = options.threads.value_or(scenario.threads);
  try {
    w.pool = std::make_unique<ThreadPool>(static_cast<std::size_t>(std::max<std::int64_t>(0, threads)),
                                          options.assignment.value_or(scenario.assignment));
  } catch (const std::system_error& e) {
    problems.push_back({scenario.file, 0,
                        std::to_string(threads) + " threads cannot be made: " + e.code().message() +
                            "; ask for fewer (threads, --threads), or allow more (ulimit -u)",
                        false});
    return nullptr;
  }
  name_media(w.scenario, loader.catalog(), problems);
  w.populate(problems);
  w.make_hooks(problems);

  if (!bad()) complete_settings(w.scenario, loader, w.seed);
  w.size_ledgers();
  auto world = std::unique_ptr<World>(new World(std::move(impl)));
  if (bad()) return nullptr;
  return world;
}

std::unique_ptr<Field> World::Impl::make_field(const FieldType& type, const Scenario& from, Problems& problems) const {
  const SpaceStores& s = space.stores();
  const FieldArea area{s.min_x_m, s.min_y_m, from.arena_size[0], from.arena_size[1]};
  Element nothing;
  nothing.name = type.name;
  nothing.file = from.file;
  const auto written = std::ranges::find(from.fields, type.name, &Element::name);
  const Element& element = written == from.fields.end() ? nothing : *written;
  std::unique_ptr<Field> field = type.make(element, area, problems);
  if (field->painted_by_hooks() && from.hooks.empty() && !element.argos) {
    problems.push_back(problem_at(
        element, "the " + std::string(type.name) + " is to be painted by loop functions, but there are none"));
  }
  return field;
}

/// The things that have a place of their own in the file.
Things World::Impl::things_of(Scenario changed) const {
  const auto has_none = [](const auto& item) { return item.distribute.has_value(); };
  changed.robots.clear();
  std::erase_if(changed.objects, has_none);
  std::erase_if(changed.lights, has_none);
  Problems told_when_it_was_made;
  return furnish(changed, place(changed, seed, {}, told_when_it_was_made));
}

/// Fills the space, empty so far but for what a reset leaves, with what the file says and the seed decides.
void World::Impl::populate(Problems& problems) {
  SpaceStores& s = stores();
  s.min_x_m = scenario.arena_center[0] - 0.5 * scenario.arena_size[0];
  s.max_x_m = scenario.arena_center[0] + 0.5 * scenario.arena_size[0];
  s.min_y_m = scenario.arena_center[1] - 0.5 * scenario.arena_size[1];
  s.max_y_m = scenario.arena_center[1] + 0.5 * scenario.arena_size[1];

  if (scenario.arena_size[2] > 0.0) s.max_z_m = scenario.arena_center[2] + 0.5 * scenario.arena_size[2];

  s.fields.begin_anew();
  for (const FieldType* type : loader->catalog().all<FieldType>()) {
    if (s.fields.find(type->name) == nullptr) s.fields.add(type->name, make_field(*type, scenario, problems));
  }
  const std::size_t before = problems.size();
  const auto bad = [&] { return has_errors(problems, before); };

  const hal::Catalog& catalog = loader->catalog();
  const auto size_of = [&](const std::string& kind) { return size_of_kind(scenario, catalog, kind); };
  const Placements placements = place(scenario, options.places_seed.value_or(seed), size_of, problems);
  engines = make_engines(scenario, catalog, placements.robots.size(), s, problems);
  if (bad()) return;
  for (const Region& region : s.regions) {
    in_rows.push_back(region.listed ? 0 : 1);
    if (region.listed) all_in_rows = false;
  }
  s.bodies.has_motion = !all_in_rows;

  Things things = furnish(scenario, placements);
  s.objects = std::move(things.objects);
  s.lights = std::move(things.lights);
  s.sounds = std::move(things.sounds);
  const std::vector<RobotRequest> requests = name_robots(scenario, placements, s);
  if (factory == nullptr) factory = std::make_unique<RobotFactory>(scenario, seed, *loader, s, devices, media, *this);
  factory->make(requests, problems);
  for (const CouplingType* type : catalog.all<CouplingType>()) couplings.push_back(type->make(s.columns));
  editor = std::make_unique<WorldEditor>(scenario, s, *factory, assigner);
  space.set_editor(editor.get());

  reach_m = index_reach(s, tick_s());
  s.body_index.set_area(s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, reach_m);
  s.object_motion.resize(s.objects.size());
  s.object_region.resize(s.objects.size(), kNoRegion);
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    s.object_numbers.emplace(s.objects[i].id, static_cast<std::uint32_t>(i));
    s.object_motion[i].z_m = s.objects[i].z_low_m;
    s.object_motion[i].q_WB = hal::array_of(placements.objects[i].q_WB);
  }
  index_objects(s, false, reach_m);
  indexed_version = s.immovables_version;
  index_movables();
  if (!bad()) {
    assigner.build(s, tick_s());
    index_objects(s, false, reach_m);  // anew: now it is known what may lean
    index_movables();
    assign_regions(scenario, catalog, placements, assigner, s, problems);
  }
}

/// Makes a hook in its place. Where it cannot be made, a problem says why, and one that does nothing is there.
void World::Impl::make_hook(std::size_t i, Problems& problems) {
  const HookConfig& config = scenario.hooks[i];
  hooks[i].reset();  // closes its files before the next opens them
  const auto found = loader->get<HookType>(config.library, config.label);
  if (!found.ok()) {  // told when the world was made
    hooks[i] = std::make_unique<Hook>();
    return;
  }
  const HookType& type = *found.value();
  std::string why = "has no function that makes it; register it with hook_type";
  if (type.make != nullptr) {
    const hal::PluginCall call(&name_hook_made, &config);
    const auto what = thrown([&] { hooks[i] = type.make(config.options, problems); });
    if (hooks[i] != nullptr) return;
    why = what ? "threw while it was made" + *what : "makes nothing";
  }
  problems.push_back(
      {scenario.file, config.line, "hook '" + hook_names[i] + "' (library '" + config.library + "') " + why, false});
  hooks[i] = std::make_unique<Hook>();
}

void World::Impl::make_hooks(Problems& problems) {
  add_implied_hooks(scenario, *loader);
  for (const HookConfig& config : scenario.hooks) {
    const auto type = loader->get<HookType>(config.library, config.label);
    hook_names.emplace_back(type.ok() ? type.value()->name : std::string_view(config.label));
    hooks.push_back(std::make_unique<Hook>());
    if (type.ok())
      make_hook(hooks.size() - 1, problems);
    else
      problems.push_back(
          {scenario.file, config.line,
           (config.optional ? "user_functions are left out: " : "loop_functions: ") + type.error().message,
           config.optional});
  }
}

void World::Impl::size_ledgers() {
  const std::size_t blocks = stores().blocks.size();
  block_trouble.assign(blocks, 0);
  faults.assign(blocks, {});
  clamped.assign(blocks, 0);
  not_finite.assign(blocks, 0);
  excess.assign(blocks, {});
  excess_named.assign(stores().groups.size(), 0);
  said.assign(blocks, {});
}

// --- making anew ---

hal::Status World::reset(std::uint64_t seed, const Scenario* changed) {
  Impl& w = *impl_;
  if (const hal::Status can = w.can_begin_anew(); !can.ok()) return can;
  std::optional<Scenario> before;  // until its controllers have ended
  if (changed != nullptr) {
    if (const hal::Status can = can_reset(*changed); !can.ok()) return can;
    before = std::exchange(w.scenario, w.completed(*changed));
    w.new_settings = true;
  }
  SpaceStores& s = w.stores();
  w.factory->begin_anew(seed, w.new_settings);
  w.engines.clear();
  w.couplings.clear();
  w.space.set_editor(nullptr);
  w.editor.reset();
  w.devices.blocks.clear();
  SpaceStores empty;  // but for the memory of robots, and for what tells the new from the old
  empty.slab = std::move(s.slab);
  empty.groups = std::move(s.groups);
  empty.columns = std::move(s.columns);
  if (!w.new_settings) empty.fields = std::move(s.fields);
  empty.flight = s.flight;
  empty.rotors = s.rotors;
  empty.generations = s.generations + 1;
  empty.joint_generations = s.joint_generations + 1;
  empty.immovables_version = s.immovables_version + 1;
  empty.object_leds_version = s.object_leds_version + 1;
  empty.poses_version = s.poses_version + 1;
  s = std::move(empty);
  w.seed = seed;
  w.options.places_seed.reset();
  w.kept() = WorldParts();
  w.kept_checkpoints.forget_all();
  w.as_started.reset();  // controllers may keep something of the run before
  w.identity = std::make_shared<int>(0);
  w.assigner = {};
  w.in_rows.clear();
  w.all_in_rows = true;
  w.strays.clear();
  w.troubles.clear();
  Problems problems;
  w.populate(problems);
  if (!has_errors(problems)) w.reset_hooks(problems);
  w.size_ledgers();
  if (has_errors(problems)) {
    w.fail("reset with seed " + std::to_string(seed) + ": " + errors_of(problems));
    return hal::Error{w.failure};
  }
  complete_settings(w.scenario, *w.loader, seed);
  start();
  return w.state == RunState::Failed ? hal::Status(hal::Error{w.failure}) : hal::Status{};
}

hal::Status World::Impl::can_begin_anew() const {
  if (external != nullptr) return hal::Error{"no reset: real robots or peers take part, which cannot be put back"};
  if (!former.empty()) return hal::Error{"no reset: the run went on with other settings; make another world"};
  return {};
}

bool World::all_anew() const noexcept {
  return !impl_->hooks_reset && !impl_->factory->any_reset();
}

void World::Impl::reset_hooks(Problems& problems) {
  const bool make_anew = std::exchange(new_settings, false);
  hooks_reset = false;
  for (std::size_t i = 0; i < hooks.size(); ++i) {
    bool at_start = false;
    const std::string why = asked(i, "reset", [&](Hook& hook) { at_start = !make_anew && hook.reset(seed); });
    if (!why.empty())
      problems.push_back({scenario.file, scenario.hooks[i].line, why, false});
    else if (!at_start)
      make_hook(i, problems);
    hooks_reset = hooks_reset || at_start;
  }
}

}  // namespace tandem::core
