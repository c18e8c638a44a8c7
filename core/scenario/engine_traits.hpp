// Abilities of physics engines, as checks and messages ask for them: none goes by an engine's name.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "hal/catalog.hpp"

namespace tandem::core {

/// In which ways two bodies may be held together.
enum class JointKind : std::uint8_t {
  Fixed,
  Turning,  ///< about the vertical
  Sliding   ///< along an axis
};

/// Bits of the kinds of joints that an engine has, or that something needs.
using JointKinds = std::uint8_t;
constexpr JointKinds bit(JointKind kind) noexcept {
  return static_cast<JointKinds>(1U << static_cast<unsigned>(kind));
}
inline constexpr JointKinds kEveryJoint = bit(JointKind::Fixed) | bit(JointKind::Turning) | bit(JointKind::Sliding);

struct EngineTraits {
  bool plane = true;      ///< bodies stay on the ground: it cannot carry robots that fly
  bool air = false;       ///< made for flying robots: its region may lie over one for robots on the ground
  bool forces = false;    ///< knows masses: moves objects
  JointKinds joints = 0;  ///< that it can hold bodies together with

  bool has(JointKinds kinds) const noexcept { return (joints & kinds) == kinds; }
};

/// A kind of engine, as far as files are read and checked by it; the first of a catalog is that of files that name
/// none.
struct KnownEngine {
  static constexpr std::string_view kCategory = "engine traits";
  using Crosses = hal::Layouts<EngineTraits>;
  std::string_view kind;        ///< the element's name in experiment files
  std::string_view argos_name;  ///< … in ARGoS 3's, if that is another
  EngineTraits traits;

  std::string_view catalog_name() const noexcept { return kind; }
};

/// Those of the catalog that fit, for messages: "a, b", or that there is none.
std::string engines_that(const hal::Catalog& catalog, const std::function<bool(const EngineTraits&)>& fit);
/// "fixed and turning", in words.
std::string words_of(JointKinds kinds);

}  // namespace tandem::core
