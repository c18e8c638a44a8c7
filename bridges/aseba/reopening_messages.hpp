// A message link that reopens itself whenever it is gone.
#pragma once
#include <memory>
#include <optional>

#include "bridges/aseba/message_link.hpp"
#include "bridges/link/link.hpp"
#include "bridges/link/pending_link.hpp"

namespace tandem::bridges::aseba {

/// Opens on a thread of its own, so that no call waits for a device or a network. Down until the first opening
/// succeeded; never Gone. Destroying it while an opening is at work is safe: the thread goes on alone and closes what
/// it still opens.
class ReopeningMessages final : public MessageLink {
 public:
  /// `opener` is tried at once, and after a failure again after `first_pause_ns`, doubled up to `longest_pause_ns`.
  explicit ReopeningMessages(MessageLinkOpener opener, hal::TimeNs first_pause_ns = 50 * hal::kNsPerMs,
                             hal::TimeNs longest_pause_ns = 400 * hal::kNsPerMs);

  bool send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept override;
  bool receive(MessageView& message) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  int descriptor() const noexcept override { return link_ == nullptr ? -1 : link_->descriptor(); }
  void clear() noexcept override;
  Carrier state() const noexcept override;
  /// Over all links that were opened.
  MessageLinkStatistics statistics() const noexcept override;
  /// Of the link, or of the last one.
  std::string name() const override { return name_; }

  /// Why the last opening failed; empty while there is a link.
  const std::string& trouble() const noexcept { return trouble_; }
  std::uint64_t openings() const noexcept { return openings_; }
  std::uint64_t failed_openings() const noexcept { return failed_openings_; }

 private:
  void look_after() noexcept;

  MessageLinkOpener opener_;
  hal::TimeNs first_pause_ns_;
  hal::TimeNs longest_pause_ns_;
  hal::TimeNs pause_ns_;
  hal::TimeNs next_try_ns_ = 0;
  std::optional<Pending<MessageLink>> work_;
  std::unique_ptr<MessageLink> link_;
  MessageLinkStatistics before_;
  std::uint64_t refused_ = 0;
  std::string name_ = "link being opened";
  std::string trouble_;
  std::uint64_t openings_ = 0;
  std::uint64_t failed_openings_ = 0;
};

}  // namespace tandem::bridges::aseba
