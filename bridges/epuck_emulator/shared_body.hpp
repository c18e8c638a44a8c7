// A body that lives elsewhere: a robot of a simulated space puts its senses in and takes the commands out.
#pragma once
#include <mutex>

#include "bridges/epuck_emulator/body.hpp"

namespace tandem::bridges::epuck_emulator {

/// A mailbox between the emulator's thread and the simulator's. Every function may be called from any thread.
class SharedBody final : public EmulatedBody {
 public:
  /// The simulator's side: what the robot senses from now on.
  void set_senses(const BodySenses& senses);
  /// The simulator's side: what the firmware commands at this moment.
  BodyCommand command() const;

  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;

 private:
  mutable std::mutex guard_;
  BodySenses senses_;
  BodyCommand command_;
};

}  // namespace tandem::bridges::epuck_emulator
