// Answers of an e-puck to questions of its session.
#include <algorithm>
#include <utility>

#include "bridges/epuck/session.hpp"

namespace tandem::bridges::epuck {
namespace {

using hal::TimeNs;

constexpr const char* kImplausible = "an answer held values that cannot be";

bool tells(std::span<const std::uint8_t> speeds, const std::array<StepsPerS, 2>& told) noexcept {
  const auto word = [&](std::size_t at) { return static_cast<std::int16_t>(speeds[at] | speeds[at + 1] << 8); };
  return word(0) == told[0].value && word(2) == told[1].value;
}

}  // namespace

std::span<const std::uint8_t> Session::received(std::size_t from, std::size_t size) const noexcept {
  return std::span(answer_).subspan(from, size);
}

void Session::on_answer_byte(std::uint8_t byte, TimeNs at) noexcept {
  answer_[answer_size_++] = byte;
  heard_ns_ = at;
  const std::size_t most = question_.answer_size + (earlier_awaited_ ? earlier_.answer_size : 0);
  if (answer_size_ == most) judge_answers(at);
}

/// The second of two answers has come whole, the first not, or not whole.
bool Session::second_alone() const noexcept {
  if (!earlier_awaited_ || answer_size_ != earlier_size_ + question_.answer_size) return false;
  const auto answer = received(earlier_size_, question_.answer_size);
  return tells(answer.last(kSpeedsSize), question_.told) && (!question_.marked || tells(answer, question_.told));
}

/// All has come that can, or no more comes.
void Session::judge_answers(TimeNs now) noexcept {
  const bool late = phase_ == Phase::Again;
  phase_ = Phase::Idle;
  const bool two_awaited = std::exchange(earlier_awaited_, false);
  const std::size_t first = two_awaited ? earlier_.answer_size : 0;
  if (answer_size_ == first + question_.answer_size) {
    statistics_.overdue += late || two_awaited ? 1 : 0;
    RawSensors passed_over;
    if (two_awaited && !decode(earlier_, received(0, first), passed_over)) return lose_step(kImplausible, now);
    on_answer(question_, received(first, question_.answer_size), heard_ns_);
  } else if (two_awaited && answer_size_ == earlier_size_ + question_.answer_size) {
    on_answer(question_, received(earlier_size_, question_.answer_size), heard_ns_);
  } else if (two_awaited && answer_size_ == first && tells(received(0, first).last(kSpeedsSize), earlier_.told)) {
    take_late_answer(now);
  } else {
    miss_answer(now);
  }
}

/// Of the two answers only the first has come: the second is overdue as well.
void Session::take_late_answer(TimeNs now) noexcept {
  ++statistics_.overdue;
  on_answer(earlier_, received(0, earlier_.answer_size), heard_ns_);
  answer_size_ = 0;
  if (phase_ == Phase::Idle) begin_again(now);
}

/// An answer that came in time was measured when the robot had read the question: before the answer travels.
Conversation::Measured Session::measured(const Question& question, TimeNs at) noexcept {
  const TimeNs round_trip = at - question.asked_ns;
  const TimeNs travel = transfer_ns(question.question_size + question.answer_size);
  const TimeNs latency = std::max<TimeNs>(0, round_trip - travel) / 2;
  const bool dated = round_trip <= timing_.answer_ns + travel && allowed_ns_ == 0;
  if (!dated) return {std::min(question.asked_ns, at), at};
  latency_ns_ = std::max(latency, latency_ns_ - (latency_ns_ - latency) / 8);
  const TimeNs taken =
      std::clamp(at - transfer_ns(question.answer_size) - latency, std::min(question.asked_ns, at), at);
  return {taken, taken};
}

bool Session::decode(const Question& question, std::span<const std::uint8_t> bytes, RawSensors& raw) noexcept {
  const bool odd_mark = question.marked && !std::ranges::equal(bytes.first(kSpeedsSize), bytes.last(kSpeedsSize));
  const auto values = bytes.subspan(question.marked ? kSpeedsSize : 0);
  if (!odd_mark && decode_answer(values, question.asked, layout_, raw) == Decoded::Ok) return true;
  ++statistics_.implausible;
  return false;
}

void Session::on_answer(const Question& question, std::span<const std::uint8_t> bytes, TimeNs at) noexcept {
  RawSensors raw = samples_.raw;
  if (!decode(question, bytes, raw)) return lose_step(kImplausible, at);
  const Measured when = measured(question, at);
  if (question.asked.has(Quantity::Encoders) && counters_known_ && !counters_doubtful_ &&
      !encoders_plausible(raw.encoders, when.latest_ns)) {
    ++statistics_.encoder_jumps;
    lose_step("the wheel counters jumped", at);
    return;
  }
  asked_again_ = false;
  const bool newest = &question == &question_;  // nothing was told since
  if (newest) {
    if (!speeds_as_told(raw.commanded, at)) return;
    const bool stands =
        sent_.left.value == 0 && sent_.right.value == 0 && raw.commanded[0] == 0 && raw.commanded[1] == 0;
    if (rest_doubted_) at_rest_ = stands;
    rest_doubted_ = false;
  }
  take_samples(question.asked, raw, when);
  state_ = SessionState::Active;
  trouble_ = "";
  ++statistics_.answers;
  statistics_.round_trips.add(at - question.asked_ns);
}

bool Session::speeds_as_told(const std::array<std::int16_t, 2>& commanded, TimeNs at) noexcept {
  if (commanded[0] == sent_.left.value && commanded[1] == sent_.right.value) {
    told_again_ = false;
    return true;
  }
  ++statistics_.wrong_speeds;
  at_rest_ = false;
  // Its old speeds: the command was lost as a whole.
  if (!told_again_ && commanded[0] == speeds_before_[0].value && commanded[1] == speeds_before_[1].value) {
    told_again_ = true;
    speeds_due_ = true;
    pending_ = true;
    return true;
  }
  lose_step("it has other wheel speeds than it was told", at);
  return false;
}

TimeNs Session::answer_deadline() const noexcept {
  if (heard_ns_ == 0) return deadline_ns_;
  const TimeNs quiet_ns = heard_ns_ + timing_.quiet_ns;  // before that more may be coming
  return second_alone() ? quiet_ns : std::max(deadline_ns_, quiet_ns);
}

void Session::miss_answer(TimeNs now) noexcept {
  const bool silent = heard_ns_ == 0;
  ++(silent ? statistics_.silent : statistics_.cut_short);
  if (asked_again_ || state_ != SessionState::Active) {
    lose_step(silent ? "no answer" : "an answer was cut short", now);
    return;
  }
  begin_again(now);
}

}  // namespace tandem::bridges::epuck
