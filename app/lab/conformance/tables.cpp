// What can be said of a plug-in's entries without a world.
#include <cmath>
#include <fmt/format.h>

#include "app/lab/conformance/judge.hpp"
#include "app/lab/conformance/probe.hpp"
#include "bridges/bridge_type.hpp"
#include "bridges/emulation/emulator_type.hpp"
#include "bridges/guardian/stopper.hpp"
#include "bridges/tracker_type.hpp"
#include "core/device/coupling.hpp"
#include "core/hook/hook.hpp"
#include "core/physics/engine.hpp"
#include "core/scenario/field_type.hpp"
#include "core/scenario/medium_type.hpp"
#include "core/scenario/observer_type.hpp"
#include "core/scenario/run_part_type.hpp"
#include "core/view/layers/layer.hpp"
#include "hal/command.hpp"

namespace tandem::app {
namespace {

class Tables {
 public:
  Tables(const hal::Catalog& catalog, const std::string& origin, Judgements& all)
      : catalog_(catalog), origin_(origin), all_(all) {}

  void judge() {
    each<hal::PortType>([this](const hal::PortType& type) {
      judge_documents(type);
      judge_safety(type);
    });
    each<core::DeviceType>([this](const core::DeviceType& type) { judge_device(type); });
    each<core::EngineType>([this](const core::EngineType& type) { judge_engine(type); });
    each<bridges::BridgeType>([this](const bridges::BridgeType& type) { judge_bridge(type); });
    each<bridges::EmulatorType>([this](const bridges::EmulatorType& type) { judge_emulator(type); });
    each<bridges::guardian::StopperType>([this](const bridges::guardian::StopperType& type) {
      const bool bridge = catalog_.find<bridges::BridgeType>(type.kind) != nullptr;
      say(bridge && type.make != nullptr, type, "use",
          type.make == nullptr ? "it has no function that makes one"
          : bridge             ? "stops robots of the bridge of that name"
                               : fmt::format("there is no bridge '{}' whose robots it could stop", type.kind));
    });
    each<core::LayerType>([this](const core::LayerType& type) {
      if (type.make == nullptr || !(type.draws || type.panels))
        say(false, type, "table", "it shows nothing: it has neither `draw` nor `panel`, or no function that makes one");
    });
    judge_summaries<core::DeviceType, core::CouplingType, core::EngineType, core::FieldType, core::MediumType,
                    core::ObserverType, core::RunPartType, core::LayerType, core::HookType, hal::ControllerType,
                    bridges::BridgeType, bridges::TrackerType, bridges::EmulatorType, hal::RobotKind,
                    hal::CommandType>();
  }

 private:
  template <class T, class Visit>
  void each(Visit&& visit) {
    for (const T* type : catalog_.all<T>()) {
      if (catalog_.origin_of(type) == origin_) visit(*type);
    }
  }
  template <class T>
  void say(bool good, const T& type, std::string_view what, std::string found) {
    all_.push_back({good ? Verdict::Good : Verdict::Fault,
                    fmt::format("{} '{}'", T::kCategory, hal::catalog_name(type)), std::string(what),
                    std::move(found)});
  }

  template <class... T>
  void judge_summaries() {
    (each<T>([this](const T& type) {
       if (type.summary.empty())
         say(false, type, "documents", "it has no summary: `tandem list` shows one line of each");
     }),
     ...);
  }

  void judge_documents(const hal::PortType& type) {
    std::string silent;
    for (const hal::Field& field : type.fields) {
      if (field.doc.empty()) silent += (silent.empty() ? "" : ", ") + std::string(field.name);
    }
    if (type.doc.empty()) return say(false, type, "documents", "its class has an empty kDoc");
    if (!silent.empty())
      return say(false, type, "documents",
                 "what these fields are is not said: " + silent + "; give `FieldList::add` a text for each");
    const std::size_t own = type.fields.size() - (type.role == hal::Role::Sensor ? 2 : 0);  // taken_ns, validity
    if (own == 0) return say(false, type, "documents", "it describes no field: nobody can record or compare it");
    say(true, type, "documents", fmt::format("{} field{}, each with unit and text", own, own == 1 ? "" : "s"));
  }

  /// The default is safe, and whatever a controller writes becomes safe.
  void judge_safety(const hal::PortType& type) {
    if (type.role == hal::Role::Sensor) return;
    if (!hal::all_finite(type, type.initial)) return say(false, type, "limits", "its default is no finite number");
    if (type.limit == nullptr) return say(true, type, "limits", "it says that any value is safe");
    std::vector<std::max_align_t> memory(type.size / sizeof(std::max_align_t) + 1);
    void* const command = memory.data();
    hal::Limited what;
    int kinds = 0;
    for (const hal::RobotKind* kind : catalog_.all<hal::RobotKind>()) {
      if (!carries(*kind, type)) continue;
      ++kinds;
      type.reset(command);
      if (type.limit(command, 0, 1, *kind, what) != 1)
        return say(false, type, "limits", fmt::format("its default is not within the limits of '{}'", kind->name));
      hal::Random random(static_cast<std::uint64_t>(kinds));
      for (int i = 0; i < 1000; ++i) {
        command_at_random(type, command, random);
        type.limit(command, 0, 1, *kind, what);
        if (!hal::all_finite(type, command))
          return say(false, type, "limits", "it lets through what is no finite number: " + hal::to_text(type, command));
        if (type.limit(command, 0, 1, *kind, what) != 1)
          return say(false, type, "limits",
                     "what it has made safe it makes safe once more: " + hal::to_text(type, command));
      }
    }
    if (kinds == 0)
      all_.push_back({Verdict::NotJudged, "port '" + type.catalog_name() + "'", "limits",
                      "there is no kind of robot here that carries it"});
    else
      say(true, type, "limits", "the default is safe; 1000 random commands became safe");
  }
  bool carries(const hal::RobotKind& kind, const hal::PortType& port) const {
    for (const core::DeviceType* type : catalog_.all<core::DeviceType>()) {
      if (type->device == port.name && type->role == port.role && type->fits(kind)) return true;
    }
    return false;
  }

  void judge_device(const core::DeviceType& type) {
    const bool made = type.role == hal::Role::Sensor ? type.make_sensor != nullptr : type.make_actuator != nullptr;
    if (!made || type.fits == nullptr || type.describe == nullptr)
      return say(false, type, "table",
                 fmt::format("its table lacks a function: make it with {}",
                             type.role == hal::Role::Sensor ? "sensor_type" : "actuator_type"));
    if (catalog_.find<hal::PortType>(hal::port_entry(type.device, type.role)) == nullptr)
      return say(false, type, "table",
                 "nobody registers its port: add hal::port_type<…>() of the class that it fills or drains");
    if (core::find_device(catalog_, type.device, type.role, "default") == nullptr)
      return say(false, type, "table", "no implementation of it is called 'default', which files mean that name none");
    if (!type.medium.empty() && catalog_.find<core::MediumType>(type.medium) == nullptr)
      return say(false, type, "table", fmt::format("it works in the medium '{}', which is not here", type.medium));
  }

  void judge_engine(const core::EngineType& type) {
    const auto* const known = catalog_.find<core::KnownEngine>(type.kind);
    if (known == nullptr) return say(false, type, "table", "files cannot name it: add it with core::register_engine");
    if (type.read == nullptr || type.describe == nullptr || type.make == nullptr)
      return say(false, type, "table", "its table lacks one of read, describe and make");
    const core::EngineTraits &a = known->traits, &b = type.traits;
    say(a.plane == b.plane && a.air == b.air && a.forces == b.forces && a.joints == b.joints, type, "table",
        "its traits are those by which files are checked");
  }

  void judge_bridge(const bridges::BridgeType& type) {
    if (type.make == nullptr || type.check == nullptr)
      return say(false, type, "table", "its table lacks make or check");
    const auto* const kind = catalog_.find<hal::RobotKind>(type.name);
    if (kind == nullptr)
      return say(false, type, "table", fmt::format("there is no kind of robots '{}': register it", type.name));
    const bool stops = catalog_.find<bridges::guardian::StopperType>(type.name) != nullptr;
    say(stops, type, "stopper",
        stops ? "the guardian can stop such robots when the hub is gone"
              : "nobody stops such robots when the hub dies or freezes: register a guardian::StopperType of that kind");
    bridges::BridgeRequest request;
    request.kind = type.name;
    request.robot_kind = kind;
    request.robot = "r";
    request.link = "nonsense";
    const hal::Status refused = type.check(request);
    say(!refused.ok(), type, "links",
        refused.ok() ? "it accepts the link 'nonsense': check what people write, so that it is told before the run"
                     : "what is no link is refused: " + refused.error().message);
  }

  void judge_emulator(const bridges::EmulatorType& type) {
    if (type.run == nullptr || type.read == nullptr || type.needs == nullptr || type.ports == nullptr)
      return say(false, type, "table", "its table lacks one of run, read, needs and ports");
    const bool kind = type.kind.empty() || catalog_.find<hal::RobotKind>(type.kind) != nullptr;
    say(kind, type, "table", kind ? "complete" : fmt::format("there is no kind of robots '{}'", type.kind));
  }

  const hal::Catalog& catalog_;
  const std::string& origin_;
  Judgements& all_;
};

}  // namespace

void judge_tables(const hal::PluginLoader& loader, const std::string& origin, Judgements& all) {
  Tables(loader.catalog(), origin, all).judge();
}

Judgements judge_plugin(hal::PluginLoader& loader, const std::string& origin) {
  Judgements all;
  judge_tables(loader, origin, all);
  for (const Judgement& judgement : all) {
    if (judgement.what == "table" && judgement.verdict == Verdict::Fault) return all;  // no world could be made of it
  }
  judge_in_worlds(loader, origin, all);
  return all;
}

}  // namespace tandem::app
