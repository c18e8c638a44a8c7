#include "bridges/epuck/stop.hpp"

#include <algorithm>
#include <limits>

namespace tandem::bridges::epuck {
namespace {

using hal::TimeNs;

constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();

// The longest payload has 35 bytes, a 0 ends the packet, and eight may be lost.
constexpr std::size_t kLeadIn = 35 + 1 + 8;
constexpr std::size_t kWords = 10;
constexpr TimeNs kLongestQuiet = 160 * hal::kNsPerMs;
constexpr TimeNs kLongestSettling = 300 * hal::kNsPerMs;
constexpr std::size_t kBehindSpeeds = 12;  // four are the speeds, eight may be lost

constexpr std::array<std::uint8_t, kLeadIn + 2 * kWords> kStopWords = [] {
  std::array<std::uint8_t, kLeadIn + 2 * kWords> bytes{};
  for (std::size_t i = 0; i < kWords; ++i) {
    bytes[kLeadIn + 2 * i] = 'S';
    bytes[kLeadIn + 2 * i + 1] = '\r';
  }
  return bytes;
}();
constexpr std::array<std::uint8_t, 1 + kBehindSpeeds> kZeroSpeeds = {0xBC};
// Zeros first: they end what a flipped byte may have begun.
constexpr std::array<std::uint8_t, 12> kRestQuestion = {0, 0, 0, 0, 0, 0, 0, 0, 0xAF, 0xBB, 0, 0};

static_assert(kStopWords.size() <= Packet::kCapacity);

std::int16_t word(std::uint8_t low, std::uint8_t high) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(low | static_cast<unsigned>(high) << 8U));
}

}  // namespace

std::span<const std::uint8_t> stop_burst(std::size_t i) noexcept {
  if (i == 1) return kZeroSpeeds;
  return kStopWords;
}

std::span<const std::uint8_t> rest_question() noexcept {
  return kRestQuestion;
}

bool in_network(std::string_view link_name) noexcept {
  return link_name.starts_with("tcp:") || link_name.starts_with("epuck-tcp:");
}

StopTiming stop_timing_for(std::string_view link_name) noexcept {
  StopTiming timing;
  if (link_name.find("rfcomm") != std::string_view::npos) {
    timing.quiet_ns = 60 * hal::kNsPerMs;
    timing.answer_ns = 500 * hal::kNsPerMs;
  } else if (in_network(link_name)) {
    timing.quiet_ns = 40 * hal::kNsPerMs;
    timing.answer_ns = 250 * hal::kNsPerMs;
  }
  return timing;
}

void StopProcedure::begin(TimeNs now, TimeNs round_trip_ns) noexcept {
  quiet_ns_ = std::clamp(timing_.quiet_ns + round_trip_ns, quiet_ns_, std::max(quiet_ns_, kLongestQuiet));
  failed_rounds_ = 0;
  answered_ = false;
  first_known_ = false;
  step_ = Step::Burst;
  burst_ = 0;
  due_ns_ = now;
}

void StopProcedure::fail_round(TimeNs now) noexcept {
  ++failed_rounds_;
  if (step_ == Step::Apart || answer_size_ == answer_.size())
    quiet_ns_ = std::max(quiet_ns_, std::min(2 * quiet_ns_, kLongestQuiet));
  answer_size_ = 0;
  first_known_ = false;
  step_ = Step::Burst;
  burst_ = 0;
  due_ns_ = now;
}

void StopProcedure::ask(TimeNs now, Packet& out) noexcept {
  out.append(rest_question());
  answer_size_ = 0;
  step_ = Step::Answer;
  due_ns_ = now + timing_.answer_ns;
}

void StopProcedure::on_byte(std::uint8_t byte, TimeNs at) noexcept {
  switch (step_) {
    case Step::Burst:
    case Step::Confirmed:
      break;  // answers to `S`, and older ones
    case Step::Settle:
      due_ns_ = std::min(std::max(due_ns_, at + quiet_ns_), settled_by_ns_);
      break;
    case Step::Answer:
      answer_[answer_size_++] = byte;
      if (answer_size_ == answer_.size()) take_answer(at);
      break;
    case Step::Apart:
      fail_round(at);  // the last answer was longer than it may be: it was not the answer
      break;
  }
}

void StopProcedure::take_answer(TimeNs at) noexcept {
  answered_ = true;
  const bool speeds_are_0 = std::all_of(answer_.begin() + 4, answer_.end(), [](std::uint8_t b) { return b == 0; });
  const std::array<std::int16_t, 2> counters = {word(answer_[0], answer_[1]), word(answer_[2], answer_[3])};
  const bool moved = first_known_ && counters != counters_;
  counters_ = counters;
  if (!speeds_are_0 || moved) {
    fail_round(at);
  } else if (first_known_) {
    step_ = Step::Confirmed;
    quiet_ns_ = std::max(timing_.quiet_ns, quiet_ns_ / 2);  // it may have been noise, not a slow line
  } else {
    first_known_ = true;
    step_ = Step::Apart;
    due_ns_ = at + timing_.apart_ns;
  }
}

void StopProcedure::poll(TimeNs now, Packet& out) noexcept {
  if (now < next_deadline()) return;
  switch (step_) {
    case Step::Burst:
      out.clear();  // nothing may stand before it that is not to be obeyed
      out.append(stop_burst(burst_));
      due_ns_ = now + kStopBurstGap;
      if (++burst_ < kStopBursts) break;
      step_ = Step::Settle;
      due_ns_ = now + std::max(kStopBurstGap, quiet_ns_);
      settled_by_ns_ = now + std::max(quiet_ns_, std::min(4 * quiet_ns_, kLongestSettling));
      break;
    case Step::Settle:
    case Step::Apart:
      ask(now, out);
      break;
    case Step::Answer:
      fail_round(now);
      poll(now, out);
      break;
    case Step::Confirmed:
      break;
  }
}

TimeNs StopProcedure::next_deadline() const noexcept {
  return step_ == Step::Confirmed ? kNever : due_ns_;
}

}  // namespace tandem::bridges::epuck
