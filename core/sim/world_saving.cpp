// Writes the state of a world for another process, and goes on from what another one wrote.
//
// What a start makes again, this process has by itself: addresses above all. Of controllers that do not say what they
// remember, the words are written that have changed since the start. None of those may be an address.
#include <algorithm>
#include <cstring>

#include "core/sim/settings.hpp"
#include "core/sim/world_impl.hpp"
#include "core/space/addresses.hpp"
#include "hal/check.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);

std::uint64_t word_at(const std::byte* bytes, std::size_t word) noexcept {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes + word * kWord, kWord);
  return value;
}

/// A word of memory that may lie beside what was allocated, or in what was freed, which sanitizers would not let pass.
[[gnu::no_sanitize_address, gnu::no_sanitize_thread]] std::uint64_t any_word_at(std::uint64_t address) noexcept {
  std::uint64_t value = 0;
  std::memcpy(&value, reinterpret_cast<const void*>(address), kWord);
  return value;
}

/// What has to be alike in two worlds for one to take the state of the other over, a line each.
std::vector<std::string> shape_of(const Scenario& scenario, const SpaceStores& s) {
  std::vector<std::string> lines;
  for (const RobotGroup& group : s.groups) {
    std::string line = "robots " + group.kind->name + " with controller " + scenario.controllers[group.config].id +
                       " of class " + std::string(group.controller->class_name) + ", " +
                       std::to_string(group.controller->size) + " bytes, and";
    for (const hal::PortType* port : group.ports)
      line +=
          " " + std::string(port->name) + (port->role == hal::Role::Sensor ? "<" : ">") + std::to_string(port->layout);
    for (const KeptColumn& column : group.columns)
      line += " " + std::string(column.type->name) + "=" + std::to_string(column.type->layout);
    lines.push_back(std::move(line));
  }
  for (const RobotBlock& block : s.blocks)
    lines.push_back(std::to_string(block.used) + " robots of group " + std::to_string(block.group));
  for (const Region& region : s.regions)
    lines.push_back("engine " + (region.engine < scenario.engines.size() ? scenario.engines[region.engine].kind : "") +
                    " in region " + region.name);
  lines.push_back(std::string("bodies with") + (s.bodies.has_motion ? "" : "out") + " motion");
  for (const Fields::Entry& entry : s.fields.all()) lines.push_back("field " + entry.name);
  return lines;
}

/// Has `call` write bytes of its own, or read all of them. Says what went wrong, or nothing.
template <class Call>
std::string part(hal::Archive& archive, Call&& call) {
  std::string bytes;
  if (archive.reads()) archive(bytes);
  hal::Archive own = archive.reads() ? hal::Archive(bytes) : hal::Archive();
  if (const auto why = thrown([&] { call(own); })) return "threw" + *why;
  if (archive.reads()) return own.at_end() ? "" : "does not remember the same things as it wrote";
  bytes = own.take();
  archive(bytes);
  return {};
}

/// The first 16 bytes at each address among these words: of what a std::shared_ptr owns, how many share it.
std::vector<std::uint64_t> what_lies_at(const Addresses& addresses, const std::byte* bytes, std::size_t words) {
  std::vector<std::uint64_t> all;
  for (std::size_t k = 0; k < words; ++k) {
    const std::uint64_t at = word_at(bytes, k);
    if (!addresses.may_be(at) || !addresses.may_be(at + 2 * kWord - 1)) continue;
    all.insert(all.end(), {any_word_at(at), any_word_at(at + kWord)});
  }
  return all;
}

/// What keeps the words of a controller from being taken over by another process; empty: nothing. `start` are its bytes
/// after the start, `copy` is room for a copy of it: an address that both have is of what no step changes, unless they
/// own it together.
std::string flaw_of(const hal::ControllerType& type, const Addresses& addresses, const std::byte* controller,
                    const std::byte* start, std::byte* copy, std::size_t words) {
  if (type.copy == nullptr) return "cannot be copied";
  const std::vector<std::uint64_t> before = what_lies_at(addresses, controller, words);
  if (std::string why = copied(type, copy, controller); !why.empty()) return "threw while it was copied: " + why;
  const char* flaw = "";
  if (what_lies_at(addresses, controller, words) != before) flaw = "shares memory with its copies";
  const auto inside = [](const std::byte* of, std::uint64_t address) {
    return address - reinterpret_cast<std::uintptr_t>(of);  // less than its size: within itself
  };
  for (std::size_t k = 0; k < words; ++k) {
    const std::uint64_t now = word_at(controller, k);
    if (!addresses.may_be(now)) continue;
    const std::uint64_t in_copy = word_at(copy, k);
    const bool own = inside(controller, now) < words * kWord && inside(controller, now) == inside(copy, in_copy);
    if (now != word_at(start, k)) flaw = "refers to other memory than at the start";
    if (now != in_copy && !own) flaw = "owns memory: a vector, say, or a long text";
  }
  type.destroy(copy);
  return flaw;
}

template <class T>
bool same_bytes(T a, T b) {
  hal::Archive one, other;
  one(a);
  other(b);
  return one.bytes() == other.bytes();
}

/// What settings made `start` and now make `wanted` is to be so: `change(i, wanted)`, where i is that of `now`.
template <class T, class Change>
hal::Status take_changed(const char* what, const std::vector<T>& now, const std::vector<T>& start,
                         const std::vector<T>& wanted, Change&& change) {
  if (start.size() != wanted.size())
    return hal::Error{"the settings have another number of " + std::string(what) + "s"};
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (same_bytes(start[i], wanted[i])) continue;
    const auto there = std::ranges::find(now, start[i].id, &T::id);
    if (there == now.end() || !same_bytes(*there, start[i]))
      return hal::Error{"the run has changed the " + std::string(what) + " '" + start[i].id +
                        "', and so have the settings"};
    const auto number = static_cast<std::size_t>(there - now.begin());
    if (hal::Status changed = change(number, wanted[i]); !changed.ok()) return changed;
  }
  return {};
}

/// A word that the run has made `now` of `then`, of a controller that other settings `made`: members that share the
/// word are each as their side says.
std::uint64_t merged(std::uint64_t then, std::uint64_t now, std::uint64_t made) noexcept {
  for (std::uint64_t byte = 0xFF; byte != 0; byte <<= 8) {
    if (((then ^ now) & byte) != 0 && ((then ^ made) & byte) != 0) return now;  // one member, of both
  }
  return then ^ now ^ made;
}

/// A word of a controller: at `at` of its block, after the start and now.
struct ChangedWord {
  std::uint64_t at, then, now;
};

}  // namespace

hal::Status World::Impl::take_things(const Scenario& before) {
  SpaceStores& s = stores();
  const Things start = things_of(before), wanted = things_of(scenario);
  hal::Status all = take_changed("light", s.lights, start.lights, wanted.lights, [&](std::size_t i, const auto& light) {
    space.set_light(i, light);
    return hal::Status();
  });
  if (!all.ok()) return all;
  return take_changed("object", s.objects, start.objects, wanted.objects, [&](std::size_t i, const Object& o) {
    const auto item = std::ranges::find(scenario.objects, o.id, &ObjectItem::id);
    if (item->placement.pitch_rad != 0.0 || item->placement.roll_rad != 0.0)
      return hal::Status(hal::Error{"'" + o.id + "' would be put there tilted, which only a start can"});
    const hal::Status set = space.set_object({static_cast<std::uint32_t>(i), s.objects[i].generation}, o);
    if (!set.ok()) return set;
    return editor->room_for(BodyKey::object(i), {o.x_m, o.y_m, o.z_low_m, o.cos_h, o.sin_h});
  });
}

void World::begin_saving() {
  Impl& w = *impl_;
  if (w.as_started) return;
  const SpaceStores& s = w.stores();
  AsStarted& start = w.as_started.emplace();
  start.robots = s.robots.size();
  for (const RobotBlock& block : s.blocks)
    start.controllers.emplace_back(block.controllers, block.controllers + block.used * block.controller_stride);
  for (const Fields::Entry& entry : s.fields.all()) start.fields.push_back(entry.field->mark());
  start.controls.resize(w.hooks.size());  // of one that throws: asked again, and told, when they are written
  for (std::size_t i = 0; i < w.hooks.size(); ++i)
    (void)w.asked(i, "controls", [&](Hook&) { start.controls[i] = w.control_values(i); });
}

hal::Result<std::string> World::save() {
  Impl& w = *impl_;
  if (!w.as_started) return hal::Error{"the run began anew since its start"};
  if (w.external != nullptr) return hal::Error{"real robots or peers take part, which cannot be put back"};
  if (!w.former.empty()) return hal::Error{"the run went on with other settings than it began with"};
  if (!w.kept_checkpoints.kept.empty()) return hal::Error{"a hook keeps checkpoints of its own"};
  if (w.stores().robots.size() != w.as_started->robots) return hal::Error{"robots were added while the run went on"};
  hal::Archive archive;
  if (const hal::Status done = w.remember(archive); !done.ok()) return done.error();
  return archive.take();
}

hal::Status World::load(std::string_view saved, const Scenario* before) {
  Impl& w = *impl_;
  TANDEM_CHECK(w.as_started.has_value() && w.tick == 0, "load comes after begin_saving, and before the first step");
  std::optional<Scenario> was;
  if (before != nullptr) {
    was = w.completed(*before);
    std::vector<std::string> fixed = fixed_differences(*was, w.scenario, true);
    std::erase(fixed, kSeedPath);
    if (!fixed.empty()) return hal::Error{"cannot change on the way: " + listed(fixed)};
  }
  hal::Archive archive(saved);
  w.resumed_from = was ? &*was : nullptr;
  hal::Status all = w.remember(archive);
  w.resumed_from = nullptr;
  if (all.ok() && !archive.at_end()) all = hal::Error{"its state is not whole"};
  if (all.ok() && was) all = w.take_things(*was);
  if (!all.ok()) w.fail(all.error().message);
  return all;
}

hal::Status World::Impl::remember(hal::Archive& archive) {
  using Part = hal::Status (Impl::*)(hal::Archive&);
  for (const Part part : {&Impl::remember_shape, &Impl::remember_controls, &Impl::remember_space,
                          &Impl::remember_engines, &Impl::remember_hooks}) {
    if (hal::Status done = (this->*part)(archive); !done.ok()) return done;
    if (!archive.ok()) return hal::Error{"its state ends too early"};
  }
  return {};
}

hal::Status World::Impl::remember_shape(hal::Archive& archive) {
  if (!archive.same(loaded_objects().front().identity))
    return hal::Error{"it was written by another build of this program"};
  std::vector<std::string> now = shape_of(scenario, stores());
  for (const std::string& hook : hook_names) now.push_back("hook " + hook);
  std::vector<std::string> was = now;
  archive(was);
  if (was == now) return {};
  const std::size_t at = static_cast<std::size_t>(std::ranges::mismatch(was, now).in1 - was.begin());
  const auto line = [at](const std::vector<std::string>& of) { return at < of.size() ? of[at] : "nothing more"; };
  return hal::Error{"it has " + line(was) + ", where this world has " + line(now)};
}

/// Those that have changed since the start: others are as the settings say. What hooks do to the space when their
/// controls are put back does not count: this comes first.
hal::Status World::Impl::remember_controls(hal::Archive& archive) {
  std::vector<std::vector<ControlValue>> values(hooks.size());
  for (std::size_t i = 0; !archive.reads() && i < hooks.size(); ++i) {
    const std::string why = asked(i, "controls", [&](Hook&) { values[i] = control_values(i); });
    if (!why.empty()) return hal::Error{why};
    const std::vector<ControlValue>& start = as_started->controls[i];
    for (std::size_t k = 0; k < std::min(values[i].size(), start.size()); ++k) {
      if (values[i][k] == start[k]) values[i][k] = std::monostate();
    }
  }
  archive(values);
  return archive.reads() && values.size() == hooks.size() ? put_back_controls(values) : hal::Status();
}

hal::Status World::Impl::remember_space(hal::Archive& archive) {
  SpaceStores& s = stores();
  std::apply(archive, parts_of(s));
  archive(s.generations, s.joint_generations);
  for (RobotGroup& group : s.groups) archive(group.free_slots);
  const Addresses addresses;
  for (std::size_t b = 0; b < s.blocks.size() && archive.ok(); ++b) {
    if (hal::Status done = remember_block(archive, b, addresses); !done.ok()) return done;
  }
  if (hal::Status done = remember_fields(archive); !done.ok()) return done;
  remember_accuracy(archive);
  bool was_indexed = indexed();
  archive(was_indexed);
  std::apply(archive, kept());
  if (!archive.reads()) return {};
  note_other_state(s);
  fit_to_state(was_indexed);
  return {};
}

/// Those that have changed since the start. What hooks have painted where the settings now say otherwise is gone: they
/// are asked again, or not at all.
hal::Status World::Impl::remember_fields(hal::Archive& archive) {
  const std::vector<Fields::Entry>& all = stores().fields.all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    Field& field = *all[i].field;
    bool painted = field.painted_by_hooks(), changed = field.mark() != as_started->fields[i];
    archive(painted, changed);
    std::string bytes;
    if (hal::Archive own; !archive.reads() && (painted || changed)) {
      if (!field.remember(own)) return hal::Error{"the field '" + all[i].name + "' cannot be written to disk"};
      bytes = own.take();
    }
    archive(bytes);
    if (!archive.reads() || bytes.empty()) continue;
    if (resumed_from == nullptr || same_field(*resumed_from, scenario, all[i].name)) {
      hal::Archive own(bytes);
      if (!field.remember(own) || !own.at_end()) return hal::Error{"its state is damaged"};
    } else if (changed && !painted) {
      return hal::Error{"the run has changed the " + all[i].name + ", and so have the settings"};
    }
  }
  return {};
}

hal::Status World::Impl::remember_block(hal::Archive& archive, std::size_t index, const Addresses& addresses) {
  SpaceStores& s = stores();
  RobotBlock& block = s.blocks[index];
  const RobotGroup& group = s.groups[block.group];
  for (std::size_t p = 0; p < block.ports.size(); ++p) archive.raw(block.ports[p], group.ports[p]->size * block.used);
  for (const KeptColumn& column : group.columns)
    archive.raw(column.arrays->array(index), column.type->size * block.used);
  auto constructed = block.constructed;
  archive(block.halted, constructed);
  for (std::size_t slot = 0; slot < block.used && archive.ok(); ++slot) {
    if (constructed[slot] == block.constructed[slot]) continue;
    if (constructed[slot] != 0) return hal::Error{"it has a robot more than this world"};
    group.controller->destroy(block.controller(slot));
    block.constructed[slot] = 0;
  }
  return remember_controllers(archive, index, addresses);
}

hal::Status World::Impl::remember_controllers(hal::Archive& archive, std::size_t index, const Addresses& addresses) {
  const hal::ControllerType& type = *stores().groups[stores().blocks[index].group].controller;
  return type.remember != nullptr ? remember_own(archive, index) : remember_changed(archive, index, addresses);
}

/// For controllers of other parameters, as RobotFactory::KeepMemory: as World::load gives it to them.
std::function<hal::Status()> World::Impl::keep_memory(std::size_t index) {
  const RobotBlock& block = stores().blocks[index];
  const RobotGroup& group = stores().groups[block.group];
  const Addresses addresses;
  hal::Archive archive;
  hal::Status kept;
  if (group.controller->remember == nullptr && (!as_started || stores().robots.size() != as_started->robots))
    kept = hal::Error{"the controller '" + std::string(group.controller->name) +
                      "' does not say what it remembers (hal::Controller), and how it began is not known: robots were "
                      "added since, or the run began anew"};
  if (kept.ok()) kept = remember_controllers(archive, index, addresses);
  if (!kept.ok()) {
    if (index == group.blocks.front())
      options.log.warning("robots begin anew with the changed settings: " + kept.error().message);
    return {};
  }
  std::vector<std::vector<std::byte>> ports;  // that constructors may write into
  for (std::size_t p = 0; p < block.ports.size(); ++p)
    ports.emplace_back(block.ports[p], block.ports[p] + group.ports[p]->size * block.used);
  return [this, index, ports = std::move(ports), bytes = archive.take()] {
    for (std::size_t p = 0; p < ports.size(); ++p) std::ranges::copy(ports[p], stores().blocks[index].ports[p]);
    hal::Archive own(bytes);
    return remember_controllers(own, index, Addresses());
  };
}

/// Of controllers that say what they remember.
hal::Status World::Impl::remember_own(hal::Archive& archive, std::size_t index) {
  RobotBlock& block = stores().blocks[index];
  const hal::ControllerType& type = *stores().groups[block.group].controller;
  for (std::size_t slot = 0; slot < block.used && archive.ok(); ++slot) {
    if (block.constructed[slot] == 0) continue;
    const hal::PluginCall marked(&name_step, this, index, slot);
    const std::string why = part(archive, [&](hal::Archive& own) { type.remember(block.controller(slot), own); });
    if (!why.empty())
      return hal::Error{"the controller of robot '" + name_of_row(block.first_row + slot) + "' " + why +
                        " in remember"};
  }
  return {};
}

/// Of others: the words of the block's controllers that have changed since the start.
hal::Status World::Impl::remember_changed(hal::Archive& archive, std::size_t index, const Addresses& addresses) {
  RobotBlock& block = stores().blocks[index];
  const hal::ControllerType& type = *stores().groups[block.group].controller;
  const std::vector<std::byte>& start = as_started->controllers[index];
  const std::size_t words = block.controller_stride / kWord;
  std::vector<ChangedWord> changes;
  if (!archive.reads()) {
    Slab slab;
    std::byte* const copy = slab.take(block.controller_stride, type.align);
    for (std::size_t slot = 0; slot < block.used; ++slot) {
      if (block.constructed[slot] == 0) continue;
      const std::byte* const now = block.controller(slot);
      const std::byte* const then = start.data() + slot * block.controller_stride;
      const std::string why = flaw_of(type, addresses, now, then, copy, words);
      if (!why.empty())
        return hal::Error{"the controller '" + std::string(type.name) + "' of robot '" +
                          name_of_row(block.first_row + slot) + "' " + why +
                          ", and its class does not say what it remembers (hal::Controller)"};
      for (std::size_t k = 0; k < words; ++k) {
        const std::uint64_t was = word_at(then, k), is = word_at(now, k);
        // An address of before is nothing elsewhere: such a word is only what it is now.
        if (is != was) changes.push_back({slot * words + k, addresses.may_be(was) ? ~is : was, is});
      }
    }
  }
  archive(changes);
  for (const ChangedWord& word : changes) {
    if (word.at >= block.used * words) return hal::Error{"its state is damaged"};
    const std::uint64_t now = merged(word.then, word.now, word_at(block.controllers, word.at));
    std::memcpy(block.controllers + word.at * kWord, &now, kWord);
  }
  return {};
}

hal::Status World::Impl::remember_engines(hal::Archive& archive) {
  for (const auto& engine : engines) {
    bool known = true;
    std::string why = part(archive, [&](hal::Archive& own) { known = engine->remember(own); });
    if (!known) why = "does not know the state of its solvers: another library is in use";
    if (!why.empty()) return hal::Error{"the engine " + std::string(engine->kind()) + " " + why};
  }
  return {};
}

/// How exact the engines were in the processes before, too.
void World::Impl::remember_accuracy(hal::Archive& archive) {
  PhysicsAccuracy so_far = accuracy_before;
  for (const auto& engine : engines) so_far.add(engine->accuracy());
  archive(so_far);
  if (archive.reads()) accuracy_before = so_far;
}

hal::Status World::Impl::remember_hooks(hal::Archive& archive) {
  hook_phase = "remember";
  for (std::size_t i = 0; i < hooks.size(); ++i) {
    const hal::PluginCall marked(&name_hook, this, i);
    bool says = true;
    std::string why = part(archive, [&](hal::Archive& own) { says = hooks[i]->remember(own); });
    if (!says) why = "does not say what it remembers (Hook::remember)";
    if (!why.empty()) return hal::Error{"the hook '" + hook_names[i] + "' " + why};
  }
  return {};
}

}  // namespace tandem::core
