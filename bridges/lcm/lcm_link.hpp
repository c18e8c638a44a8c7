// A connection to LCM: named channels, each message to everybody who listens [Huang et al. 2010, "LCM: Lightweight
// Communications and Marshalling", IROS].
//
// Messages are bytes here; what they mean is the codecs' affair. LCM keeps the oldest messages of a queue that is full
// and throws away the newest: so a thread of the link's own always takes everything at once.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hal/monotonic.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::lcm_bus {

/// Both views end with the call that they are handed to.
struct LcmMessage {
  std::string_view channel;
  std::span<const std::byte> data;
  hal::TimeNs received_ns = 0;  ///< CLOCK_MONOTONIC, when the link's thread took it
};

struct LcmStatistics {
  std::uint64_t received = 0;  ///< messages handed to handlers; one that suits two subscriptions counts twice
  std::uint64_t received_bytes = 0;
  std::uint64_t published = 0;
  std::uint64_t published_bytes = 0;
  std::uint64_t unsent = 0;   ///< that the system would not send, such as when the network is gone
  std::uint64_t dropped = 0;  ///< whose handler threw, or that the system could not read
};

/// Default URL of LCM: multicast that does not leave this machine.
inline constexpr std::string_view kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";

/// Thread-safe. Owns its thread, which ends with it. Shared by all who talk over one `memq://`, which lives inside one
/// object.
class LcmLink {
 public:
  /// `url`: "udpm://GROUP:PORT?ttl=N", "memq://", or "" for kDefaultLcmUrl. Errors: another scheme, a group or port
  /// that is none, no route for multicast (says how to make one).
  static hal::Result<std::shared_ptr<LcmLink>> open(const std::string& url);
  ~LcmLink();
  LcmLink(const LcmLink&) = delete;
  LcmLink& operator=(const LcmLink&) = delete;

  using Handler = std::function<void(const LcmMessage&)>;
  /// `handler` is called with every message whose channel as a whole suits the regular expression, by the link's own
  /// thread: it must be quick, and may publish. It lives as long as the link; let it own what it writes to. Error: the
  /// expression is none, or LCM's own test message does not come back (waits up to ten seconds for it).
  hal::Status subscribe(const std::string& channel_regex, Handler handler);

  /// Starts the thread; a second call does nothing. Error: the system has no descriptors left.
  hal::Status start();

  /// Sends to everybody, be there anybody or not. False when the system does not take it. Channels: 1 to 63
  /// characters.
  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept;

  const std::string& url() const noexcept { return url_; }
  LcmStatistics statistics() const noexcept;

  struct Engine;  // liblcm's side

 private:
  explicit LcmLink(std::string url);

  std::string url_;
  std::unique_ptr<Engine> engine_;
};

using hal::monotonic_ns;

}  // namespace tandem::bridges::lcm_bus
