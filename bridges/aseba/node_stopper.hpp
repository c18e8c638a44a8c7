// Stops a robot of ASEBA nodes whose hub is gone: writes the resting values to its nodes, and reads them back.
#pragma once
#include <vector>

#include "bridges/aseba/message_link.hpp"
#include "bridges/aseba/rest_message.hpp"
#include "bridges/guardian/stopper.hpp"

namespace tandem::bridges::aseba {

/// Says all messages again and again, over a link that is opened again whenever it is gone, until all that are to be
/// confirmed were read back. A robot of which no node was ever wired has nothing to confirm.
class NodeStopper final : public guardian::Stopper {
 public:
  NodeStopper(MessageLinkOpener opener, const std::vector<RestMessage>& messages);

  guardian::StopState step(hal::TimeNs now) override;
  /// The same without waiting, in the caller's time: says what is due, takes in what has come.
  guardian::StopState poll(hal::TimeNs now);
  std::string trouble() const override { return trouble_; }

 private:
  struct Row {
    RestMessage message;
    std::uint16_t node = 0, start = 0;
    std::vector<std::uint8_t> words;  // as they are to be read back
    bool confirmed = false;
  };
  bool open();
  void say();
  void hear(const MessageView& message);
  bool all_confirmed() const { return std::ranges::all_of(rows_, &Row::confirmed); }

  MessageLinkOpener opener_;
  std::vector<Row> rows_;
  std::unique_ptr<MessageLink> link_;
  hal::TimeNs first_said_ns_ = 0;  // on this link
  hal::TimeNs say_due_ns_ = 0;
  bool heard_ = false;
  std::string trouble_;
};

/// For a `StopperType` of any kind of robot: understands bodies as `to_stop_body` makes them.
std::unique_ptr<guardian::Stopper> make_node_stopper(const StopMessages& messages, guardian::StopCause cause);

}  // namespace tandem::bridges::aseba
