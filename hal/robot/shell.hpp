// The looks of the bodies of the program's robots, as a part that kinds from files may have, too.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "hal/robot_kind.hpp"

namespace tandem::hal {

/// The body, wheels or rotors of a robot as its owner knows it. Changes the picture alone.
struct ShellPart {
  static constexpr std::string_view kName = "shell";
  static constexpr std::string_view kDoc = "The look of body and wheels or rotors; without it they are a drum.";
  static constexpr std::array<std::string_view, 4> kForms = {"e-puck", "eye-bot", "foot-bot", "thymio"};
  std::string of = "e-puck";  ///< of kForms
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.choice("of", of, kForms, "The robot whose shell it is.");
    v.text("source", source, "Where its form comes from.");
  }
  void appear(const RobotKind& kind, Appearance& look) const;
};

}  // namespace tandem::hal
