// A CAN link that sends nothing once the permit was withdrawn under which it was opened.
#pragma once
#include "bridges/can/can_link.hpp"
#include "bridges/link/link.hpp"
#include "bridges/link/link_terms.hpp"

namespace tandem::bridges {

/// Gone from the moment when the permit was withdrawn, also where it has been granted again since.
class PermittedCanLink final : public CanLink {
 public:
  /// `turn`: of the permit, before `link` was opened.
  PermittedCanLink(std::unique_ptr<CanLink> link, SendPermit permit, std::uint32_t turn)
      : link_(std::move(link)), permit_(permit), turn_(turn) {}

  Sent send(const CanFrame& frame) noexcept override { return permitted() ? link_->send(frame) : Sent::Refused; }
  bool receive(CanFrame& frame) noexcept override { return permitted() && link_->receive(frame); }
  bool wait(hal::TimeNs timeout_ns) noexcept override {
    return permitted() ? link_->wait(timeout_ns) : wait_for_input(-1, timeout_ns);
  }
  int descriptor() const noexcept override { return permitted() ? link_->descriptor() : -1; }
  BusState state() const noexcept override { return permitted() ? link_->state() : BusState::Gone; }
  CanStatistics statistics() const noexcept override { return link_->statistics(); }
  std::string name() const override { return link_->name(); }

 private:
  bool permitted() const noexcept { return permit_.granted_since(turn_); }

  std::unique_ptr<CanLink> link_;
  SendPermit permit_;
  std::uint32_t turn_;
};

/// Opens with `opener` only while the permit is granted.
inline CanOpener permitted(CanOpener opener, SendPermit permit) {
  return permitted_by<PermittedCanLink>(std::move(opener), permit);
}

}  // namespace tandem::bridges
