// Hooks: code of the experiment around the robots (ARGoS calls them loop functions).
#pragma once
#include <any>
#include <memory>
#include <optional>
#include <string>

#include "core/hook/measures.hpp"
#include "core/scenario/element.hpp"
#include "core/space/ids.hpp"
#include "core/space/sketch.hpp"
#include "core/space/space.hpp"
#include "hal/archive.hpp"
#include "hal/controls.hpp"
#include "hal/plugin.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

struct Scenario;  // core/scenario/scenario.hpp

/// Lets a hook keep moments of the run and go back to them. Requests take effect when the current step is over (those
/// of `before_run`: before the first step), in the order in which they were made; those of `after_run` have none.
class Checkpoints {
 public:
  virtual ~Checkpoints() = default;

  /// Keeps the moment under this name, replacing an earlier one. A moment that cannot be kept (World::snapshot says
  /// when) ends the run, and says why.
  virtual void save(const std::string& name) = 0;
  /// Goes back: the next step is the one that followed the moment. Robots, objects, controllers, time and what hooks
  /// hand out in `Hook::save` are then as they were. Errors: there is no moment of that name.
  virtual hal::Status restore(const std::string& name) = 0;
  /// Begins the run again with this seed: World::reset. What hooks made is gone, checkpoints too. Of those of
  /// `before_run`, which would never end, the run fails.
  virtual void reset(std::uint64_t seed) = 0;
};

/// Context of a hook: the whole simulated state, to read and to change, and the place in the run.
struct HookContext {
  Space& space;
  hal::Tick tick = 0;  ///< the step about to run, or just run
  std::int64_t ticks_per_second = 10;
  std::uint64_t seed = 0;
  Checkpoints& checkpoints;
  Sketch& sketch;
  Measures& measures;
  const Scenario& scenario;  ///< what runs

  /// The robot's controller, to look at and to change between steps; null when it is of another class or the robot is
  /// gone. Both plug-ins must be built from the same header of the class.
  /// @throws std::runtime_error when the classes have one name and different sizes: one of them is to be rebuilt
  template <class T>
  T* controller(RobotId robot) const {
    return static_cast<T*>(space.controller(robot, hal::detail::class_name<T>(), sizeof(T)));
  }
};

/// Called from the thread that steps the world, never during a parallel phase. An exception ends the run, by name.
class Hook {
 public:
  virtual ~Hook() = default;

  virtual void before_run(HookContext&) {}
  virtual void before_step(HookContext&) {}
  /// Bodies have moved, and sensors and controllers have their turn next: they see changes made here. Robots that
  /// are added here sense and step in this tick.
  virtual void before_sense(HookContext&) {}
  virtual void after_step(HookContext&) {}
  /// Asked after every step; true ends the run.
  virtual bool is_done(HookContext&) { return false; }
  virtual void after_run(HookContext&) {}
  /// The run starts again, with another seed perhaps; `before_run` follows. True: the hook is at its start again, and
  /// remembers what it wants to (the best run so far, say). False: it is destroyed and made again.
  virtual bool reset(std::uint64_t /*seed*/) { return false; }

  /// Reflectance of the floor at (x, y) in W, 0 black to 1 white; none: the hook leaves what is there. Asked once a
  /// floor pixel when the file says `<floor source="loop_functions"/>`, and again after `Space::repaint_floor`. Hooks
  /// paint in the order of the file, each over those before it; what none paints is grey.
  virtual std::optional<double> floor(double /*x_m*/, double /*y_m*/) { return std::nullopt; }
  /// The same of any field that hooks paint.
  virtual std::optional<double> field(std::string_view name, double x_m, double y_m) {
    return name == "floor" ? floor(x_m, y_m) : std::nullopt;
  }

  /// What the hook remembers that its later calls depend on, for snapshots; and taking it back. A hook without such
  /// needs neither. What `save` leaves out survives going back: a count of attempts, say.
  virtual std::any save() const;
  virtual void restore(const std::any& saved);

  /// Declares what people may change while the run goes on. Called between steps; snapshots keep the values.
  virtual void controls(HookContext&, hal::Controls& /*controls*/) {}

  /// The same as `save` and `restore`, which then need not be there: names all that is to be remembered, and returns
  /// true. Also for checkpoints on disk, so only what it names is there after them; `before_run` is called before.
  /// False: the hook does not say, and its run is computed again from the start.
  virtual bool remember(hal::Archive& /*archive*/) { return false; }
};

inline std::any Hook::save() const {
  hal::Archive archive;
  if (!const_cast<Hook*>(this)->remember(archive)) return {};  // which writes
  return archive.take();
}

inline void Hook::restore(const std::any& saved) {
  const auto* const bytes = std::any_cast<std::string>(&saved);  // of a hook with `save` alone: anything else
  if (bytes == nullptr) return;
  hal::Archive archive(*bytes);
  remember(archive);
}

/// A class of hooks: what a plug-in registers.
struct HookType {
  static constexpr std::string_view kCategory = "hook";
  static constexpr std::uint32_t kNumber = 7;
  using Crosses =
      hal::Layouts<Hook, HookContext, Space, Checkpoints, Sketch, Sketch::Shape, Sketch::Point, Measures, Element,
                   Problem, hal::ParamVisitor, hal::Controls, hal::RobotKind, hal::RobotKind::Crosses>;
  std::string_view name;
  std::string_view summary;
  /// Reads its options from the file; problems are reported with their lines.
  std::unique_ptr<Hook> (*make)(const Element& options, Problems& problems) = nullptr;
  /// Shows its parameters to `visitor`, for the manual. Null: it reads its element by itself.
  void (*describe)(hal::ParamVisitor& visitor) = nullptr;
  /// Of the program itself: whether a world with such a controller has one, after those of the file. Null: none has.
  bool (*comes_with)(const hal::ControllerType& controller) = nullptr;
};

/// The table of hook class `T`, constructed from `(const T::Params&)`.
template <class T>
const HookType& hook_type(std::string_view name, std::string_view summary) {
  static HookType type;
  type.name = name;
  type.summary = summary;
  type.make = [](const Element& options, Problems& problems) -> std::unique_ptr<Hook> {
    return std::make_unique<T>(read_settings<typename T::Params>(options, problems, {"library", "label"}));
  };
  type.describe = [](hal::ParamVisitor& visitor) {
    typename T::Params params;
    params.describe(visitor);
  };
  return type;
}

}  // namespace tandem::core
