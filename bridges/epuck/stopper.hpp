// Stops an e-puck whose hub is gone: opens its link and repeats the stop until the robot confirms it.
#pragma once
#include "bridges/epuck/conversation.hpp"
#include "bridges/epuck/stop.hpp"
#include "bridges/epuck/wifi_session.hpp"
#include "bridges/guardian/stopper.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges::epuck {

using SerialStop = StopProcedure;

/// The stop over a radio.
class WifiStop final : public StopTalk {
 public:
  explicit WifiStop(const StopTiming& timing) : timing_{.answer_ns = timing.answer_ns} {
    session_ = WifiSession(timing_);
  }
  void begin(hal::TimeNs now) noexcept override {
    session_ = WifiSession(timing_);
    session_.link_up(now);
    session_.shut_down(now);
  }
  void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept override { session_.on_bytes(bytes, at); }
  void poll(hal::TimeNs now, Packet& out) noexcept override {
    session_.poll(now);
    out.append(session_.output().bytes());
    session_.clear_output();
  }
  hal::TimeNs next_deadline() const noexcept override { return session_.next_deadline(); }
  bool confirmed() const noexcept override { return session_.at_rest(); }
  bool answered() const noexcept override { return session_.statistics().answers > 0; }
  bool wants_new_link() const noexcept override { return session_.wants_new_link(); }
  bool needs_whole_packets() const noexcept override { return true; }

 private:
  SessionTiming timing_;
  WifiSession session_;
};

/// The stop over a link that is opened again whenever it hangs up.
class EpuckStopper final : public guardian::Stopper {
 public:
  EpuckStopper(LinkOpener opener, const StopTiming& timing, WireForm wire = WireForm::Serial);

  guardian::StopState step(hal::TimeNs now) override;
  std::string trouble() const override { return trouble_; }

 private:
  bool open(hal::TimeNs now);
  void hang_up(const std::string& why);

  LinkOpener opener_;
  std::unique_ptr<StopTalk> talk_;
  std::unique_ptr<ByteLink> link_;
  std::string trouble_;
};

/// The body of stop messages: which descriptor of the hub's is the connection, for robots in a network. Robots and
/// serial servers hear one host at a time, and a frozen hub stays connected: before the stopper connects, it ends that
/// connection.
std::string stop_body(int descriptor);

/// Understands stop messages with such a body or none: the link says the rest.
const guardian::StopperType& stopper_type() noexcept;

}  // namespace tandem::bridges::epuck
