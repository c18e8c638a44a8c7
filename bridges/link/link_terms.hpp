// The terms on which a link is opened: who may speak through it, and beside whom.
#pragma once
#include "bridges/send_permit.hpp"
#include "hal/result.hpp"

namespace tandem::bridges {

struct LinkTerms {
  /// Asked before each write. A link whose permit was withdrawn has hung up, for good.
  SendPermit permit = {};
  /// Also where the device is held already: a guardian speaks while its frozen hub still has it open.
  bool beside = false;
};

/// Why a link cannot be opened at present.
inline hal::Error not_permitted() {
  return hal::Error{"this program was frozen, and its guardian process is stopping the robot"};
}

}  // namespace tandem::bridges
