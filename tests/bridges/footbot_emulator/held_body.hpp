// A body that senses what a test says, and keeps what it is told.
#pragma once
#include <mutex>
#include <utility>
#include <vector>

#include "bridges/footbot_emulator/body.hpp"

namespace tandem::bridges::footbot_emulator {

/// Every function may be called from any thread.
class HeldBody final : public EmulatedBody {
 public:
  void set_senses(const BodySenses& senses, const std::vector<Heard>& heard = {}) {
    const std::lock_guard lock(guard_);
    senses_ = senses;
    heard_.insert(heard_.end(), heard.begin(), heard.end());
  }
  BodyCommand command() const {
    const std::lock_guard lock(guard_);
    return command_;
  }

  BodySenses sense(hal::TimeNs /*now*/) override {
    const std::lock_guard lock(guard_);
    return senses_;
  }
  void actuate(hal::TimeNs /*now*/, const BodyCommand& command) override {
    const std::lock_guard lock(guard_);
    command_ = command;
  }
  std::vector<Heard> take_heard() override {
    const std::lock_guard lock(guard_);
    return std::exchange(heard_, {});
  }

 private:
  mutable std::mutex guard_;
  BodySenses senses_;
  BodyCommand command_;
  std::vector<Heard> heard_;
};

}  // namespace tandem::bridges::footbot_emulator
