// Opening a link without waiting for it.
#pragma once
#include <memory>
#include <optional>

#include "bridges/link/link.hpp"

namespace tandem::bridges {

/// An opener at work on a thread of its own, because opening a Bluetooth device may take the kernel many seconds.
/// Giving up early is safe: the thread goes on alone, and closes what it still opens.
class PendingLink {
 public:
  explicit PendingLink(LinkOpener opener);

  /// Empty while at work; the opener's result exactly once, after which it is empty again.
  std::optional<hal::Result<std::unique_ptr<ByteLink>>> take();

 private:
  struct Work;
  std::shared_ptr<Work> work_;  // shared with the thread, which outlives an impatient owner
};

}  // namespace tandem::bridges
