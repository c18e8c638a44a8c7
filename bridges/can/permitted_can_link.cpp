#include "bridges/can/permitted_can_link.hpp"

#include <ctime>

#include "bridges/link/link_terms.hpp"

namespace tandem::bridges {

bool PermittedCanLink::wait(hal::TimeNs timeout_ns) noexcept {
  if (permitted()) return link_->wait(timeout_ns);
  const timespec t{static_cast<time_t>(timeout_ns / hal::kNsPerSecond),
                   static_cast<long>(timeout_ns % hal::kNsPerSecond)};
  ::nanosleep(&t, nullptr);  // nothing to wait for; a loop of waits must not spin
  return false;
}

CanOpener permitted(CanOpener opener, SendPermit permit) {
  if (!permit.real()) return opener;
  return [opener = std::move(opener), permit]() -> hal::Result<std::unique_ptr<CanLink>> {
    const std::uint32_t turn = permit.turn();
    if (!permit.granted_since(turn)) return not_permitted();
    auto link = opener();
    if (!link.ok()) return link;
    return std::unique_ptr<CanLink>(std::make_unique<PermittedCanLink>(std::move(link).value(), permit, turn));
  };
}

}  // namespace tandem::bridges
