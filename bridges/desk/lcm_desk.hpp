// Commands to a run over LCM, and its answers (desk.lcm): one side listens, the other asks.
//
//   desk                                            run
//     | {number, who, "{…}", run "", proof ""}   ->  |
//     | <-  {"ok": false, "again": true}, run R      |      R: random, of this run
//     | {number, who, "{…}", run R, proof}       ->  |      the proof is right, the number is new: carried out
//     | <-  {"ok": true, …}, run R, proof            |
//
// Anybody on the network may send and read all this: only who has a key can make a proof, and no message counts twice.
#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bridges/desk/keys.hpp"
#include "bridges/lcm/lcm_link.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::desk {

/// A command or an answer.
struct DeskMessage {
  std::int64_t number = 0;
  std::string who;
  std::string text;   ///< JSON
  std::string run;    ///< the word of the run
  std::string proof;  ///< proof_of all above
};

inline constexpr std::size_t kLongestWho = 64;
inline constexpr std::size_t kLongestCommand = std::size_t{64} << 10;
inline constexpr std::size_t kLongestProof = 64;

/// Nothing: it is none, or longer than allowed. Anybody may have sent it.
std::optional<DeskMessage> decode_command(std::span<const std::byte> data);
std::optional<DeskMessage> decode_reply(std::span<const std::byte> data);
std::vector<std::byte> encode_command(const DeskMessage& message);
std::vector<std::byte> encode_reply(const DeskMessage& message);

/// Listens for commands on a channel, and answers on CHANNEL/reply.
class LcmDesk {
 public:
  using Reply = std::function<void(std::string answer)>;
  /// Takes a command whose sender has proved the key of `message.who`, once.
  using Take = std::function<void(DeskMessage message, hal::UserRole role, Reply reply)>;
  /// Others than those who have one of `keys` are refused. `take` is called by the link's thread, and must not wait;
  /// `reply` may be called on any thread, once, also when the desk is gone. Errors: as LcmLink's; no random numbers.
  static hal::Result<std::unique_ptr<LcmDesk>> open(const std::string& url, const std::string& channel,
                                                    std::vector<DeskKey> keys, Take take);
  /// The same on a link that is there.
  static hal::Result<std::unique_ptr<LcmDesk>> open(std::shared_ptr<lcm_bus::LcmLink> link, const std::string& channel,
                                                    std::vector<DeskKey> keys, Take take);
  /// No call of `take` begins any more.
  ~LcmDesk();
  LcmDesk(const LcmDesk&) = delete;
  LcmDesk& operator=(const LcmDesk&) = delete;

  /// Messages that were none.
  std::uint64_t malformed() const noexcept;
  /// Commands without a right proof, or said before.
  std::uint64_t refused() const noexcept;

 private:
  struct State;
  explicit LcmDesk(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;
};

/// Says one command with a key, and waits for its answer. Errors: as LcmLink's; nobody answered in time; whoever
/// answers does not have this key.
hal::Result<std::string> ask(const std::string& url, const std::string& channel, const DeskKey& key,
                             const DeskMessage& command, std::chrono::milliseconds patience);

}  // namespace tandem::bridges::desk
