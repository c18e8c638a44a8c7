// The hub's side of the guardian process, which stops all real robots when the hub is killed, crashes, or freezes.
//
//   auto guardian = GuardianClient::start(types, …);     before any thread, link and plug-in
//   guardian->claim(robots);                              one hub a robot: the other one is named
//   openers and bridges get guardian->permit();           a hub that was declared dead writes to no link
//   guardian->watch(messages);                            whenever a robot's stop messages changed, before it is driven
//   guardian->release(id);                                its stop was confirmed
//   guardian->end(2 s);                                   what was not released is stopped by the guardian, or named
//
// Hub and guardian watch one another, and each itself (bridges/guardian/pulse.hpp). After a freeze of either, or of
// both at once, no link may be written to until the guardian has seen every robot confirm its stop, or a second after
// the hub is back. Links that were open report that they hung up, so bridges reopen them and begin as after any
// outage: stopped, and driving only after the ordinary way back.
#pragma once
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bridges/guardian/pulse.hpp"
#include "bridges/guardian/stopper.hpp"
#include "bridges/send_permit.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::guardian {

struct GuardianOptions {
  /// Set by the handler of SIGTSTP: the robots are stopped, and then this process. Null: Ctrl-Z is as any other
  /// freeze.
  std::atomic<bool>* suspend_asked = nullptr;
  PulseLimits limits = {};
};

/// How often this program was declared dead or found itself frozen, and ran on, and for how long the last time. Also
/// counted is a guardian that was frozen itself and has stopped all robots since: nothing may move until re-armed.
struct Freezes {
  std::uint64_t count = 0;
  hal::TimeNs last_ns = 0;
};

/// A robot whose stop the guardian has not seen confirmed.
struct UnstoppedRobot {
  std::string robot;
  std::string link;
  std::string trouble;  ///< what the guardian knows
};

/// Thread-safe. Owns the guardian process and a thread, the heart.
class GuardianClient {
 public:
  /// Forks: call it before any other thread exists. Error: no process can be made; says what a killed hub would leave
  /// behind.
  static hal::Result<std::unique_ptr<GuardianClient>> start(std::vector<StopperType> types,
                                                            const GuardianOptions& options = {});
  /// As `end`, without waiting for robots.
  ~GuardianClient();
  GuardianClient(const GuardianClient&) = delete;
  GuardianClient& operator=(const GuardianClient&) = delete;

  /// Locks these robots for this hub, before their links are opened; their bodies may be empty yet. A robot that is
  /// still being stopped for a hub that is gone is taken over. Error: another hub drives one (names it), two have the
  /// same link, no `StopperType` suits, or the guardian is gone.
  hal::Status claim(std::span<const StopMessages> robots);
  /// As `claim`: what became of each, in their order. Refused ones keep no others from being watched.
  std::vector<hal::Status> claim_each(std::span<const StopMessages> robots);
  /// From now on this robot, which was claimed, is stopped in this way when the hub dies or freezes. Does nothing where
  /// that is what the guardian knows already.
  void watch(const StopMessages& robot);
  /// The robot rests, or was never driven: nothing to do for it. A later `watch` has it guarded again; its id and its
  /// link may be claimed again.
  void release(const std::string& robot);

  /// For links and bridges. Refers to memory that is never freed.
  SendPermit permit() const noexcept;
  Freezes freezes() const noexcept;
  /// The guardian process lives, and is not frozen. Else nobody would stop robots of a killed hub: they must not move.
  bool guards() const noexcept;
  pid_t process() const noexcept;
  /// Notices to people since the last call.
  std::vector<std::string> take_news();

  /// Ends in order: robots that were not released are stopped by the guardian; waits at most `timeout_ns` for them.
  /// Links must be closed. @returns those that have not confirmed; the guardian goes on with them after this process
  /// has ended.
  std::vector<UnstoppedRobot> end(hal::TimeNs timeout_ns);

 private:
  class Heart;
  explicit GuardianClient(std::unique_ptr<Heart> heart);
  std::unique_ptr<Heart> heart_;
};

}  // namespace tandem::bridges::guardian
