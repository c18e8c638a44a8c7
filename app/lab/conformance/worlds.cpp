// What can be said of a plug-in's entries by running them.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>

#include "app/catalog.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/lab/conformance/course.hpp"
#include "app/lab/conformance/judge.hpp"
#include "app/lab/conformance/probe.hpp"
#include "app/module/modules.hpp"
#include "app/outputs/observers.hpp"
#include "bridges/bridge_type.hpp"
#include "core/device/coupling.hpp"
#include "core/run/run.hpp"
#include "core/scenario/field_type.hpp"
#include "core/scenario/medium_type.hpp"
#include "core/scenario/run_part_type.hpp"
#include "core/view/layers/layer_set.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {
namespace {

class Worlds {
 public:
  Worlds(hal::PluginLoader& loader, const std::string& origin, Judgements& all)
      : loader_(loader), catalog_(loader.catalog()), origin_(origin), all_(all) {}

  void judge() {
    each<core::DeviceType>([this](const core::DeviceType& type) { judge_device(type); });
    each<core::EngineType>([this](const core::EngineType& type) { judge_engine(type); });
    each<hal::RobotKind>([this](const hal::RobotKind& kind) { judge_kind(kind); });
    each<hal::ControllerType>([this](const hal::ControllerType& type) { judge_controller(type); });
    each<core::HookType>([this](const core::HookType& type) { judge_hook(type); });
    each<core::FieldType>([this](const core::FieldType& type) { judge_field(type); });
    each<core::MediumType>([this](const core::MediumType& type) { judge_medium(type); });
    each<core::ObserverType>([this](const core::ObserverType& type) { judge_observer(type); });
    each<core::RunPartType>([this](const core::RunPartType& type) { judge_run_part(type); });
    each<core::LayerType>([this](const core::LayerType& type) { judge_layer(type); });
    judge_bystanders();
  }

 private:
  template <class T, class Visit>
  void each(Visit&& visit) {
    for (const T* type : catalog_.all<T>()) {
      if (own(type)) visit(*type);
    }
  }
  template <class T>
  bool own(const T* type) const {
    return catalog_.origin_of(type) == origin_;
  }
  template <class T>
  static std::string name_of(const T& type) {
    return fmt::format("{} '{}'", T::kCategory, hal::catalog_name(type));
  }

  /// The plug-in's own kinds of robots, then the others.
  std::vector<const hal::RobotKind*> kinds() const {
    auto all = catalog_.all<hal::RobotKind>();
    std::stable_partition(all.begin(), all.end(), [this](const auto* kind) { return own(kind); });
    return all;
  }
  /// What moves a robot of the kind; null: nothing does.
  const core::DeviceType* drive_of(const hal::RobotKind& kind) const {
    if (kind.drive() != nullptr)
      return core::find_device(catalog_, hal::WheelSpeeds::kName, hal::Role::Actuator, "default");
    return kind.flies() ? core::find_device(catalog_, hal::QuadrotorSpeed::kName, hal::Role::Actuator, "default")
                        : nullptr;
  }
  Trial plain(const hal::RobotKind& kind) const {
    Trial trial;
    trial.kind = &kind;
    if (const core::DeviceType* drive = drive_of(kind); drive != nullptr) trial.devices.push_back(drive);
    return trial;
  }
  static void add(Trial& trial, const core::DeviceType& type) {
    for (const core::DeviceType* there : trial.devices) {
      if (there->device == type.device && there->role == type.role) return;
    }
    trial.devices.push_back(&type);
  }

  void judge_device(const core::DeviceType& type) {
    const hal::RobotKind* carrier = nullptr;
    for (const hal::RobotKind* kind : kinds()) {
      if (carrier == nullptr && type.fits(*kind)) carrier = kind;
    }
    if (carrier == nullptr) {
      all_.push_back({Verdict::NotJudged, name_of(type), "worlds", "there is no kind of robot here that carries it"});
      return;
    }
    Trial trial = plain(*carrier);
    std::erase_if(trial.devices, [&](const auto* t) { return t->device == type.device && t->role == type.role; });
    trial.devices.insert(trial.devices.begin(), &type);
    for (const core::DeviceType* other : catalog_.all<core::DeviceType>()) {  // who shall hear, and be heard
      if (!type.medium.empty() && other->medium == type.medium && other->fits(*carrier) && other != &type)
        add(trial, *other);
    }
    const TrialMaker maker(loader_, trial);
    Course course(name_of(type), maker, all_);
    if (!course.runs()) return;
    if (type.role == hal::Role::Sensor) judge_readings(type, maker, course);
    if (course.repeats()) course.checkpoints();
    Trial without = trial;
    without.devices.erase(without.devices.begin());
    without.engine = engine_for(catalog_, trial)->kind;
    const TrialMaker usual(loader_, without);
    course.allocates(allocations_of(usual));
    course.counts_state(columns_of(usual));
  }

  /// All robots get readings that are there, and are numbers.
  void judge_readings(const core::DeviceType& type, const TrialMaker& maker, Course& course) {
    const auto* const port = catalog_.find<hal::PortType>(hal::port_entry(type.device, type.role));
    std::string why;
    const auto world = maker.make(0, why);
    if (world == nullptr || port == nullptr) return;
    (void)step_to(*world, TrialMaker::kTicks);
    std::size_t absent = 0;
    for (std::size_t i = 0; i < world->space().robot_count(); ++i) {
      const void* const reading = world->space().port(world->space().robot(i), *port);
      if (!hal::all_finite(*port, reading))
        return course.say(Verdict::Fault, "readings",
                          "of " + world->space().robot_name(world->space().robot(i)) +
                              ", no finite number: " + hal::to_text(*port, reading));
      if (static_cast<const hal::Reading*>(reading)->validity == hal::Validity::Absent) ++absent;
    }
    if (absent > 0)
      return course.say(Verdict::Fault, "readings",
                        fmt::format("those of {} robots are never there: call core::stamp for each port", absent));
    course.say(Verdict::Good, "readings", "all are there, and finite");
  }

  void judge_engine(const core::EngineType& type) {
    const hal::RobotKind* mover = nullptr;
    for (const hal::RobotKind* kind : kinds()) {
      const bool suits = type.traits.air ? kind->flies() : kind->drive() != nullptr;
      if (mover == nullptr && suits) mover = kind;
    }
    if (mover == nullptr) return;
    Trial trial = plain(*mover);
    trial.engine = type.kind;
    const TrialMaker maker(loader_, trial);
    Course course(name_of(type), maker, all_);
    if (!course.runs()) return;
    judge_motion(maker, course);
    if (course.repeats()) course.checkpoints();
    course.allocates(0);
  }

  /// Poses stay numbers, and those that are set from outside stay as they were set.
  static void judge_motion(const TrialMaker& maker, Course& course) {
    std::string why;
    const auto world = maker.make(0, why);
    if (world == nullptr) return;
    core::Space& space = world->space();
    const core::RobotId led = space.robot(1);
    space.set_external(led, true);
    const core::Pose held = space.pose(led);
    (void)step_to(*world, TrialMaker::kTicks);
    const core::Pose now = space.pose(led);
    if (now.x_m != held.x_m || now.y_m != held.y_m || now.cos_h != held.cos_h || now.sin_h != held.sin_h)
      return course.say(Verdict::Fault, "motion",
                        "it moves a robot whose pose is set from outside (BodyFlag kExternal): real robots' twins");
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      const core::Pose pose = space.pose(space.robot(i));
      if (!std::isfinite(pose.x_m + pose.y_m + pose.z_m) ||
          std::fabs(pose.cos_h * pose.cos_h + pose.sin_h * pose.sin_h - 1.0) > 1e-6)
        return course.say(Verdict::Fault, "motion",
                          space.robot_name(space.robot(i)) + " has a pose that is none after random commands");
    }
    course.say(Verdict::Good, "motion", "poses stay whole, and those that are set from outside stay");
  }

  void judge_kind(const hal::RobotKind& kind) {
    Trial trial = plain(kind);
    for (const core::DeviceType* type : catalog_.all<core::DeviceType>()) {
      if (type->implementation == "default" && type->fits(kind)) add(trial, *type);
    }
    const TrialMaker maker(loader_, trial);
    Course course(name_of(kind), maker, all_);
    if (!course.runs()) return;
    course.say(Verdict::Good, "worlds",
               fmt::format("runs with all of its {} devices in <{}>", trial.devices.size(),
                           engine_for(catalog_, trial)->kind));
  }

  void judge_controller(const hal::ControllerType& type) {
    std::string why;
    for (const hal::RobotKind* kind : kinds()) {
      Trial trial = plain(*kind);
      trial.controller = type.name;
      trial.library = origin_;
      for (const core::DeviceType* device : catalog_.all<core::DeviceType>()) {
        if (device->implementation == "default" && device->fits(*kind)) add(trial, *device);
      }
      const TrialMaker maker(loader_, trial);
      std::string reason;
      if (maker.make(0, reason) == nullptr) {
        if (why.empty()) why = fmt::format("on <{}>: {}", kind->name, reason);
        continue;
      }
      Course course(name_of(type), maker, all_);
      if (!course.runs()) return;
      if (course.repeats()) course.checkpoints();
      return course.allocates(0);
    }
    all_.push_back({Verdict::NotJudged, name_of(type), "worlds", "no kind of robot here suits it; " + why});
  }

  void judge_hook(const core::HookType& type) {
    const hal::RobotKind* const kind = kinds().front();
    Trial trial = plain(*kind);
    trial.more = fmt::format("<loop_functions library=\"{}\" label=\"{}\"/>", origin_, type.name);
    const TrialMaker maker(loader_, trial);
    Course course(name_of(type), maker, all_);
    if (course.runs() && course.repeats()) course.checkpoints();
  }

  void judge_field(const core::FieldType& type) {
    const Trial trial = plain(*kinds().front());
    const TrialMaker maker(loader_, trial);
    Course course(name_of(type), maker, all_);
    std::string why;
    const auto world = maker.make(0, why);
    if (world == nullptr) return course.say(Verdict::NotJudged, "worlds", why);
    (void)step_to(*world, TrialMaker::kCheckpoint);
    hal::Random random(1);
    const double size_m = world->space().arena_size_x_m();
    for (int i = 0; i < 1000; ++i) {
      const double x_m = random.uniform(-size_m, size_m), y_m = random.uniform(-size_m, size_m);
      const auto value = world->space().field(type.name, x_m, y_m, random.uniform(0.0, 1.0));
      if (value.ok() && std::isfinite(value.value())) continue;
      return course.say(Verdict::Fault, "values", fmt::format("it is no finite number at ({:.3f}, {:.3f})", x_m, y_m));
    }
    course.say(Verdict::Good, "values", "finite at 1000 places, in and around the arena");
  }

  void judge_medium(const core::MediumType& type) {
    int devices = 0;
    for (const core::DeviceType* device : catalog_.all<core::DeviceType>()) devices += device->medium == type.name;
    if (devices == 0)
      all_.push_back({Verdict::NotJudged, name_of(type), "worlds", "no device here works in it"});
    else
      all_.push_back({Verdict::Good, name_of(type), "worlds",
                      fmt::format("{} device{} work{} in it: judged above", devices, devices == 1 ? "" : "s",
                                  devices == 1 ? "s" : "")});
  }

  static std::filesystem::path file_of_trial() {
    return std::filesystem::temp_directory_path() / fmt::format("tandem_check_{}", ::getpid());
  }
  /// The element of such a part, with its defaults; what it writes goes into the file of trials.
  template <class Type>
  static core::Element with_defaults(const Type& type) {
    core::Element element;
    element.name = type.name;
    hal::ElementWriter writer(element);
    if (type.describe != nullptr) type.describe(writer);
    for (auto& attribute : element.attributes) {
      if (attribute.name == "path") attribute.value = file_of_trial().string();
    }
    return element;
  }

  void judge_observer(const core::ObserverType& type) {
    const Trial trial = plain(*kinds().front());
    const TrialMaker maker(loader_, trial);
    Course course(name_of(type), maker, all_);
    std::string why;
    const auto watched = maker.make(0, why);
    const auto alone = maker.make(0, why);
    if (watched == nullptr || alone == nullptr) return course.say(Verdict::NotJudged, "worlds", why);
    const auto file = file_of_trial();
    const core::Element element = with_defaults(type);
    core::Scenario scenario;
    scenario.observers.push_back(element);
    core::Problems problems;
    bool good = false;
    {
      Observers observers = Observers::make(scenario, catalog_, *watched, problems);
      if (core::has_errors(problems))
        return course.say(Verdict::NotJudged, "worlds", "its defaults do not suffice: " + problems.front().message);
      while (watched->tick() < TrialMaker::kTicks && watched->state() == core::RunState::Running) {
        watched->step();
        observers.tick_done(*watched);
      }
      good = observers.finish(*watched);
    }
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    (void)step_to(*alone, TrialMaker::kTicks);
    if (!good) return course.say(Verdict::Fault, "runs", "it failed; see above");
    if (watched->state_hash() != alone->state_hash())
      return course.say(Verdict::Fault, "worlds", "a run that it sees goes on otherwise than one that it does not see");
    course.say(Verdict::Good, "worlds", "a run that it sees is the same run");
  }

  void judge_run_part(const core::RunPartType& type) {
    const TrialMaker maker(loader_, plain(*kinds().front()));
    Course course(name_of(type), maker, all_);
    std::string why;
    const auto world = maker.make(0, why);
    if (world == nullptr) return course.say(Verdict::NotJudged, "worlds", why);
    const core::Element element = with_defaults(type);
    const std::atomic<bool> never{false};
    core::Run run(*world, never);
    run.add(std::make_unique<core::Length>(TrialMaker::kTicks));
    core::Problems problems;
    run.add(type.make(element, run, problems));
    if (core::has_errors(problems))
      return course.say(Verdict::NotJudged, "worlds", "its defaults do not suffice: " + problems.front().message);
    (void)run.go();
    std::error_code ignored;
    std::filesystem::remove(file_of_trial(), ignored);
    if (!run.failure().empty()) return course.say(Verdict::Fault, "runs", run.failure());
    course.say(Verdict::Good, "runs", fmt::format("it joins, and leaves after {} ticks", world->tick()));
  }

  void judge_layer(const core::LayerType& type) {
    const TrialMaker maker(loader_, plain(*kinds().front()));
    Course course(name_of(type), maker, all_);
    std::string why;
    const auto watched = maker.make(0, why);
    const auto alone = maker.make(0, why);
    if (watched == nullptr || alone == nullptr) return course.say(Verdict::NotJudged, "worlds", why);
    core::LayerSet layers(catalog_, hal::Log([&why](hal::Severity, std::string_view text) { why = text; }));
    if (const hal::Status on = layers.switch_on({std::string(type.name)}); !on.ok())
      return course.say(Verdict::Fault, "runs", why.empty() ? on.error().message : why);
    while (watched->tick() < TrialMaker::kTicks && watched->state() == core::RunState::Running) {
      watched->step();
      const core::Observation now = observation_of(*watched, watched->tick() - 1);
      layers.note(now);
      (void)layers.show(now);
    }
    (void)step_to(*alone, TrialMaker::kTicks);
    if (!layers.any_on()) return course.say(Verdict::Fault, "runs", why);
    if (watched->state_hash() != alone->state_hash())
      return course.say(Verdict::Fault, "worlds", "a run that it sees goes on otherwise than one that it does not see");
    course.say(Verdict::Good, "worlds", "a run that it sees is the same run");
  }

  /// Couplings, fields and media are in every world: robots that know nothing of them go on as without.
  void judge_bystanders() {
    std::vector<std::string> parts;
    each<core::CouplingType>([&](const core::CouplingType& type) { parts.push_back(name_of(type)); });
    each<core::FieldType>([&](const core::FieldType& type) { parts.push_back(name_of(type)); });
    if (parts.empty()) return;
    const hal::RobotKind* const kind = catalog().all<hal::RobotKind>().front();
    hal::Catalog without = catalog();
    (void)without.add_from(std::string(hal::Catalog::kInside), &register_probe);
    hal::PluginLoader other(plugin_folders(), std::move(without), on_demand());
    const Trial trial = plain(*kind);
    Trial same = trial;
    const TrialMaker with_plugin(loader_, trial), without_plugin(other, same);
    std::string why;
    const auto a = with_plugin.make(0, why), b = without_plugin.make(0, why);
    if (a == nullptr || b == nullptr) return;
    const std::string failure = step_to(*a, TrialMaker::kTicks);
    (void)step_to(*b, TrialMaker::kTicks);
    const bool alike = a->state_hash() == b->state_hash();
    for (const std::string& part : parts)
      all_.push_back({alike ? Verdict::Good : Verdict::Fault, part, "bystanders",
                      alike ? "robots that have nothing to do with it go on as without"
                            : "robots that have nothing to do with it go on otherwise than without the plug-in" +
                                  (failure.empty() ? "" : ": " + failure)});
  }

  hal::PluginLoader& loader_;
  const hal::Catalog& catalog_;
  const std::string& origin_;
  Judgements& all_;
};

}  // namespace

void judge_in_worlds(hal::PluginLoader& loader, const std::string& origin, Judgements& all) {
  Worlds(loader, origin, all).judge();
}

}  // namespace tandem::app
