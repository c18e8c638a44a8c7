// Goes on with other settings while a world runs: what can change and what cannot, and how robots and hooks follow.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <utility>

#include "core/scenario/field_type.hpp"
#include "core/sim/device_media.hpp"
#include "core/sim/settings.hpp"
#include "core/sim/world_impl.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kNamed = 10;

bool same_value(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const auto number = [](const std::string& text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  };
  double x = 0.0, y = 0.0;
  return number(a, x) && number(b, y) && x == y;
}

/// Writes the described numbers of an element in SI, so that "5 cm" and "0.05" are the same text.
class InSi final : public hal::ParamVisitor {
 public:
  explicit InSi(Element& element) : element_(element) {}

  void visit(const hal::Param& param) override {
    const auto* const group = param.group();
    for (Element& child : element_.children) {
      if (child.name != param.name) continue;
      InSi inner(child);
      if (group != nullptr) group->describe(group->value, inner);
      if (param.list() != nullptr) param.list()->describe_default(inner);
    }
    const bool number = param.as<double>() != nullptr;
    if (!number && param.as<std::array<double, 3>>() == nullptr) return;
    for (Element::Attribute& a : element_.attributes) {
      if (a.name != param.name) continue;
      const std::string text = std::exchange(a.value, {});
      for (std::size_t at = 0; at <= text.size();) {
        const std::size_t comma = number ? text.size() : std::min(text.find(',', at), text.size());
        a.value += (at == 0 ? "" : ",") + in_si(text.substr(at, comma - at), *param.bare);
        at = comma + 1;
      }
      return;
    }
  }

 private:
  static std::string in_si(const std::string& text, const hal::Unit& bare) {
    const auto si = hal::parse_quantity(text, bare);
    return si.ok() ? hal::format_number(si.value()) : text;
  }

  Element& element_;
};

/// The same of settings that are described: quantities by value, whatever their units. A description that throws
/// leaves them as they are written.
template <class Describe>
bool same_quantities(const Element& a, const Element& b, const Describe& describe) {
  if (same_settings(a, b)) return true;
  Element x = a, y = b;
  try {
    for (Element* const element : {&x, &y}) {
      InSi in_si(*element);
      describe(in_si);
    }
  } catch (...) {
    return false;
  }
  return same_settings(x, y);
}

// --- what cannot change ---

/// Walks two experiments side by side.
class Differences {
 public:
  /// Leaves out those of elements for which `taken(parent, element)`.
  using Taken = bool (*)(const Element& parent, const Element& element);

  void compare(const Element& a, const Element& b, const std::string& path, Taken taken) {
    attributes(a, b, path, {});
    children(a, b, path, taken);
  }
  void attributes(const Element& a, const Element& b, const std::string& path, const std::vector<std::string>& only) {
    const auto wanted = [&](const std::string& name) {
      return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
    };
    for (const Element::Attribute& x : a.attributes) {
      const std::string* const y = b.attribute(x.name);
      if (wanted(x.name) && (y == nullptr || !same_value(x.value, *y))) add(path + "." + x.name);
    }
    for (const Element::Attribute& y : b.attributes) {
      if (wanted(y.name) && a.attribute(y.name) == nullptr) add(path + "." + y.name);
    }
  }
  void children(const Element& a, const Element& b, const std::string& path, Taken taken) {
    const std::vector<const Element*> of_a = left(a, taken), of_b = left(b, taken);
    bool alike = of_a.size() == of_b.size();
    for (std::size_t i = 0; alike && i < of_a.size(); ++i) alike = of_a[i]->name == of_b[i]->name;
    if (!alike) {
      std::size_t at = 0;
      while (at < of_a.size() && at < of_b.size() && of_a[at]->name == of_b[at]->name) ++at;
      const std::string one = at < of_a.size() ? part(a, *of_a[at]) : part(b, *of_b[at]);
      return add((path.empty() ? a.name : path) + ": " + one + (at < of_a.size() ? " left out" : " added"));
    }
    for (std::size_t i = 0; i < of_a.size(); ++i)
      compare(*of_a[i], *of_b[i], (path.empty() ? "" : path + ".") + part(a, *of_a[i]), taken);
  }
  void add(std::string path) {
    if (all.size() < kNamed && std::find(all.begin(), all.end(), path) == all.end()) all.push_back(std::move(path));
  }
  /// As --set names a child.
  static std::string part(const Element& parent, const Element& child) {
    if (const std::string* const id = child.attribute("id"); id != nullptr) return child.name + "[" + *id + "]";
    std::size_t number = 0, before = 0;
    for (const Element& other : parent.children) {
      if (&other == &child) before = number;
      if (other.name == child.name) ++number;
    }
    return number > 1 ? child.name + "[" + std::to_string(before) + "]" : child.name;
  }

  std::vector<std::string> all;

 private:
  static std::vector<const Element*> left(const Element& parent, Taken taken) {
    std::vector<const Element*> all;
    for (const Element& child : parent.children) {
      if (!taken(parent, child)) all.push_back(&child);
    }
    return all;
  }
};

bool is_one_of(const std::string& name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// What is taken over, or does nothing to a simulated robot.
bool taken_over(const Element& parent, const Element& element) {
  if (is_one_of(element.name, {"controllers", "loop_functions"})) return true;  // compared apart
  if (is_one_of(element.name, {"fitted", "trackers", "safety", "desk", "record", "visualization", "system"}))
    return true;
  return parent.attribute("id") != nullptr && is_one_of(element.name, {"controller", "bridge", "tracker", "peer"});
}

std::vector<const Element*> named(const Element& parent, std::string_view name) {
  std::vector<const Element*> all;
  for (const Element& child : parent.children) {
    if (child.name == name) all.push_back(&child);
  }
  return all;
}

bool same_devices(const hal::Catalog& catalog, hal::Role role, const std::vector<DeviceChoice>& a,
                  const std::vector<DeviceChoice>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const DeviceChoice& x, const DeviceChoice& y) {
    if (x.device != y.device || x.implementation != y.implementation || x.medium != y.medium) return false;
    const DeviceType* const type = find_device(catalog, x.device, role, x.implementation);
    return same_quantities(x.options, y.options, [&](hal::ParamVisitor& v) {
      if (type != nullptr && type->describe != nullptr) type->describe(v);
    });
  });
}

const Element& params_of(const RobotItem& item, const Scenario& scenario) {
  return item.params ? *item.params : scenario.controllers[item.controller].params;
}

bool same_fits(const Scenario& a, const Scenario& b) {
  const Element* const x = a.effective.child("fitted");
  const Element* const y = b.effective.child("fitted");
  return x == nullptr || y == nullptr ? x == y : same_settings(*x, *y);
}

/// What the experiments' texts do not show: worlds are also made from scenarios that no file holds.
void compare_scenarios(const Scenario& a, const Scenario& b, Differences& found) {
  if (a.ticks_per_second != b.ticks_per_second) found.add("framework.experiment.ticks_per_second");
  if (a.seed != b.seed) found.add(std::string(kSeedPath));
  if (a.arena_size != b.arena_size || a.arena_center != b.arena_center) found.add("arena.size");
  const auto same_engine = [](const EngineConfig& x, const EngineConfig& y) {
    return x.kind == y.kind && x.id == y.id && same_settings(x.options, y.options);
  };
  if (!std::equal(a.engines.begin(), a.engines.end(), b.engines.begin(), b.engines.end(), same_engine))
    found.add("physics_engines");
  const auto same_robot = [](const RobotItem& x, const RobotItem& y) {
    const std::int64_t count = x.distribute ? x.distribute->quantity : -1;
    return x.kind == y.kind && x.id == y.id && count == (y.distribute ? y.distribute->quantity : -1);
  };
  if (!std::equal(a.robots.begin(), a.robots.end(), b.robots.begin(), b.robots.end(), same_robot))
    found.add("arena: its robots");
  if (a.objects.size() != b.objects.size() || a.lights.size() != b.lights.size() || a.sounds.size() != b.sounds.size())
    found.add("arena: its objects");
  if (a.media.size() != b.media.size() || a.fields.size() != b.fields.size()) found.add("media");
  const auto same_controller = [](const ControllerConfig& x, const ControllerConfig& y) {
    return x.id == y.id && x.label == y.label && x.library == y.library;
  };
  if (!std::equal(a.controllers.begin(), a.controllers.end(), b.controllers.begin(), b.controllers.end(),
                  same_controller))
    found.add("controllers: their ids or libraries");
  const auto same_hook = [](const HookConfig& x, const HookConfig& y) {
    return x.label == y.label && x.library == y.library;
  };
  if (!std::equal(a.hooks.begin(), a.hooks.end(), b.hooks.begin(), b.hooks.end(), same_hook))
    found.add("loop_functions: their libraries");
}

/// Whether a setting of this path is taken over by itself: take_things, take_fields; the length is the run's.
bool taken_over_by_itself(const std::string& path) {
  static constexpr std::array<std::string_view, 5> kAll = {"framework.experiment.length", "arena.floor", "arena.light",
                                                           "arena.box", "arena.cylinder"};
  return !path.ends_with(".id") && std::ranges::any_of(kAll, [&path](std::string_view known) {
    return path.starts_with(known) &&
           (path.size() == known.size() || path[known.size()] == '.' || path[known.size()] == '[');
  });
}

/// The robots of a group share a kit: it stays one of them.
bool parts_differ(const RobotItem& a, const RobotItem& b) {
  return a.controller != b.controller || (b.params.has_value() && !a.params.has_value());
}

}  // namespace

bool same_settings(const Element& a, const Element& b) {
  const auto has = [](const Element& element, const Element::Attribute& wanted) {
    const std::string* const value = element.attribute(wanted.name);
    return value != nullptr && same_value(*value, wanted.value);
  };
  return a.name == b.name && a.attributes.size() == b.attributes.size() &&
         std::all_of(a.attributes.begin(), a.attributes.end(), [&](const auto& x) { return has(b, x); }) &&
         std::equal(a.children.begin(), a.children.end(), b.children.begin(), b.children.end(), &same_settings);
}

std::string errors_of(const Problems& problems) {
  std::string all;
  for (const Problem& problem : problems) {
    if (!problem.warning) all += (all.empty() ? "" : "; ") + to_text(problem);
  }
  return all;
}

bool same_field(const Scenario& a, const Scenario& b, std::string_view name) {
  const auto x = std::ranges::find(a.fields, name, &Element::name),
             y = std::ranges::find(b.fields, name, &Element::name);
  return x == a.fields.end() || y == b.fields.end() ? (x == a.fields.end()) == (y == b.fields.end())
                                                    : same_settings(*x, *y);
}

std::vector<std::string> fixed_differences(const Scenario& before, const Scenario& changed, bool in_slots) {
  Differences found;
  for (std::size_t i = 0; in_slots && i < std::min(before.robots.size(), changed.robots.size()); ++i) {
    const RobotItem &was = before.robots[i], &is = changed.robots[i];
    if (was.controller != is.controller || was.params.has_value() != is.params.has_value())
      found.add("the controller of '" + is.id + "'");
  }
  const Element &a = before.effective, &b = changed.effective;
  found.children(a, b, "", &taken_over);
  const auto hooks_a = named(a, "loop_functions"), hooks_b = named(b, "loop_functions");
  for (std::size_t i = 0; i < std::min(hooks_a.size(), hooks_b.size()); ++i)
    found.attributes(*hooks_a[i], *hooks_b[i], Differences::part(a, *hooks_a[i]), {"library", "label"});
  const Element *all_a = a.child("controllers"), *all_b = b.child("controllers");
  if (all_a != nullptr && all_b != nullptr && all_a->children.size() == all_b->children.size()) {
    for (std::size_t i = 0; i < all_a->children.size(); ++i)
      found.attributes(all_a->children[i], all_b->children[i],
                       "controllers." + Differences::part(*all_a, all_a->children[i]), {});
  }
  if (found.all.empty()) compare_scenarios(before, changed, found);
  std::erase_if(found.all, &taken_over_by_itself);
  return std::move(found.all);
}

// --- the world ---

hal::Status World::can_reset(const Scenario& changed) const {
  if (hal::Status can = impl_->can_begin_anew(); !can.ok()) return can;
  const Scenario &now = impl_->scenario, next = impl_->completed(changed);
  std::vector<std::string> fixed = fixed_differences(now, next, true);
  if (!same_fits(now, next)) fixed.emplace_back("fitted");
  if (!fixed.empty()) return hal::Error{"cannot change at a reset: " + listed(fixed) + "; make another world"};
  Problems problems;
  for (const HookConfig& hook : next.hooks) {
    const auto type = impl_->loader->get<HookType>(hook.library, hook.label);
    if (!type.ok() || type.value()->describe == nullptr) continue;
    ElementReader reader(hook.options, problems, {"library", "label"});
    type.value()->describe(reader);
    reader.finish();
  }
  impl_->factory->check_params(next, problems);
  return has_errors(problems) ? hal::Status(hal::Error{errors_of(problems)}) : hal::Status();
}

/// With all defaults of those parts that either scenario uses.
Scenario World::Impl::completed(const Scenario& changed) const {
  Scenario next = changed;
  Problems ignored;
  name_media(next, loader->catalog(), ignored);
  add_implied_hooks(next, *loader);
  for (const bool as_before : {true, false}) {
    for (std::size_t i = 0; i < std::min(next.robots.size(), scenario.robots.size()); ++i)
      next.robots[i].controller = as_before ? scenario.robots[i].controller : changed.robots[i].controller;
    complete_settings(next, *loader, seed);
  }
  return next;
}

hal::Status World::can_continue_with(const Scenario& changed) const {
  const std::vector<std::string> fixed = fixed_differences(impl_->scenario, impl_->completed(changed));
  if (fixed.empty()) {
    const auto fields = impl_->other_fields(changed);
    return fields.ok() ? hal::Status() : hal::Status(fields.error());
  }
  return hal::Error{"cannot change while the run goes on: " + listed(fixed) +
                    ". What can: parameters and devices of controllers, which robot has which, options of hooks, "
                    "<fitted>, lights, boxes, cylinders, and pictures of the floor"};
}

/// What fields hold that other settings make other.
hal::Result<World::Impl::FieldChanges> World::Impl::other_fields(const Scenario& next) const {
  FieldChanges changes;
  for (const FieldType* type : loader->catalog().all<FieldType>()) {
    if (same_field(scenario, next, type->name)) continue;
    Problems problems;
    const std::unique_ptr<Field> made = make_field(*type, next, problems);
    if (has_errors(problems)) return hal::Error{errors_of(problems)};
    Field* const field = space.stores().fields.find(type->name);
    if (made->painted_by_hooks() || field->painted_by_hooks())
      return hal::Error{"cannot change while the run goes on: the " + std::string(type->name) + ", which hooks paint"};
    changes.emplace_back(field, made->keep());
  }
  return changes;
}

hal::Status World::continue_with(const Scenario& changed) {
  if (const hal::Status can = can_continue_with(changed); !can.ok()) return can;
  Impl& w = *impl_;
  Scenario next = w.completed(changed);
  const auto fields = w.other_fields(next);
  for (const auto& [field, held] : fields.value()) field->put_back(held);
  w.former.push_back(std::make_unique<const Scenario>(std::exchange(w.scenario, std::move(next))));
  const Scenario& before = *w.former.back();
  w.identity = std::make_shared<int>(0);
  w.kept_checkpoints.forget_all();
  hal::Status taken = w.take_things(before);
  if (taken.ok()) taken = w.factory->go_on_from(before, [&w](std::size_t block) { return w.keep_memory(block); });
  if (!taken.ok()) w.fail("with the changed settings" + w.at_tick() + ": " + taken.error().message);
  w.fit_ledgers();
  bool any_hook = false;
  for (std::size_t i = 0; i < w.hooks.size() && w.state != RunState::Failed; ++i) {
    const auto type = w.loader->get<HookType>(w.scenario.hooks[i].library, w.scenario.hooks[i].label);
    if (same_quantities(before.hooks[i].options, w.scenario.hooks[i].options, [&](hal::ParamVisitor& v) {
          if (type.ok() && type.value()->describe != nullptr) type.value()->describe(v);
        }))
      continue;
    w.change_hook(i);
    any_hook = true;
  }
  for (const Fields::Entry& entry : w.stores().fields.all()) {
    if (any_hook && entry.field->painted_by_hooks()) entry.field->repaint();
  }
  if (w.state == RunState::Failed) return hal::Error{w.failure};
  return {};
}

/// The hook is another one from now on, which remembers what the former did as far as that says.
void World::Impl::change_hook(std::size_t i) {
  hook_phase = "before_run";
  const hal::PluginCall marked(&name_hook, this, i);
  Problems problems;
  const auto what = thrown([&] {
    const std::any kept = hooks[i]->save();
    make_hook(i, problems);
    if (has_errors(problems)) return;
    HookContext context = hook_context();
    hooks[i]->before_run(context);
    if (kept.has_value()) hooks[i]->restore(kept);
  });
  if (what || has_errors(problems)) {
    fail("hook '" + hook_names[i] + "' with the changed options" + at_tick() + " " +
         (what ? "threw" + *what : errors_of(problems)));
  }
}

// --- robots ---

hal::Status RobotFactory::go_on_from(const Scenario& before, const KeepMemory& keep) {
  slab_ = nullptr;
  const std::size_t groups = stores_.groups.size();
  for (std::size_t g = 0; g < groups; ++g) {
    if (hal::Status done = change_group(g, before, keep); !done.ok()) return done;
  }
  for (std::uint32_t entity = 0; entity < stores_.robots.size(); ++entity) {
    const RobotEntity& e = stores_.robots[entity];
    if (!e.alive || e.item >= scenario_.robots.size()) continue;
    const RobotItem& item = scenario_.robots[e.item];
    if (!parts_differ(before.robots[e.item], item)) continue;
    if (hal::Status done = move(entity, item); !done.ok()) return done;
  }
  media_.fit(stores_);
  return {};
}

/// Of the robots that stay in their group: other parameters make their controllers anew, other devices do not.
hal::Status RobotFactory::change_group(std::size_t g, const Scenario& before, const KeepMemory& keep) {
  RobotGroup& group = stores_.groups[g];
  const RobotItem was = *group.item;
  RobotItem now = was;
  for (std::size_t i = 0; i < before.robots.size(); ++i) {  // also of groups of robots that were added
    if (before.robots[i].kind == was.kind && before.robots[i].own_kind == was.own_kind)
      now.own_kind = scenario_.robots[i].own_kind;
  }
  for (std::size_t i = 0; i < group_of_item_.size(); ++i) {
    if (group_of_item_[i] != g || parts_differ(before.robots[i], scenario_.robots[i])) continue;
    now = scenario_.robots[i];
    break;
  }
  const ControllerConfig &config_was = before.controllers[group.config], &config = scenario_.controllers[group.config];
  const bool other_params =
      !same_quantities(params_of(was, before), params_of(now, scenario_), [&](hal::ParamVisitor& v) {
        const hal::PluginCall call(&name_params, this, group.config);
        (void)group.controller->read_params(v);
      });
  const bool other_devices = !same_devices(catalog(), hal::Role::Sensor, config_was.sensors, config.sensors) ||
                             !same_devices(catalog(), hal::Role::Actuator, config_was.actuators, config.actuators) ||
                             !same_fits(before, scenario_);
  group.item = std::make_shared<RobotItem>(std::move(now));
  if (!other_params && !other_devices) return {};
  former_params_.push_back(group.params);
  Problems problems;
  if (!prepare_group(g, problems)) return cannot_be_made(*group.item, problems);
  group.media.clear();
  for (const std::size_t b : group.blocks) devices_.blocks[b] = {};
  if (other_params) {
    if (hal::Status made = make_anew(g, keep); !made.ok()) return made;
  }
  complete(g);
  stores_.bodies_changed = true;  // how far devices reach may have changed
  return {};
}

/// The controllers of a group, with its parameters of now. Those of robots with parameters of their own stay.
hal::Status RobotFactory::make_anew(std::size_t g, const KeepMemory& keep) {
  for (const std::size_t b : stores_.groups[g].blocks) {
    const std::function<hal::Status()> give_back = keep(b);
    for (std::uint32_t slot = 0; slot < stores_.blocks[b].used; ++slot) {
      RobotBlock& block = stores_.blocks[b];
      if (block.constructed[slot] == 0 || (slot < block.params.size() && block.params[slot] != nullptr)) continue;
      block.constructed[slot] = 0;
      stores_.groups[g].controller->destroy(block.controller(slot));
      if (!give_back) {
        reset_row(stores_.groups[g], block, slot);
        block.halted[slot] = static_cast<std::uint8_t>(block.halted[slot] & ~bit(HaltOwner::Controller));
      }
      const std::string why = construct({static_cast<std::uint32_t>(b), slot}, stores_.groups[g].params);
      if (!why.empty()) return hal::Error{why};
    }
    if (!give_back) continue;
    if (hal::Status given = give_back(); !given.ok()) return given;
  }
  return {};
}

/// Gives a robot another controller: its body, and its state as far as the other's devices keep such, go to a slot of
/// that one's group. What it holds, or is held by, is let go.
hal::Status RobotFactory::move(std::uint32_t entity, const RobotItem& item) {
  RobotEntity& e = stores_.robots[entity];
  const Slot from{e.block, e.slot};
  hal::Result<Room> found = room_for(item);
  if (!found.ok()) return found.error();
  Room& room = found.value();
  begin_row(room);
  RobotBlock &was = stores_.blocks[from.block], &block = stores_.blocks[room.slot.block];
  RobotGroup& former = stores_.groups[was.group];
  const std::size_t old_row = was.first_row + from.slot, row = block.first_row + room.slot.slot;
  Bodies& b = stores_.bodies;
  const auto carry = [&](auto& array) { array[row] = array[old_row]; };
  for (auto* array : {&b.x_m, &b.y_m, &b.cos_h, &b.sin_h, &b.left_m, &b.right_m}) carry(*array);
  carry(b.radius_m);
  carry(b.flags);
  carry(b.entity);
  carry(b.region);
  if (!b.motion.empty()) carry(b.motion);
  block.halted[room.slot.slot] = static_cast<std::uint8_t>(was.halted[from.slot] & ~bit(HaltOwner::Controller));

  // The slot that it leaves, as that of a robot that is removed; one that was led from outside: pointers into it are
  // kept, so nobody else ever gets it.
  const bool led = (b.flags[old_row] & kExternal) != 0;
  was.halted[from.slot] = bit(HaltOwner::Removed);
  if (was.constructed[from.slot] != 0) former.controller->destroy(was.controller(from.slot));
  was.constructed[from.slot] = 0;
  if (from.slot < was.params.size()) {
    former_params_.push_back(was.params[from.slot]);
    was.params[from.slot].reset();
  }
  if (!led) former.free_slots.push_back(from);
  b.flags[old_row] = 0;
  b.left_m_s[old_row] = b.right_m_s[old_row] = 0.0;
  for (Joint& joint : stores_.joints) {
    if (joint.a == BodyKey::robot(old_row) || joint.b == BodyKey::robot(old_row)) joint.alive = false;
  }
  e.block = room.slot.block;
  e.slot = room.slot.slot;
  group_of_item_[e.item] = room.group;

  const std::string why = construct(room.slot, room.params);
  if (!why.empty()) return hal::Error{why};
  if (hal::Status holds = can_hold(room.slot); !holds.ok()) return holds;
  end_row(room);
  // Only now has the group all columns that its devices need.
  for (const KeptColumn& column : stores_.groups[room.group].columns) {
    const std::byte* const state = column.arrays->array(from.block);
    if (state == nullptr) continue;
    const std::size_t size = column.type->size;
    std::memcpy(column.arrays->array(room.slot.block) + room.slot.slot * size, state + from.slot * size, size);
  }
  stores_.altered = true;
  ++stores_.generations;  // who knows where robots lie looks anew
  stores_.touch(BodyKey::robot(row));
  return {};
}

}  // namespace tandem::core
