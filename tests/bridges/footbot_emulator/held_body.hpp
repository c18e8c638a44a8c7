// A body that senses and hears what a test says, and keeps what it is told.
#pragma once
#include <utility>
#include <vector>

#include "bridges/footbot_emulator/body.hpp"
#include "tests/bridges/held_body.hpp"

namespace tandem::bridges::footbot_emulator {

class HeldBody final : public HeldBodyOf<EmulatedBody, BodySenses, BodyCommand> {
 public:
  using HeldBodyOf::set_senses;
  void set_senses(const BodySenses& senses, const std::vector<Heard>& heard) {
    set_senses(senses);
    const std::lock_guard lock(guard_);
    heard_.insert(heard_.end(), heard.begin(), heard.end());
  }
  std::vector<Heard> take_heard() override {
    const std::lock_guard lock(guard_);
    return std::exchange(heard_, {});
  }

 private:
  std::vector<Heard> heard_;
};

}  // namespace tandem::bridges::footbot_emulator
