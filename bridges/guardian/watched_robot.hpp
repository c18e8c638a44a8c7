// One robot in the guardian process: its locks, its stop messages, and the thread that stops it.
#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "bridges/guardian/packet.hpp"
#include "bridges/guardian/robot_lock.hpp"
#include "bridges/guardian/same_robot.hpp"
#include "bridges/guardian/stopper.hpp"

namespace tandem::bridges::guardian {

/// State shared by the threads; it outlives them.
struct GuardianContext {
  std::span<const StopperType> types;
  std::string folder;                             ///< of the locks
  pid_t hub = 0;                                  ///< whose robots these are
  std::function<void(const Packet&)> say_to_hub;  ///< from any thread
  std::function<void()> wake;                     ///< has the main loop look at all robots
};

/// Calls come from the guardian's main loop and never wait for the robot. The thread sleeps until there is a claim or a
/// stop, so that a death makes no thread: it might be refused then.
class WatchedRobot {
 public:
  /// The first claim. `context` outlives this.
  WatchedRobot(const GuardianContext& context, const StopMessages& robot);
  /// The process must end without destroying this, or after `let_go`.
  ~WatchedRobot();
  WatchedRobot(const WatchedRobot&) = delete;
  WatchedRobot& operator=(const WatchedRobot&) = delete;

  /// Makes the thread; Claimed is said when the lock is taken or refused. Error: the system has no thread for it.
  hal::Status start();

  void watch(const StopMessages& robot);
  void release();
  /// Begins to stop it, or starts again. Nothing happens where it was released or never watched.
  void stop(StopCause cause);
  /// Ends stopping: the link is closed soon.
  void hold();
  /// Nobody of us has to do with it any more: stops nothing, frees all locks.
  void let_go();
  /// Another hub's guardian asks for these locks, to find out who is there: its hub speaks with whoever answers, and we
  /// do not. The robot stays ours until that hub has found the very same one.
  void lend(const std::vector<std::string>& keys, pid_t guardian);

  struct View {
    bool to_be_stopped = false;  ///< watched, not released, not let go
    bool idle = true;            ///< no stopper has a link open
    bool given_up = false;       ///< released, or its claim was refused: not driven
    bool confirmed = false;      ///< the stop that was begun last, by this very robot
    bool line_lost = false;      ///< its link leads to another robot now, as `trouble` says
    std::string handed_over;     ///< to whom, for people; "": it is ours
    StopState state = StopState::Unreachable;
    std::string trouble;
    std::string robot, link;
  };
  View view() const;
  const StopMessages& claimed() const noexcept { return claimed_; }
  bool has_one_of(const std::vector<std::string>& keys) const;

 private:
  enum class Claim : std::uint8_t { Due, Held, Refused };

  void run();
  void take_locks();
  void take_address_lock();
  std::string try_to_lock();
  std::string refusal(const LockHolder* holder, bool asked) const;
  bool line_is_ours();
  bool lent(hal::TimeNs now);
  bool give_up_line(const std::string& why);
  void stop_robot(std::unique_lock<std::mutex>& lock);
  std::unique_ptr<Stopper> make_stopper() const;
  void write_lock_files() const;

  const GuardianContext& context_;
  const StopMessages claimed_;
  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable wake_;
  StopMessages robot_;
  RobotLocks locks_;
  RobotLocks left_;  // of our own: what we owe, whichever process has the line
  std::vector<std::string> lent_keys_;
  pid_t lent_to_ = 0;  // 0: none
  hal::TimeNs lent_until_ns_ = 0;
  bool address_due_ = false;  // it was found out, and has no lock yet
  RobotTrace trace_;
  bool line_lost_ = false;
  std::string handed_over_;
  Claim claim_ = Claim::Due;
  bool watched_ = false, released_ = false, quit_ = false;
  bool stopping_ = false;     // wanted
  std::uint64_t order_ = 0;   // grows with each stop, hold, and new message
  std::uint64_t obeyed_ = 0;  // the order that the thread has finished
  StopCause cause_ = StopCause::HubGone;
  bool busy_ = false;  // a stopper lives
  bool confirmed_ = false;
  StopState state_ = StopState::Unreachable;
  std::string trouble_;
  std::thread thread_;
};

}  // namespace tandem::bridges::guardian
