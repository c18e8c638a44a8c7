// Parts of a World, for the files that make it and step it.
#pragma once
#include <any>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "core/device/coupling.hpp"
#include "core/device/device.hpp"
#include "core/sim/engine_factory.hpp"
#include "core/sim/region_assigner.hpp"
#include "core/sim/robot_factory.hpp"
#include "core/sim/thrown.hpp"
#include "core/sim/world.hpp"
#include "core/sim/world_editor.hpp"
#include "core/space/stores.hpp"
#include "hal/plugin_call.hpp"
#include "hal/printable.hpp"

namespace tandem::core {

/// Requests of hooks in this step, and the checkpoints that they keep.
class KeptCheckpoints final : public Checkpoints {
 public:
  struct Request {
    enum class Kind : std::uint8_t { Save, Restore, Reset };
    Kind kind;
    std::string name;
    std::uint64_t seed = 0;
  };

  void save(const std::string& name) override {
    names_.insert(name);
    requests.push_back({Request::Kind::Save, name});
  }
  hal::Status restore(const std::string& name) override {
    if (!names_.contains(name)) {
      return hal::Error{"there is no checkpoint '" + name +
                        "'; there are: " + listed(std::vector<std::string>(names_.begin(), names_.end()))};
    }
    requests.push_back({Request::Kind::Restore, name});
    return {};
  }
  void reset(std::uint64_t seed) override { requests.push_back({Request::Kind::Reset, {}, seed}); }

  void forget(const std::string& name) {
    names_.erase(name);
    kept.erase(name);
  }
  void forget_all() {
    names_.clear();
    kept.clear();
    requests.clear();
  }

  std::vector<Request> requests;
  std::map<std::string, Snapshot> kept;

 private:
  std::set<std::string> names_;  // kept, or to be kept after this step
};

class Addresses;   // core/space/addresses.hpp
struct FieldType;  // core/scenario/field_type.hpp

/// The value of a control: that of a button is none.
using ControlValue = std::variant<std::monostate, double, std::int64_t, bool, std::string>;

/// What the state of a world is made of beside its space, engines and hooks: tick, state, failure, incidents, commands
/// clamped and not finite by block, how far indices reach, measures, and groups whose excess was named.
using WorldParts = std::tuple<hal::Tick, RunState, std::string, Incidents, std::vector<std::uint64_t>,
                              std::vector<std::uint64_t>, double, Measures, std::vector<std::uint8_t>>;

/// Contents of a snapshot.
struct SavedWorld {
  std::shared_ptr<const int> of;  ///< the world that it is of
  std::unique_ptr<SpaceCopy> space;
  WorldParts parts;
  bool indexed = false;  ///< the index of immovable objects was up to date
  std::string engines;   ///< what they hold beyond the stores
  std::vector<std::any> hooks;
  std::vector<std::vector<ControlValue>> hook_controls;  ///< by hook
  std::optional<KeptCheckpoints> checkpoints;            ///< of hooks, for going back without their knowing
};

/// What an experiment puts into the arena and a run may change.
struct Things {
  std::vector<Object> objects;
  std::vector<LightSource> lights;
  std::vector<SoundSource> sounds;
};

/// The world as it was after its start, to tell what has changed since: what `World::save` needs.
struct AsStarted {
  std::size_t robots = 0;
  std::vector<std::vector<std::byte>> controllers;  ///< by block
  std::vector<std::uint64_t> fields;                ///< their marks
  std::vector<std::vector<ControlValue>> controls;  ///< by hook
};

/// A speed so far beyond what a robot can do that it was written in another unit.
struct Excess {
  std::size_t slot = 0;  ///< of its block
  double asked_m_s = 0.0;
  double most_m_s = 0.0;  ///< 0: none
};

/// A message of a controller that stepped.
struct Message {
  hal::Severity severity;
  std::string text;
  bool excess = false;  ///< of a robot that says much: for logs that keep all
};

struct World::Impl final : hal::RobotLog::Sink {
  static constexpr double kBeyond = 1.5;     // times what a robot can do: less is usual for a moment
  static constexpr double kUnlikely = 10.0;  // times what a robot can do: hardly meant

  Scenario scenario;
  WorldOptions options;
  hal::PluginLoader* loader = nullptr;
  std::uint64_t seed = 0;
  Space space;
  std::unique_ptr<ThreadPool> pool;
  MeasuredPhase sensing, controlling;
  std::vector<std::unique_ptr<Engine>> engines;
  std::vector<int> parts;  // of the tick, by engine
  RegionAssigner assigner;
  std::vector<std::uint8_t> in_rows;  // by region: its engine moves bodies where they stand, and lists none
  bool all_in_rows = true;            // … that of every region
  double reach_m = 0.0;               // of the indices
  std::uint64_t indexed_version = 0;  // of the immovable objects
  std::vector<BodyKey> strays;        // left their region in this tick, or were put where there is none
  std::vector<Trouble> troubles;
  Media media;
  RobotDevices devices;
  std::vector<std::unique_ptr<Coupling>> couplings;
  std::unique_ptr<RobotFactory> factory;
  std::unique_ptr<WorldEditor> editor;
  std::shared_ptr<const int> identity = std::make_shared<int>(0);  // tells this world's snapshots from others'
  KeptCheckpoints kept_checkpoints;
  std::vector<std::unique_ptr<Hook>> hooks;
  std::vector<std::string> hook_names;
  Measures measures;
  const char* hook_phase = "";                          // that is or was called last
  bool new_settings = false;                            // no reset has made controllers and hooks of them yet
  bool hooks_reset = false;                             // by the last reset: one may remember the run before
  std::vector<std::unique_ptr<const Scenario>> former;  // that the run went on from: controllers may know their kinds
  ExternalRobots* external = nullptr;
  std::vector<RobotId> elsewhere;  // robots whose controllers step there

  hal::Tick tick = 0;
  RunState state = RunState::Running;
  std::string failure;
  Incidents incidents;
  std::atomic<std::uint32_t> trouble{0};    // robots that need the serial look after a parallel phase
  std::vector<std::uint8_t> block_trouble;  // by block: 1 when one of its robots does
  std::vector<std::vector<std::pair<std::size_t, std::string>>> faults;  // by block: slots whose controllers threw
  std::vector<std::uint64_t> clamped;                                    // by block, running counts
  std::vector<std::uint64_t> not_finite;
  std::vector<Excess> excess;              // by block, of this tick
  std::vector<std::uint8_t> excess_named;  // by group: once is enough
  bool in_controllers = false;             // they step, side by side
  std::vector<std::vector<Message>> said;  // by block, in this tick
  std::atomic<bool> any_said{false};
  std::optional<Incidents> last_errors;  // of controllers, while they are destroyed

  std::optional<AsStarted> as_started;
  const Scenario* resumed_from = nullptr;  // while another world's state is read: its settings, where these are others
  PhysicsAccuracy accuracy_before;         // of another process

  SpaceStores& stores() noexcept { return space.stores(); }

  // --- going to another state ---
  auto kept() noexcept {
    return std::tie(tick, state, failure, incidents, clamped, not_finite, reach_m, measures, excess_named);
  }
  bool indexed() noexcept { return indexed_version == stores().immovables_version; }
  void fit_to_state(bool was_indexed);
  hal::Status remember(hal::Archive& archive);
  hal::Status remember_shape(hal::Archive& archive);
  hal::Status remember_controls(hal::Archive& archive);
  hal::Status remember_space(hal::Archive& archive);
  hal::Status remember_fields(hal::Archive& archive);
  Things things_of(Scenario changed) const;
  hal::Status take_things(const Scenario& before);
  using FieldChanges = std::vector<std::pair<Field*, std::shared_ptr<const void>>>;
  hal::Result<FieldChanges> other_fields(const Scenario& next) const;
  hal::Status remember_block(hal::Archive& archive, std::size_t block, const Addresses& addresses);
  hal::Status remember_controllers(hal::Archive& archive, std::size_t block, const Addresses& addresses);
  std::function<hal::Status()> keep_memory(std::size_t block);
  hal::Status remember_own(hal::Archive& archive, std::size_t block);
  hal::Status remember_changed(hal::Archive& archive, std::size_t block, const Addresses& addresses);
  hal::Status remember_engines(hal::Archive& archive);
  void remember_accuracy(hal::Archive& archive);
  hal::Status remember_hooks(hal::Archive& archive);

  // --- making ---
  void populate(Problems& problems);
  std::unique_ptr<Field> make_field(const FieldType& type, const Scenario& from, Problems& problems) const;
  void make_hooks(Problems& problems);
  hal::Status can_begin_anew() const;
  void reset_hooks(Problems& problems);
  void make_hook(std::size_t hook, Problems& problems);
  Scenario completed(const Scenario& changed) const;
  void change_hook(std::size_t hook);
  void size_ledgers();

  // --- messages of controllers ---
  hal::TimeNs now_ns() const noexcept override { return hal::time_of_tick(tick, scenario.ticks_per_second); }
  void write(std::uint32_t robot, hal::Severity severity, std::string_view text,
             std::uint32_t left_out) noexcept override;
  bool keeps() const noexcept override { return !options.excess_log.drops_all() && !options.log.drops_all(); }
  void keep(std::uint32_t robot, hal::Severity severity, std::string_view text) noexcept override;
  void take_message(std::uint32_t robot, Message message);
  void report(const Message& message) const;
  void report_messages();

  // --- one tick ---
  void act();
  void physics();
  void before_sense();
  void move_part(int part);
  void settle_changes();
  void stop_on_trouble();
  void find_stray_objects();
  void treat_escapes();
  void treat_escape(BodyKey body);
  void rebuild_index();
  void index_movables();
  template <class Work>
  void each_block(MeasuredPhase& phase, Work&& work);
  void sense_and_control();
  void sense(std::size_t block);
  void control(std::size_t block);
  const std::uint8_t* not_stepped(std::size_t block, std::array<std::uint8_t, kBlockRows>& memory) const noexcept;
  void note_thrown(std::size_t block, std::size_t slot, std::string what);
  void limit(std::size_t block);
  void note_limited(std::size_t block, std::size_t slot, const hal::Limited& what);
  void note_excess(std::size_t block, std::size_t slot, const hal::Limited& what);
  void report_excess(std::size_t block);
  void report_not_finite(std::uint32_t entity, const RobotGroup& group);
  void report_thrown(std::uint32_t entity, const std::string& why);
  void report_trouble();
  void paint_fields();
  static void name_step(const void* impl, std::size_t block, std::size_t index, hal::FixedText& out) noexcept;
  static void name_hook(const void* impl, std::size_t hook, std::size_t index, hal::FixedText& out) noexcept;
  void fit_to_bodies();
  void fit_ledgers();

  /// Calls a hook. Says what it threw, where and when, or nothing.
  template <class Call>
  std::string asked(std::size_t hook, const char* phase, Call&& call) {
    hook_phase = phase;
    const hal::PluginCall marked(&name_hook, this, hook);
    const std::optional<std::string> why = thrown([&] { call(*hooks[hook]); });
    return why ? "hook '" + hook_names[hook] + "' threw in " + phase + at_tick() + *why : std::string();
  }
  template <class Call>
  void call_hooks(const char* phase, Call&& call);
  std::vector<ControlValue> control_values(std::size_t hook);
  hal::Status put_back_controls(const std::vector<std::vector<ControlValue>>& saved);
  HookContext hook_context() {
    return {space, tick, scenario.ticks_per_second, seed, kept_checkpoints, space.sketch(), measures, scenario};
  }
  DeviceContext device_context(std::size_t block) {
    SpaceStores& s = stores();
    return {s,
            s.groups[s.blocks[block].group],
            s.blocks[block],
            tick,
            hal::time_of_tick(tick, scenario.ticks_per_second),
            tick_s(),
            seed};
  }
  double tick_s() const noexcept { return 1.0 / static_cast<double>(scenario.ticks_per_second); }
  void fail(std::string why) {
    if (state == RunState::Failed) return;
    state = RunState::Failed;
    failure = hal::printable(hal::shortened(why));
  }
  std::string at_tick() const { return " at tick " + std::to_string(tick); }
  bool moved_in_rows(std::size_t row) noexcept {
    const std::uint16_t region = stores().bodies.region[row];
    return region != kNoRegion && in_rows[region] != 0;
  }
  std::string name_of(BodyKey body) {
    if (!body.is_object()) return "robot '" + name_of_row(body.index()) + "'";
    const Object& object = stores().objects[body.index()];
    return (object.kind == Object::Kind::Box ? "box '" : "cylinder '") + object.id + "'";
  }
  /// Number of a body among incidents.
  static std::uint32_t number_of(std::uint32_t entity) noexcept { return entity << 1U; }
  std::uint32_t number_of(BodyKey body) const noexcept {
    const auto index = static_cast<std::uint32_t>(body.index());
    return body.is_object() ? index << 1U | 1U : number_of(space.stores().bodies.entity[index]);
  }
  /// "controller of robot 'ep3'"
  std::string controller_of(std::uint32_t entity) {
    return "controller of robot '" + space.robot_name({entity, stores().robots[entity].generation}) + "'";
  }
  std::string name_of_row(std::size_t row) {
    const std::uint32_t entity = stores().bodies.entity[row];
    return space.robot_name({entity, stores().robots[entity].generation});
  }
};

/// Builds the index of the immovable or of the movable objects.
void index_objects(SpaceStores& stores, bool movable, double reach_m);

/// How far from a point the indices must look for what a robot there could touch or see, in m.
double index_reach(const SpaceStores& stores, double tick_s) noexcept;

}  // namespace tandem::core
