// An eye-bot's record of each hub that commands it: the last sequence number, and the last answer.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <list>
#include <optional>
#include <string>

#include "bridges/eyebot_emulator/commands.hpp"

namespace tandem::bridges::eyebot_emulator {

/// The numbers are the protocol's.
enum class Verdict : std::int8_t {
  Ok = 0,
  RejectedMode = 1,
  RejectedRange = 2,
  RejectedStale = 3,
  RejectedSource = 4,
  Unsupported = 5,
  Failed = 6
};

struct Answer {
  Verdict verdict = Verdict::Ok;
  std::string text{};
  bool ok() const noexcept { return verdict == Verdict::Ok; }
  friend bool operator==(const Answer&, const Answer&) = default;
};

/// `a` comes after `b`, on a circle of 2^32 numbers.
bool is_newer(std::int32_t a, std::int32_t b);

/// Remembers the sessions that were heard last, as many as `kSessions`, and of each the last `kAnswers` answers.
class Senders {
 public:
  static constexpr std::size_t kSessions = 8;
  static constexpr std::size_t kAnswers = 32;

  /// Whether a message is the newest of its session and channel, by its number there; from then on it counts as heard.
  bool hear(const Header& header, std::size_t channel);
  /// What this command was answered, when it has been.
  std::optional<Answer> answer_to(const Header& header) const;
  void remember(const Header& header, const Answer& answer);

 private:
  struct Sender {
    std::int32_t session = 0;
    std::array<std::optional<std::int32_t>, kCommandChannels.size()> last{};
    std::deque<std::pair<std::int32_t, Answer>> answers{};
  };
  Sender& sender(std::int32_t session);

  std::list<Sender> senders_;  // the one that was heard last is the first
};

}  // namespace tandem::bridges::eyebot_emulator
