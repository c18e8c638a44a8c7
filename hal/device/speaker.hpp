// Speaker: a tone that the robot sounds.
#pragma once
#include <string>

#include "hal/port.hpp"

namespace tandem::hal {

/// The tone that sounds as long as this is said. Safe value: silence.
struct Speaker : Command {
  static constexpr std::string_view kName = "speaker";
  static constexpr std::string_view kDoc = "A tone, as long as it is commanded.";
  static constexpr bool kAnyValueIsSafe = true;

  float tone_Hz = 0.0F;  ///< 0: silence

  void describe(FieldList& f) const {
    f.add("tone", tone_Hz, unit::none, Frame::None, Fusion::Real, "frequency in Hz; 0 is silence");
  }
};

/// A speaker.
struct SpeakerPart {
  static constexpr std::string_view kName = "speaker";
  static constexpr std::string_view kDoc = "A speaker.";
  std::string source = {};
  void describe(ParamVisitor& v) { v.text("source", source, "How this is known."); }
};

}  // namespace tandem::hal
