#include "bridges/link/permitted_link.hpp"

#include <ctime>

#include "bridges/link/link_terms.hpp"

namespace tandem::bridges {

std::size_t PermittedLink::write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept {
  if (permitted()) return link_->write(bytes, budget_ns);
  refused_ += bytes.size();
  return 0;
}

/// What comes is for the guardian.
Received PermittedLink::read(std::span<std::uint8_t> buffer) noexcept {
  return permitted() ? link_->read(buffer) : Received{};
}

bool PermittedLink::wait(hal::TimeNs timeout_ns) noexcept {
  if (permitted()) return link_->wait(timeout_ns);
  const timespec t{static_cast<time_t>(timeout_ns / hal::kNsPerSecond),
                   static_cast<long>(timeout_ns % hal::kNsPerSecond)};
  ::nanosleep(&t, nullptr);  // nothing to wait for; a loop of waits must not spin
  return false;
}

LinkStatistics PermittedLink::statistics() const noexcept {
  LinkStatistics statistics = link_->statistics();
  statistics.bytes_refused += refused_;
  return statistics;
}

LinkOpener permitted(LinkOpener opener, SendPermit permit) {
  if (!permit.real()) return opener;
  return [opener = std::move(opener), permit]() -> hal::Result<std::unique_ptr<ByteLink>> {
    const std::uint32_t turn = permit.turn();
    if (!permit.granted_since(turn)) return not_permitted();
    auto link = opener();
    if (!link.ok()) return link;
    return std::unique_ptr<ByteLink>(std::make_unique<PermittedLink>(std::move(link).value(), permit, turn));
  };
}

}  // namespace tandem::bridges
