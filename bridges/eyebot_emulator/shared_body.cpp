#include "bridges/eyebot_emulator/shared_body.hpp"

#include <utility>

namespace tandem::bridges::eyebot_emulator {

void SharedBody::set_senses(const BodySenses& senses, const std::vector<Heard>& heard) {
  const std::lock_guard lock(guard_);
  senses_ = senses;
  heard_.insert(heard_.end(), heard.begin(), heard.end());
  if (heard_.size() > kMostHeard) heard_.erase(heard_.begin(), heard_.end() - kMostHeard);
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

std::vector<Heard> SharedBody::take_heard() {
  const std::lock_guard lock(guard_);
  return std::exchange(heard_, {});
}

}  // namespace tandem::bridges::eyebot_emulator
