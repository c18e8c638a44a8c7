// The peer's side of the lock-step protocol, without threads: says which robot it is for, makes its controller when the
// hub has told it who it is, and answers every tick once.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/link/link.hpp"
#include "bridges/peer/frame.hpp"
#include "bridges/peer/peer_robot.hpp"

namespace tandem::bridges::peer {

/// A controller and the robot that it drives.
class PeerController {
 public:
  virtual ~PeerController() = default;
  virtual PeerRobot& robot() noexcept = 0;
  /// What the hub is told of it, which compares it with its own; nothing: it is not told.
  virtual std::optional<ControllerCopy> copy() const { return {}; }
  /// False when it threw; `why` then says what.
  virtual bool step(hal::Tick tick, std::string& why) = 0;
};

/// Makes the controller for the robot that the hub named. Error: it cannot be; the hub learns it, and the peer ends.
using PeerMaker = std::function<hal::Result<std::unique_ptr<PeerController>>(const RobotMessage&)>;

struct PeerCounts {
  std::uint64_t ticks = 0;           ///< answered
  std::uint64_t asked_again = 0;     ///< ticks that came once more, and got the same answer
  std::uint64_t garbled = 0;         ///< frames with a wrong checksum
  std::uint64_t not_understood = 0;  ///< messages that make no sense here
  std::uint64_t links = 0;           ///< times that a link was open
};

/// Not thread-safe; `pump` never waits.
class PeerSide {
 public:
  static constexpr hal::TimeNs kHelloEvery_ns = 250 * hal::kNsPerMs;

  /// `robot` empty: any that the hub has no peer for yet.
  PeerSide(std::string robot, PeerMaker make) : wanted_(std::move(robot)), make_(std::move(make)) {}

  /// A link is open, the first or another one: says so to the hub.
  void link_opened() noexcept;
  /// Takes what has come, answers, says Hello while the hub says nothing.
  void pump(ByteLink& link, hal::TimeNs now);
  /// Tells the hub that nothing more will come.
  void leave(ByteLink& link, const std::string& why);

  /// The hub said End, or refused this peer, or the controller cannot be made.
  const std::optional<Farewell>& ended() const noexcept { return ended_; }
  /// Null: the hub has not told yet.
  const RobotMessage* robot() const noexcept { return controller_ != nullptr ? &*told_ : nullptr; }
  /// Since when nothing came from the hub.
  hal::TimeNs heard_ns() const noexcept { return heard_ns_; }
  PeerCounts counts() const noexcept;

 private:
  void take(const FrameReader::Frame& frame, ByteLink& link);
  void take_robot(std::span<const std::uint8_t> payload, ByteLink& link);
  void take_tick(std::span<const std::uint8_t> payload, ByteLink& link);
  void send(ByteLink& link, MessageType type, const std::vector<std::uint8_t>& payload);

  std::string wanted_;
  PeerMaker make_;
  FrameReader reader_;
  std::optional<RobotMessage> told_;
  std::unique_ptr<PeerController> controller_;
  std::optional<Farewell> ended_;
  bool greeted_ = false;  // the hub has answered on this link
  hal::TimeNs next_hello_ns_ = 0, heard_ns_ = 0;
  hal::Tick answered_ = -1;
  std::vector<std::uint8_t> answer_;  // the last one
  PeerCounts counts_;
};

}  // namespace tandem::bridges::peer
