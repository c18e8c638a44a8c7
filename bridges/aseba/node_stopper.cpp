#include "bridges/aseba/node_stopper.hpp"

#include <algorithm>

#include "bridges/aseba/message.hpp"
#include "bridges/aseba/message_link_text.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges::aseba {
namespace {

using guardian::StopState;
using hal::TimeNs;

constexpr TimeNs kStep = 40 * hal::kNsPerMs;
constexpr TimeNs kWait = 5 * hal::kNsPerMs;
constexpr TimeNs kSayAgain = 50 * hal::kNsPerMs;
// What comes sooner may be the answer to a question that the hub has asked.
constexpr TimeNs kOldAnswers = 40 * hal::kNsPerMs;
constexpr std::size_t kHead = 4;  // bytes of a SetVariables: the node and where to begin

std::uint16_t word_at(const std::vector<std::uint8_t>& bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | static_cast<unsigned>(bytes[at + 1]) << 8U);
}

}  // namespace

std::unique_ptr<guardian::Stopper> make_node_stopper(const StopMessages& messages, guardian::StopCause) {
  const auto opener = [link = messages.link]() -> hal::Result<std::unique_ptr<MessageLink>> {
    LinkTerms terms;
    terms.beside = true;
    const auto open = message_link_opener(link, terms);
    if (!open.ok()) return open.error();
    return open.value()();
  };
  return std::make_unique<NodeStopper>(opener, from_stop_body(messages.body).value_or(std::vector<RestMessage>{}));
}

NodeStopper::NodeStopper(MessageLinkOpener opener, const std::vector<RestMessage>& messages)
    : opener_(std::move(opener)) {
  for (const RestMessage& message : messages) {
    Row row;
    row.message = message;
    if (message.payload.size() < kHead) continue;
    row.node = word_at(message.payload, 0);
    row.start = word_at(message.payload, 2);
    row.words.assign(message.payload.begin() + kHead, message.payload.end());
    row.confirmed = !message.confirm;
    rows_.push_back(std::move(row));
  }
}

bool NodeStopper::open() {
  auto opened = opener_();
  if (!opened.ok()) {
    trouble_ = opened.error().message;
    return false;
  }
  link_ = std::move(opened).value();
  for (Row& row : rows_) row.confirmed = !row.message.confirm;
  first_said_ns_ = say_due_ns_ = 0;
  return true;
}

void NodeStopper::say() {
  for (const Row& row : rows_) (void)link_->send(row.message.type, row.message.payload);
  Payload question;
  for (const Row& row : rows_) {
    if (!row.message.confirm) continue;
    if (encode(GetVariables{row.node, row.start, static_cast<std::uint16_t>(row.words.size() / 2)}, question)) {
      (void)link_->send(static_cast<std::uint16_t>(Type::GetVariables), question.bytes());
    }
  }
}

void NodeStopper::hear(const MessageView& message) {
  if (message.type != static_cast<std::uint16_t>(Type::Variables) || message.payload.size() < 2) return;
  heard_ = true;
  const auto start = static_cast<std::uint16_t>(message.payload[0] | static_cast<unsigned>(message.payload[1]) << 8U);
  for (Row& row : rows_) {
    if (!row.message.confirm || row.node != message.source || row.start != start) continue;
    row.confirmed = std::ranges::equal(message.payload.subspan(2), row.words) &&
                    (row.confirmed || message.at_ns - first_said_ns_ >= kOldAnswers);
  }
}

StopState NodeStopper::poll(TimeNs now) {
  if (rows_.empty()) return StopState::Confirmed;
  if (!link_ && !open()) return StopState::Unreachable;
  if (link_->state() == Carrier::Gone) {
    link_.reset();
    trouble_ = "the link is gone";
    return StopState::Unreachable;
  }
  if (link_->state() == Carrier::Up && now >= say_due_ns_) {
    if (first_said_ns_ == 0) first_said_ns_ = now;
    say_due_ns_ = now + kSayAgain;
    say();
  }
  MessageView message;
  while (link_->receive(message)) hear(message);
  // Also what is not to be confirmed is said twice.
  if (all_confirmed() && first_said_ns_ != 0 && now - first_said_ns_ >= 2 * kSayAgain) return StopState::Confirmed;
  trouble_ = heard_ ? "its nodes do not hold the resting values" : "its nodes do not answer";
  return heard_ ? StopState::Stopping : StopState::Unreachable;
}

StopState NodeStopper::step(TimeNs now) {
  StopState state = poll(now);
  now = monotonic_ns();  // opening may have taken long
  for (const TimeNs end = now + kStep; state != StopState::Confirmed && link_ && now < end; now = monotonic_ns()) {
    link_->wait(kWait);
    state = poll(monotonic_ns());
  }
  return state;
}

}  // namespace tandem::bridges::aseba
