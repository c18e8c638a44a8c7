// A body that lives elsewhere: a robot of a simulated space puts its senses in and takes the commands out.
#pragma once
#include <mutex>

#include "bridges/eyebot_emulator/body.hpp"

namespace tandem::bridges::eyebot_emulator {

/// A mailbox between the emulator's thread and the simulator's. Every function may be called from any thread.
class SharedBody final : public EmulatedBody {
 public:
  /// The simulator's side: what the robot senses from now on, and what it has just heard.
  void set_senses(const BodySenses& senses, const std::vector<Heard>& heard = {});
  /// The simulator's side: what the firmware commands at this moment.
  BodyCommand command() const;

  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;
  std::vector<Heard> take_heard() override;

 private:
  static constexpr std::size_t kMostHeard = 256;  // older ones are lost, as on a board that nobody reads

  mutable std::mutex guard_;
  BodySenses senses_;
  BodyCommand command_;
  std::vector<Heard> heard_;
};

}  // namespace tandem::bridges::eyebot_emulator
