// Memory that hub and guardian share: the heartbeat of the one, the verdict of the other.
#pragma once
#include <atomic>
#include <cstdint>

namespace tandem::bridges::guardian {

/// 32 bits each: those are atomic between processes on every processor that Tandem runs on.
struct SharedPage {
  std::atomic<std::uint32_t> beats{0};  ///< written by the hub
  std::atomic<std::uint32_t> turn{0};   ///< see `SendPermit`; written by the guardian
};

}  // namespace tandem::bridges::guardian
