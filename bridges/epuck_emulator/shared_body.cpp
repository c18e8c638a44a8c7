#include "bridges/epuck_emulator/shared_body.hpp"

namespace tandem::bridges::epuck_emulator {

void SharedBody::set_senses(const BodySenses& senses) {
  const std::lock_guard lock(guard_);
  senses_ = senses;
}

BodyCommand SharedBody::command() const {
  const std::lock_guard lock(guard_);
  return command_;
}

BodySenses SharedBody::sense(hal::TimeNs /*now*/) {
  const std::lock_guard lock(guard_);
  return senses_;
}

void SharedBody::actuate(hal::TimeNs /*now*/, const BodyCommand& command) {
  const std::lock_guard lock(guard_);
  command_ = command;
}

}  // namespace tandem::bridges::epuck_emulator
