// Stops an e-puck whose hub is gone: opens its link and repeats the stop until the robot confirms it.
#pragma once
#include "bridges/epuck/conversation.hpp"
#include "bridges/epuck/stop.hpp"
#include "bridges/epuck/wifi_session.hpp"
#include "bridges/guardian/stopper.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges::epuck {

/// The stop of one wire as a conversation without I/O.
class StopTalk {
 public:
  virtual ~StopTalk() = default;
  /// A link was opened.
  virtual void begin(hal::TimeNs now) = 0;
  virtual void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) = 0;
  /// Appends what is due to `out`.
  virtual void poll(hal::TimeNs now, Packet& out) = 0;
  virtual hal::TimeNs next_deadline() const = 0;
  virtual bool confirmed() const = 0;
  virtual bool answered() const = 0;
  /// The link is of no more use, although it is open.
  virtual bool wants_new_link() const { return false; }
  /// A packet that was sent in part only spoils what follows on the same link.
  virtual bool needs_whole_packets() const { return false; }
};

class SerialStop final : public StopTalk {
 public:
  explicit SerialStop(const StopTiming& timing) : procedure_(timing) {}
  void begin(hal::TimeNs now) override { procedure_.begin(now); }
  void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) override {
    for (const std::uint8_t byte : bytes) procedure_.on_byte(byte, at);
  }
  void poll(hal::TimeNs now, Packet& out) override { procedure_.poll(now, out); }
  hal::TimeNs next_deadline() const override { return procedure_.next_deadline(); }
  bool confirmed() const override { return procedure_.confirmed(); }
  bool answered() const override { return procedure_.answered(); }

 private:
  StopProcedure procedure_;
};

class WifiStop final : public StopTalk {
 public:
  explicit WifiStop(const StopTiming& timing) : timing_{.answer_ns = timing.answer_ns} {
    session_ = WifiSession(timing_);
  }
  void begin(hal::TimeNs now) override {
    session_ = WifiSession(timing_);
    session_.link_up(now);
    session_.shut_down(now);
  }
  void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) override { session_.on_bytes(bytes, at); }
  void poll(hal::TimeNs now, Packet& out) override {
    session_.poll(now);
    out.append(session_.output().bytes());
    session_.clear_output();
  }
  hal::TimeNs next_deadline() const override { return session_.next_deadline(); }
  bool confirmed() const override { return session_.at_rest(); }
  bool answered() const override { return session_.statistics().answers > 0; }
  bool wants_new_link() const override { return session_.wants_new_link(); }
  bool needs_whole_packets() const override { return true; }

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
