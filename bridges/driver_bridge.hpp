// The part of a bridge that is alike for all kinds of robots: a driver behind a lock, served by a thread, judged at
// every latch.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "hal/check.hpp"
#include "hal/result.hpp"

namespace tandem::bridges {

/// What a bridge counts since it began; more of either since the last latch means that the robot has stopped meanwhile,
/// also when all is well again.
struct Interruptions {
  std::uint64_t all = 0;         ///< whatever stopped the robot: lost answers, a handshake, missing commits
  std::uint64_t of_its_own = 0;  ///< of those, what the robot did itself: a restart, its own fail-safe
};

/// `Self` is the bridge; it has a member `driver_` with robot(), latch, commit, stop, resume, at_rest(), state(), whose
/// states have Active and Lost, and the functions
///   void run()                                the thread's; returns when `ending_` is set
///   and with the lock held:
///   Interruptions interruptions() const       of the driver
///   std::string noun() const                  what such a robot is called, "foot-bot"
///   std::string link_trouble() const          why there is no link; "" when there is one, or none was tried yet
///   std::string robot_trouble() const         what is wrong with the robot; "" when nothing is
///   std::string silence() const               what is said of a robot that never became active
///   RobotIdentity who() const
/// It may have others of these; else they do nothing:
///   void before_start()                       ports are taken
///   void before_latch(TimeNs), after_command(TimeNs)    with the lock held
///   bool is_another() const                   it answers, and is not the robot that is meant
///   void wake()                               ends the thread's wait
template <class Self, class Robot>
class DriverBridge : public RobotBridge {
 public:
  DriverBridge() = default;
  DriverBridge(const DriverBridge&) = delete;
  DriverBridge& operator=(const DriverBridge&) = delete;

  Robot& robot() noexcept override { return driver().robot(); }
  void* port(const hal::PortType& type) noexcept override { return robot().find(type); }
  std::vector<PortView> taken() const override { return driver().robot().taken(); }
  void set_origin(hal::TimeNs origin_ns) noexcept override { robot().set_origin(origin_ns); }

  void start() override {
    TANDEM_CHECK(!thread_.joinable() && !ending_, "a bridge is started once");
    if constexpr (requires(Self & s) { s.before_start(); }) self().before_start();
    thread_ = std::thread([this] { self().run(); });
  }
  void shut_down() override {
    ending_ = true;
    {
      const std::lock_guard lock(mutex_);
      changed_.notify_all();
    }
    if constexpr (requires(Self & s) { s.wake(); }) self().wake();
    if (thread_.joinable()) thread_.join();
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
  }

  void latch(hal::Tick tick, hal::TimeNs now) noexcept override {
    const std::lock_guard lock(mutex_);
    if constexpr (requires(Self & s) { s.before_latch(now); }) self().before_latch(now);
    driver().latch(tick, now);
    judge();
  }
  void commit(hal::TimeNs now) noexcept override {
    const std::lock_guard lock(mutex_);
    driver().commit(now);
    commanded(now);
  }
  void stop(hal::TimeNs now) noexcept override {
    const std::lock_guard lock(mutex_);
    driver().stop(now);
    commanded(now);
  }
  void resume() noexcept override {
    const std::lock_guard lock(mutex_);
    driver().resume();
  }

  LinkHealth health() const noexcept override {
    const std::lock_guard lock(mutex_);
    return health_;
  }
  bool stopped_itself() const noexcept override {
    const std::lock_guard lock(mutex_);
    return stopped_itself_;
  }
  bool at_rest() const noexcept override {
    const std::lock_guard lock(mutex_);
    return driver().at_rest();
  }
  std::string trouble() const override {
    const std::lock_guard lock(mutex_);
    return any_trouble();
  }
  RobotIdentity identity() const override {
    const std::lock_guard lock(mutex_);
    return self().who();
  }
  /// Errors: not active within `timeout_ns`; says what is known (no link, nobody answers …) and what to do.
  hal::Status wait_active(hal::TimeNs timeout_ns) {
    std::unique_lock lock(mutex_);
    const auto active = [this] { return ending_ || is_active(); };
    if (changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), active) && !ending_) return {};
    const std::string who = self().noun() + " '" + std::string(driver().robot().id()) + "' is not there: ";
    const std::string link = self().link_trouble();
    return hal::Error{who + (link.empty() ? self().silence() + "; " + this->advice() : link)};
  }

  auto state() const noexcept {
    const std::lock_guard lock(mutex_);
    return driver().state();
  }
  auto statistics() const noexcept {
    const std::lock_guard lock(mutex_);
    return driver().statistics();
  }

 protected:
  /// With the lock held.
  std::string any_trouble() const {
    const std::string link = self().link_trouble();
    return link.empty() ? self().robot_trouble() : link;
  }

  mutable std::mutex mutex_;         // guards the driver and its link, not the ports
  std::condition_variable changed_;  // state, or end
  std::atomic<bool> ending_{false};

 private:
  Self& self() noexcept { return static_cast<Self&>(*this); }
  const Self& self() const noexcept { return static_cast<const Self&>(*this); }
  auto& driver() noexcept { return self().driver_; }
  const auto& driver() const noexcept { return self().driver_; }

  bool is_active() const noexcept {
    const auto state = driver().state();
    return state == decltype(state)::Active;
  }
  void commanded(hal::TimeNs now) noexcept {
    if constexpr (requires(Self & s) { s.after_command(now); }) self().after_command(now);
  }
  void judge() noexcept {
    const Interruptions now = self().interruptions();
    const bool begun_anew = was_active_ && now.all != last_.all;
    stopped_itself_ = was_active_ && now.of_its_own != last_.of_its_own;
    last_ = now;
    bool another = false;
    if constexpr (requires(const Self& s) { s.is_another(); }) another = self().is_another();
    const auto state = driver().state();
    if (is_active() && !another) {
      health_ = begun_anew ? LinkHealth::Suspect : LinkHealth::Active;
      was_active_ = true;
    } else if (!was_active_ || is_active()) {
      health_ = LinkHealth::Connecting;
    } else {
      health_ = state == decltype(state)::Lost ? LinkHealth::Lost : LinkHealth::Suspect;
    }
  }

  LinkHealth health_ = LinkHealth::Connecting;
  bool was_active_ = false;
  bool stopped_itself_ = false;
  Interruptions last_;  // at the last latch
  std::thread thread_;
};

}  // namespace tandem::bridges
