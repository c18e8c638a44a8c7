#include "bridges/can/slcan_link.hpp"

namespace tandem::bridges {
namespace {

std::span<const std::uint8_t> bytes_of(std::string_view text) noexcept {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

SlcanLink::SlcanLink(std::unique_ptr<ByteLink> line, const SlcanSettings& settings)
    : line_(std::move(line)), settings_(settings), asked_flags_ns_(monotonic_ns()) {}

hal::Result<std::unique_ptr<CanLink>> SlcanLink::open(std::unique_ptr<ByteLink> line, const SlcanSettings& settings) {
  std::unique_ptr<SlcanLink> link(new SlcanLink(std::move(line), settings));
  const auto refuse = [&](const std::string& why) {
    return hal::Error{"cannot open " + link->line_->name() + " as an slcan adapter: " + why};
  };
  const auto digit = slcan_rate_digit(settings.bits_per_s);
  if (!digit) {
    return refuse("slcan has no bit rate " + std::to_string(settings.bits_per_s) +
                  "; it has 10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000 and 1000000");
  }
  // A half-written line of an earlier user is ended, an open channel closed, and what still comes thrown away.
  link->line_->write(bytes_of("\r\r\rC\r"), settings.answer_ns);
  const hal::TimeNs drained = monotonic_ns() + settings.drain_ns;
  for (hal::TimeNs left = settings.drain_ns; left > 0; left = drained - monotonic_ns()) {
    link->line_->wait(left);
    link->line_->read(link->buffer_);
    if (link->line_->state() != LinkState::Open) break;
  }
  link->filled_ = link->read_ = 0;
  const Answer version = link->ask("V\r");
  const Answer rate = link->ask(std::string{'S', *digit, '\r'});
  const Answer opened = link->ask("O\r");
  if (link->line_->state() != LinkState::Open) return refuse("the line hung up");
  if (rate == Answer::No) return refuse("it does not take the bit rate " + std::to_string(settings.bits_per_s));
  if (opened == Answer::No) return refuse("it does not open its channel; is another program using it?");
  if (settings.strict && (version == Answer::None || rate == Answer::None || opened == Answer::None)) {
    return refuse("it does not answer; is this an slcan adapter (CANable with slcan firmware, CANUSB, CAN232)?");
  }
  return std::unique_ptr<CanLink>(std::move(link));
}

SlcanLink::~SlcanLink() {
  flush();
  line_->write(bytes_of("C\r"), 10 * hal::kNsPerMs);
}

/// Only while opening: frames of the bus that come in between are dropped.
SlcanLink::Answer SlcanLink::ask(std::string_view command) {
  line_->write(bytes_of(command), settings_.answer_ns);
  const hal::TimeNs deadline = monotonic_ns() + settings_.answer_ns;
  while (line_->state() == LinkState::Open) {
    while (next_saying()) {
      using enum SlcanSaying::What;
      const SlcanSaying::What what = reader_.saying().what;
      if (what == No) return Answer::No;
      if (what == Yes || what == Version) return Answer::Yes;
    }
    const hal::TimeNs left = deadline - monotonic_ns();
    if (left <= 0) break;
    line_->wait(left);
  }
  return Answer::None;
}

bool SlcanLink::next_saying() noexcept {
  while (true) {
    while (read_ < filled_) {
      if (reader_.push(buffer_[read_++])) return true;
    }
    const Received received = line_->read(buffer_);
    read_ = 0;
    filled_ = received.size;
    arrived_ns_ = received.at_ns;
    if (filled_ > 0) continue;
    if (line_->state() != LinkState::Open) record_.become(BusState::Gone);
    return false;
  }
}

void SlcanLink::flush() noexcept {
  if (sent_ == unsent_.size) return;
  sent_ += line_->write(bytes_of(unsent_.view().substr(sent_)), 0);
}

void SlcanLink::ask_flags() noexcept {
  const hal::TimeNs now = monotonic_ns();
  if (settings_.flags_ns <= 0 || now - asked_flags_ns_ < settings_.flags_ns || sent_ < unsent_.size) return;
  asked_flags_ns_ = now;
  flags_awaited_ = true;
  unsent_ = {};
  unsent_.text[0] = 'F';
  unsent_.text[1] = '\r';
  unsent_.size = 2;
  sent_ = 0;
  flush();
}

Sent SlcanLink::send(const CanFrame& frame) noexcept {
  flush();
  if (line_->state() != LinkState::Open) record_.become(BusState::Gone);
  if (!frame.valid() || !can_pass(record_.state())) {
    ++record_.counts.refused;
    return Sent::Refused;
  }
  if (sent_ < unsent_.size) {
    ++record_.counts.full;
    return Sent::Full;
  }
  unsent_ = slcan_line(frame);
  sent_ = 0;
  flush();
  ++record_.counts.frames_out;
  return Sent::Taken;
}

bool SlcanLink::receive(CanFrame& frame) noexcept {
  flush();
  ask_flags();
  while (next_saying()) {
    const SlcanSaying& saying = reader_.saying();
    note(saying);
    if (saying.what != SlcanSaying::What::Frame) continue;
    ++record_.counts.frames_in;
    frame = saying.frame;
    frame.at_ns = arrived_ns_;
    return true;
  }
  return false;
}

void SlcanLink::note(const SlcanSaying& saying) noexcept {
  switch (saying.what) {
    case SlcanSaying::What::No:
      if (flags_awaited_) {
        settings_.flags_ns = 0;  // an adapter without flags
      } else {
        ++record_.counts.send_failures;
      }
      flags_awaited_ = false;
      break;
    case SlcanSaying::What::Frame:
      if (record_.state() == BusState::BusOff) record_.become(BusState::Active);
      break;
    case SlcanSaying::What::State:
      record_.become(saying.state);
      break;
    case SlcanSaying::What::Error:
      ++record_.counts.error_reports;
      if (saying.no_acknowledge) ++record_.counts.no_acknowledge;
      if (saying.overrun) ++record_.counts.overrun;
      break;
    case SlcanSaying::What::Flags:
      flags_awaited_ = false;
      note_flags(saying.flags);
      break;
    case SlcanSaying::What::Malformed:
      ++record_.counts.malformed;
      break;
    default:
      break;
  }
}

void SlcanLink::note_flags(std::uint8_t flags) noexcept {
  if ((flags & (kSlcanReceiveFull | kSlcanOverrun)) != 0) ++record_.counts.overrun;
  if (!can_pass(record_.state())) return;  // the flags know no bus-off
  const bool passive = (flags & kSlcanPassive) != 0;
  record_.become(passive ? BusState::Passive : (flags & kSlcanWarning) != 0 ? BusState::Warning : BusState::Active);
}

bool SlcanLink::wait(hal::TimeNs timeout_ns) noexcept {
  flush();
  if (read_ < filled_) return true;
  // What the line did not take goes out when it can; nothing wakes us for that.
  const bool ready = line_->wait(sent_ < unsent_.size ? std::min(timeout_ns, hal::kNsPerMs) : timeout_ns);
  if (line_->state() != LinkState::Open) record_.become(BusState::Gone);
  return ready;
}

}  // namespace tandem::bridges
