#include "bridges/eyebot_emulator/sender.hpp"

#include <algorithm>

namespace tandem::bridges::eyebot_emulator {

bool is_newer(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b)) > 0;
}

Senders::Sender& Senders::sender(std::int32_t session) {
  const auto found = std::ranges::find(senders_, session, &Sender::session);
  if (found == senders_.end()) {
    if (senders_.size() == kSessions) senders_.pop_back();
    senders_.push_front({.session = session});
  } else {
    senders_.splice(senders_.begin(), senders_, found);
  }
  return senders_.front();
}

bool Senders::hear(const Header& header, std::size_t channel) {
  std::optional<std::int32_t>& last = sender(header.session).last[channel];
  if (last && !is_newer(header.seq, *last)) return false;
  last = header.seq;
  return true;
}

std::optional<Answer> Senders::answer_to(const Header& header) const {
  const auto found = std::ranges::find(senders_, header.session, &Sender::session);
  if (found == senders_.end()) return std::nullopt;
  for (const auto& [seq, answer] : found->answers) {
    if (seq == header.seq) return answer;
  }
  return std::nullopt;
}

void Senders::remember(const Header& header, const Answer& answer) {
  auto& answers = sender(header.session).answers;
  if (answers.size() == kAnswers) answers.pop_front();
  answers.emplace_back(header.seq, answer);
}

}  // namespace tandem::bridges::eyebot_emulator
