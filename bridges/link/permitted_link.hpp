// A byte link that writes nothing once the permit was withdrawn under which it was opened.
#pragma once
#include <atomic>

#include "bridges/link/link.hpp"
#include "bridges/link/link_terms.hpp"

namespace tandem::bridges {

/// Hung up from the moment when the permit was withdrawn, also where it has been granted again since.
class PermittedLink final : public ByteLink {
 public:
  /// `turn`: of the permit, before `link` was opened.
  PermittedLink(std::unique_ptr<ByteLink> link, SendPermit permit, std::uint32_t turn)
      : link_(std::move(link)), permit_(permit), turn_(turn) {}

  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept override {
    if (permitted()) return link_->write(bytes, budget_ns);
    refused_ += bytes.size();
    return 0;
  }
  /// What comes is for the guardian.
  Received read(std::span<std::uint8_t> buffer) noexcept override {
    return permitted() ? link_->read(buffer) : Received{};
  }
  bool wait(hal::TimeNs timeout_ns) noexcept override {
    return permitted() ? link_->wait(timeout_ns) : wait_for_input(-1, timeout_ns);
  }
  int descriptor() const noexcept override { return permitted() ? link_->descriptor() : -1; }
  LinkState state() const noexcept override { return permitted() ? link_->state() : LinkState::HungUp; }
  LinkStatistics statistics() const noexcept override {
    LinkStatistics statistics = link_->statistics();
    statistics.bytes_refused += refused_;
    return statistics;
  }
  std::string name() const override { return link_->name(); }

 private:
  bool permitted() const noexcept { return permit_.granted_since(turn_); }

  std::unique_ptr<ByteLink> link_;
  SendPermit permit_;
  std::uint32_t turn_;
  std::atomic<std::uint64_t> refused_{0};
};

/// Opens with `opener` only while the permit is granted.
inline LinkOpener permitted(LinkOpener opener, SendPermit permit) {
  return permitted_by<PermittedLink>(std::move(opener), permit);
}

}  // namespace tandem::bridges
