#include "bridges/footbot_emulator/slcan_adapter.hpp"

#include <optional>
#include <utility>

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr char kEnd = '\r';
constexpr char kRefused = '\a';
constexpr std::size_t kLongestLine = 32;
constexpr std::string_view kHex = "0123456789ABCDEF";
constexpr hal::TimeNs kStampPeriodMs = 60'000;  // stamps go from 0 to 59,999

std::optional<unsigned> hex(std::string_view digits) {
  unsigned value = 0;
  for (const char c : digits) {
    const char upper = c >= 'a' && c <= 'f' ? static_cast<char>(c - 'a' + 'A') : c;
    const std::size_t digit = kHex.find(upper);
    if (digit == std::string_view::npos) return std::nullopt;
    value = value << 4U | static_cast<unsigned>(digit);
  }
  return value;
}

/// Standard frames have 3 digits of identifier, extended ones 8; frames that ask for one (`remote`) carry no bytes.
/// Nothing when `line` is not such a frame, to the letter.
std::optional<Frame> frame_of(std::string_view line, std::size_t id_digits, bool remote) {
  const std::size_t head = 1 + id_digits + 1;
  if (line.size() < head) return std::nullopt;
  const auto id = hex(line.substr(1, id_digits));
  const char size = line[head - 1];
  if (!id || size < '0' || size > '8') return std::nullopt;
  Frame frame;
  frame.id = static_cast<std::uint16_t>(*id);
  frame.size = static_cast<std::uint8_t>(size - '0');
  const std::size_t bytes = remote ? 0 : frame.size;
  if (line.size() != head + 2 * bytes || (id_digits == 3 && *id > 0x7FF)) return std::nullopt;
  for (std::size_t i = 0; i < bytes; ++i) {
    const auto byte = hex(line.substr(head + 2 * i, 2));
    if (!byte) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return frame;
}

}  // namespace

void SlcanAdapter::receive(std::span<const std::uint8_t> bytes, hal::TimeNs now, std::vector<Frame>& to_bus) {
  for (const std::uint8_t byte : bytes) {
    if (static_cast<char>(byte) != kEnd) {
      if (line_.size() <= kLongestLine) line_ += static_cast<char>(byte);  // a longer one is refused as a whole
      continue;
    }
    obey(std::exchange(line_, {}), now, to_bus);
  }
}

void SlcanAdapter::obey(std::string_view line, hal::TimeNs now, std::vector<Frame>& to_bus) {
  if (line.empty()) return answer("");
  bool done = false;
  switch (line.front()) {
    case 't':
    case 'T':
    case 'r':
    case 'R':
      done = send_frame(line, now, to_bus);
      break;
    case 'V':
      return answer("V1013");  // hardware 1.0, software 1.3
    case 'v':
      return answer("vTandem");
    case 'N':
      return answer("NFB00");
    case 'F':
      if (open()) return answer(std::exchange(bus_errors_, false) ? "FA0" : "F00");  // bus error, error passive
      break;
    default:
      done = obey_setting(line, now);
      if (done) answer("");
  }
  if (done) return;
  output_ += kRefused;
  sink_(now, "adapter", {{"refused", line}});
}

bool SlcanAdapter::obey_setting(std::string_view line, hal::TimeNs now) {
  const std::string_view value = line.substr(1);
  switch (line.front()) {
    case 'S':
      if (open() || value.size() != 1 || value[0] < '0' || value[0] > '8') return false;
      rate_ = value[0];
      return true;
    case 's':  // timing registers: understood, of a rate that is not the modules'
      if (open() || value.size() != 4 || !hex(value)) return false;
      rate_ = 's';
      return true;
    case 'O':
      return value.empty() && open_channel(Channel::Open, now);
    case 'L':
      return value.empty() && open_channel(Channel::Listening, now);
    case 'C':
      if (!open()) return false;
      channel_ = Channel::Closed;
      sink_(now, "adapter", {{"channel", "closed"}});
      return true;
    case 'Z':
      if (open() || (value != "0" && value != "1")) return false;
      stamps_ = value == "1";
      return true;
    case 'M':
    case 'm':
      return !open() && value.size() == 8 && hex(value).has_value();
    case 'X':
    case 'U':
      return !open() && value.size() == 1 && hex(value).has_value();
    default:
      return false;
  }
}

bool SlcanAdapter::open_channel(Channel channel, hal::TimeNs now) {
  if (open() || rate_ == 0) return false;
  channel_ = channel;
  sink_(now, "adapter",
        {{"channel", channel == Channel::Open ? "open" : "listening"}, {"rate", std::string(1, rate_)}});
  return true;
}

// With another bit rate than the modules' a frame is never acknowledged: the adapter takes it and it goes nowhere.
bool SlcanAdapter::send_frame(std::string_view line, hal::TimeNs now, std::vector<Frame>& to_bus) {
  const bool extended = line.front() == 'T' || line.front() == 'R';
  const bool remote = line.front() == 'r' || line.front() == 'R';
  const auto frame = frame_of(line, extended ? 8 : 3, remote);
  if (!frame || channel_ != Channel::Open) return false;
  answer(extended ? "Z" : "z");
  if (!hears()) {
    bus_errors_ = true;
    sink_(now, "adapter", {{"not_acknowledged", line}});
  } else if (extended || remote) {
    sink_(now, "ignored", {{"frame", line}, {"why", "no module takes extended or remote frames"}});
  } else {
    to_bus.push_back(*frame);
  }
  return true;
}

void SlcanAdapter::show(const Frame& frame, hal::TimeNs now) {
  if (!open()) return;
  if (!hears()) {
    bus_errors_ = true;
    return;
  }
  const std::string text = to_text(frame);  // III#DD…
  output_ += 't' + text.substr(0, 3) + static_cast<char>('0' + frame.size) + text.substr(4);
  if (stamps_) {
    const auto ms = static_cast<unsigned>(now / hal::kNsPerMs % kStampPeriodMs);
    for (int shift = 12; shift >= 0; shift -= 4) output_ += kHex[ms >> static_cast<unsigned>(shift) & 15U];
  }
  output_ += kEnd;
}

}  // namespace tandem::bridges::footbot_emulator
