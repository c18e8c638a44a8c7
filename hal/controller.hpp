// Robot controllers: what a behaviour is written against.
#pragma once
#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>

#include "hal/archive.hpp"
#include "hal/controls.hpp"
#include "hal/params.hpp"
#include "hal/robot.hpp"

namespace tandem::hal {

/// A robot's control program. Takes its devices in its constructor and keeps references to them.
///
/// A simulation can be put back to an earlier moment where its controllers can be copied: members then are values, or
/// share what no step changes. A copy drives the same robot through the same ports, never at the same time.
///
/// It can go on in another process, from a checkpoint on disk, where the class is such and owns no memory (no vector,
/// no long text), or says what it remembers: `void remember(hal::Archive& a) { a(recent_, turns_); }`.
class Controller {
 public:
  virtual ~Controller() = default;

  /// One control step: reads its sensors, writes its actuators. May run on any thread; must not block.
  /// An exception that leaves it stops the robot, by name.
  virtual void step() = 0;

  /// The run begins anew, with this robot behind the same ports; its id and its chance may be others than before. True:
  /// done, and what was not reset is kept (something learned, say). False: this object is destroyed and another
  /// constructed in its place.
  virtual bool reset(Robot& /*robot*/) { return false; }

  /// Declares what people may change while the run goes on. Called between steps; the values are members, so that
  /// copies have them.
  virtual void controls(Controls& /*controls*/) {}
};

/// Result of stepping a row of controllers: who threw, if anybody.
struct StepFault {
  std::size_t index = 0;  ///< which of the row; while the row steps: who is stepping
  std::string message;
};

/// A class of controllers as the worlds see it: a table of functions, one call a row and not a robot.
struct ControllerType {
  static constexpr std::string_view kCategory = "controller";
  static constexpr std::uint32_t kNumber = 3;
  using Crosses = Layouts<Controller, Robot, StepFault, ParamVisitor, ParamList, Controls, PublishedField, RobotLog,
                          Random, PortType, RowType, Field, RobotKind, RobotKind::Crosses>;
  std::string_view name;  ///< as written in experiment files
  std::string_view summary;
  std::string_view class_name;  ///< as the compiler spells it, for hooks that know the class
  std::size_t size = 0;
  std::size_t align = 0;
  /// Reads the parameters once for all robots of one configuration.
  std::shared_ptr<const void> (*read_params)(ParamVisitor&) = nullptr;
  /// Constructs one controller in `where`. @throws whatever its constructor throws
  Controller* (*construct)(void* where, Robot& robot, const void* params) = nullptr;
  /// Steps `count` controllers that lie `stride` bytes apart, but those whose `halted` is not 0. Stops at the first
  /// that throws: returns its index and fills `fault`; returns `count` when none did. Stores each index in
  /// `fault.index` before its step, so that another thread can tell who does not return.
  std::size_t (*step_row)(std::byte* first, std::size_t stride, std::size_t begin, std::size_t count,
                          const std::uint8_t* halted, StepFault& fault) = nullptr;
  void (*destroy)(void* controller) = nullptr;
  /// Calls Controller::reset. @throws whatever it throws
  bool (*reset)(void* controller, Robot& robot) = nullptr;
  /// Constructs in `where` a copy of the controller at `from`, for snapshots. Null where the class has no copy
  /// constructor. @throws whatever its copy constructor throws
  void (*copy)(void* where, const void* from) = nullptr;
  /// Calls Controller::controls. @throws whatever it throws
  void (*controls)(void* controller, Controls& controls) = nullptr;
  /// Calls T::remember: writes all that its steps change, or reads it into a controller that was just made. Null where
  /// the class has none.
  void (*remember)(void* controller, Archive& archive) = nullptr;
};

namespace detail {

/// "tandem::controllers::EpuckDiffusion": the same text in every library that one compiler built.
template <class T>
constexpr std::string_view class_name() noexcept {
  const std::string_view all = __PRETTY_FUNCTION__;  // "… [with T = X; std::string_view = …]" or "… [T = X]"
  const std::size_t begin = all.find("T = ") + 4;
  const std::size_t end = all.find_first_of(";]", begin);
  return all.substr(begin, end - begin);
}

struct NoParams {
  void describe(ParamVisitor&) {}
};

template <class T>
auto params_of() {
  if constexpr (requires { typename T::Params; })
    return typename T::Params{};
  else
    return NoParams{};
}

template <class T>
std::size_t step_row(std::byte* first, std::size_t stride, std::size_t begin, std::size_t count,
                     const std::uint8_t* halted, StepFault& fault) {
  std::size_t i = begin;
  try {
    for (; i < count; ++i) {
      if (halted[i] != 0) continue;
      __atomic_store_n(&fault.index, i, __ATOMIC_RELAXED);
      std::launder(reinterpret_cast<T*>(first + i * stride))->T::step();
    }
    return count;
  } catch (const std::exception& e) {
    fault.message = e.what();
  } catch (...) {
    fault.message = "an exception of unknown type";
  }
  fault.index = i;
  return i;
}

}  // namespace detail

/// The table of controller class `T`: constructed from `(Robot&, const T::Params&)`, or `(Robot&)` where it has no
/// Params.
template <class T>
const ControllerType& controller_type(std::string_view name, std::string_view summary) {
  using Params = decltype(detail::params_of<T>());
  static ControllerType type;
  type.name = name;
  type.summary = summary;
  type.class_name = detail::class_name<T>();
  type.size = sizeof(T);
  type.align = alignof(T);
  type.read_params = [](ParamVisitor& visitor) -> std::shared_ptr<const void> {
    auto params = std::make_shared<Params>();
    params->describe(visitor);
    return params;
  };
  type.construct = [](void* where, Robot& robot, const void* params) -> Controller* {
    if constexpr (std::is_constructible_v<T, Robot&, const Params&>) {
      return ::new (where) T(robot, *static_cast<const Params*>(params));
    } else {
      return ::new (where) T(robot);
    }
  };
  type.step_row = &detail::step_row<T>;
  type.destroy = [](void* controller) { static_cast<T*>(controller)->~T(); };
  type.reset = [](void* controller, Robot& robot) { return static_cast<T*>(controller)->T::reset(robot); };
  type.controls = [](void* controller, Controls& controls) { static_cast<T*>(controller)->T::controls(controls); };
  if constexpr (std::is_copy_constructible_v<T>)
    type.copy = [](void* where, const void* from) { ::new (where) T(*static_cast<const T*>(from)); };
  if constexpr (requires(T & t, Archive & a) { t.remember(a); })
    type.remember = [](void* controller, Archive& archive) { static_cast<T*>(controller)->remember(archive); };
  return type;
}

}  // namespace tandem::hal
