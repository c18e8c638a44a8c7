// What physics engines can do, as checks and messages ask for it: none goes by an engine's name.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

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

/// A kind of engine that this program has.
struct KnownEngine {
  std::string name;        ///< of its element in experiment files
  std::string argos_name;  ///< of its element in ARGoS 3's files, if that is another
  EngineTraits traits;
};

/// Of those that fit, for messages: "a, b", or that there is none.
std::string engines_that(const std::vector<KnownEngine>& engines, const std::function<bool(const EngineTraits&)>& fit);
/// "fixed and turning", in words.
std::string words_of(JointKinds kinds);

}  // namespace tandem::core
