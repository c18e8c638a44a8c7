// A body that senses what a test says, and keeps what it is told.
#pragma once
#include <mutex>

#include "hal/time.hpp"

namespace tandem::bridges {

/// For the bodies of all emulators. Every function may be called from any thread.
template <class EmulatedBody, class BodySenses, class BodyCommand>
class HeldBodyOf : public EmulatedBody {
 public:
  void set_senses(const BodySenses& senses) {
    const std::lock_guard lock(guard_);
    senses_ = senses;
  }
  BodyCommand command() const {
    const std::lock_guard lock(guard_);
    return command_;
  }

  BodySenses sense(hal::TimeNs /*now*/) final {
    const std::lock_guard lock(guard_);
    return senses_;
  }
  void actuate(hal::TimeNs /*now*/, const BodyCommand& command) final {
    const std::lock_guard lock(guard_);
    command_ = command;
  }

 protected:
  mutable std::mutex guard_;

 private:
  BodySenses senses_;
  BodyCommand command_;
};

}  // namespace tandem::bridges
