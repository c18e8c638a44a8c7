// The hub's side of the lock-step protocol, for one robot.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bridges/link/link.hpp"
#include "bridges/peer/frame.hpp"
#include "bridges/peer/messages.hpp"
#include "hal/log.hpp"
#include "mixed_reality/lockstep/partner.hpp"

namespace tandem::mixed_reality {

class RemotePeer final : public Partner {
 public:
  /// Asks once more after this long, in case that bytes were lost.
  static constexpr hal::TimeNs kAskAgain_ns = 500 * hal::kNsPerMs;

  /// `open` makes its link, and makes it again when it was lost; empty: peers come by themselves. `session` tells this
  /// run from others.
  RemotePeer(core::World& world, core::RobotId robot, std::string session, bridges::LinkOpener open,
             const hal::Log& log);

  /// The peer's controller is compared with this copy, the hub's own; nothing: it is not.
  void compare_with(std::optional<bridges::peer::ControllerCopy> hubs) { hubs_copy_ = std::move(hubs); }
  /// Whether a peer of that description can be this robot's. Error: why not.
  hal::Status judge(const bridges::peer::Hello& hello) const;
  /// A peer that has said Hello for this robot, and was found good.
  void take_over(std::unique_ptr<bridges::ByteLink> link, hal::TimeNs now);
  bool has_link() const noexcept { return link_ != nullptr && link_->state() == bridges::LinkState::Open; }
  /// Peers that come by themselves may be this robot's.
  bool free() const noexcept { return !open_ && (!has_link() || left_ || !refused_.empty()); }
  bool opens_its_link() const noexcept { return static_cast<bool>(open_); }
  const std::string& kind() const noexcept { return told_.kind; }

  core::RobotId robot() const noexcept override { return robot_; }
  void pump(hal::TimeNs now) override;
  int descriptor() const noexcept override { return has_link() ? link_->descriptor() : -1; }
  bool ready() const noexcept override { return agreed_ && greeted_ && has_link() && !left_; }
  void ask(core::World& world, hal::TimeNs now) override;
  bool answered() const noexcept override { return answered_ == asked_; }
  hal::Status write_commands(core::World& world) override;
  std::string trouble() const override;
  void end(bool error, const std::string& why) override;
  PartnerReport report() const override;

 private:
  struct Port {
    const hal::PortType* type;
    bridges::peer::PortName name;
    bridges::peer::RowForm form;
    void* data;  // the robot's own
  };
  struct Taken {
    const Port* port;
    std::vector<std::max_align_t> row;  // of a command, until all of the answer is known to be good
  };

  void open_link(hal::TimeNs now);
  void take(const bridges::peer::FrameReader::Frame& frame, hal::TimeNs now);
  void take_hello(const bridges::peer::Hello& hello, hal::TimeNs now);
  void take_ready(std::span<const std::uint8_t> payload);
  void take_commands(std::span<const std::uint8_t> payload);
  hal::Status agree(const bridges::peer::Ready& ready);
  hal::Status agree_on_controller(const bridges::peer::Ready& ready);
  void refuse(const std::string& why);
  void send(bridges::peer::MessageType type, std::span<const std::uint8_t> payload);
  void say_robot(hal::TimeNs now);

  core::RobotId robot_;
  bridges::peer::RobotMessage told_;
  bridges::LinkOpener open_;
  hal::Log log_;
  bool any_controller_;
  std::optional<bridges::peer::ControllerCopy> hubs_copy_;
  std::vector<Port> ports_;
  std::vector<hal::PublishedField> shown_;  // of the robot's controller in the hub, in the order of `told_`
  std::byte* controller_;                   // there

  std::unique_ptr<bridges::ByteLink> link_;
  bridges::peer::FrameReader reader_;
  bool greeted_ = false;  // on this link: the peer has said Ready
  bool agreed_ = false;   // what follows was agreed on, and its controller is made
  bool begun_ = false;    // it was asked for a tick
  bool left_ = false;
  std::string refused_, open_error_;
  std::vector<Taken> takes_;
  std::vector<std::size_t> shows_;  // by place in the peer's answers: which of `shown_`
  hal::Tick asked_ = -1, answered_ = -1;
  hal::TimeNs said_ns_ = 0, asked_ns_ = 0, next_open_ns_ = 0;
  std::vector<std::uint8_t> question_, answer_, commands_, scratch_;
  PartnerReport counts_;
};

}  // namespace tandem::mixed_reality
