// A body that senses what a test says, and keeps what it is told.
#pragma once
#include <mutex>

#include "bridges/epuck_emulator/body.hpp"

namespace tandem::bridges::epuck_emulator {

/// Every function may be called from any thread.
class HeldBody final : public EmulatedBody {
 public:
  void set_senses(const BodySenses& senses) {
    const std::lock_guard lock(guard_);
    senses_ = senses;
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

 private:
  mutable std::mutex guard_;
  BodySenses senses_;
  BodyCommand command_;
};

}  // namespace tandem::bridges::epuck_emulator
