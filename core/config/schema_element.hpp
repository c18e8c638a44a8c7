// Beginnings of descriptions of elements of experiment files.
#pragma once
#include <string_view>

#include "hal/params.hpp"

namespace tandem::core::schema {

using hal::kAny;
using hal::kNotNegative;
using hal::ParamVisitor;
namespace unit = hal::unit;

inline constexpr double kLargestArena_m = 1e6;
inline constexpr double kLargestQuantity = 1e8;
inline constexpr double kSmallest_m = 1e-6;

inline constexpr std::string_view kAnything = "*";         ///< as children: any element
inline constexpr std::string_view kRobotKind = "ROBOT";    ///< in children: every kind of robot that the program knows
inline constexpr std::string_view kFieldKind = "FIELD";    ///< … every field of which files say something
inline constexpr std::string_view kMediumKind = "MEDIUM";  ///< … and every kind of medium
inline constexpr std::string_view kObserverKind = "OBSERVER";  ///< … and of observer
inline constexpr std::string_view kRunPartKind = "RUN_PART";   ///< … and of part that joins a run
inline constexpr std::string_view kTrackerKind = "TRACKER";    ///< … and of tracker

/// What an element is and holds. Lists are names separated by spaces.
struct ElementInfo {
  std::string_view name;  ///< as written; "configuration" and "robot" stand for names of controllers and of kinds
  std::string_view doc;
  std::string_view required = {};
  std::string_view children = {};
};

/// What has no attributes.
struct Bare {
  void describe(ParamVisitor&) {}
};

}  // namespace tandem::core::schema
