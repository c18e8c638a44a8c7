#include "bridges/can/slcan_text.hpp"

namespace tandem::bridges {
namespace {

constexpr char kDigits[] = "0123456789ABCDEF";
constexpr std::uint8_t kBell = 0x07;

/// Reads `count` hexadecimal digits from the front of `text`; false when they are not there.
bool take_hex(std::string_view& text, std::size_t count, std::uint32_t& value) noexcept {
  if (text.size() < count) return false;
  value = 0;
  for (const char c : text.substr(0, count)) {
    std::uint32_t digit = 0;
    if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0');
    } else if (c >= 'A' && c <= 'F') {
      digit = static_cast<std::uint32_t>(c - 'A' + 10);
    } else if (c >= 'a' && c <= 'f') {
      digit = static_cast<std::uint32_t>(c - 'a' + 10);
    } else {
      return false;
    }
    value = value << 4U | digit;
  }
  text.remove_prefix(count);
  return true;
}

bool parse_frame(std::string_view line, CanFrame& frame) noexcept {
  frame = {};
  frame.extended = line[0] == 'T' || line[0] == 'R';
  frame.remote = line[0] == 'r' || line[0] == 'R';
  line.remove_prefix(1);
  std::uint32_t size = 0;
  if (!take_hex(line, frame.extended ? 8 : 3, frame.id) || !take_hex(line, 1, size)) return false;
  frame.size = static_cast<std::uint8_t>(size);
  if (!frame.valid()) return false;
  for (std::size_t i = 0; i < frame.bytes().size(); ++i) {
    std::uint32_t byte = 0;
    if (!take_hex(line, 2, byte)) return false;
    frame.data[i] = static_cast<std::uint8_t>(byte);
  }
  std::uint32_t stamp = 0;  // milliseconds of the adapter's clock: ours is better known
  return line.empty() || (line.size() == 4 && take_hex(line, 4, stamp));
}

bool is_number(std::string_view text) noexcept {
  return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// "sa057033": state, 3 digits of the receive counter, 3 of the send counter.
bool parse_state(std::string_view line, BusState& state) noexcept {
  if (line.size() != 8 || !is_number(line.substr(2))) return false;
  switch (line[1]) {
    case 'a':
      state = BusState::Active;
      return true;
    case 'w':
      state = BusState::Warning;
      return true;
    case 'p':
      state = BusState::Passive;
      return true;
    case 'b':
      state = BusState::BusOff;
      return true;
    default:
      return false;
  }
}

/// "e3bcO": how many letters, then one letter an error.
bool parse_errors(std::string_view line, SlcanSaying& saying) noexcept {
  if (line.size() < 3 || line[1] < '1' || line[1] > '9') return false;
  const std::string_view letters = line.substr(2);
  if (letters.size() != static_cast<std::size_t>(line[1] - '0')) return false;
  if (letters.find_first_not_of("abBcfoOs") != std::string_view::npos) return false;
  saying.no_acknowledge = letters.find('a') != std::string_view::npos;
  saying.overrun = letters.find('o') != std::string_view::npos;
  return true;
}

}  // namespace

SlcanLine slcan_line(const CanFrame& frame) noexcept {
  SlcanLine line;
  const auto put = [&line](char c) { line.text[line.size++] = c; };
  put(frame.extended ? (frame.remote ? 'R' : 'T') : (frame.remote ? 'r' : 't'));
  for (int shift = frame.extended ? 28 : 8; shift >= 0; shift -= 4) put(kDigits[frame.id >> shift & 0xFU]);
  put(kDigits[frame.size & 0xFU]);
  for (const std::uint8_t byte : frame.bytes()) {
    put(kDigits[byte >> 4U]);
    put(kDigits[byte & 0xFU]);
  }
  put('\r');
  return line;
}

std::optional<char> slcan_rate_digit(std::uint32_t bits_per_s) noexcept {
  constexpr std::array<std::uint32_t, 9> kRates = {10000,  20000,  50000,  100000, 125000,
                                                   250000, 500000, 800000, 1000000};
  const auto found = std::ranges::find(kRates, bits_per_s);
  if (found == kRates.end()) return std::nullopt;
  return static_cast<char>('0' + (found - kRates.begin()));
}

SlcanSaying parse_slcan_line(std::string_view line) noexcept {
  using enum SlcanSaying::What;
  SlcanSaying saying;
  if (line.empty()) {
    saying.what = Yes;
    return saying;
  }
  const auto when = [&saying](bool good, SlcanSaying::What what) { saying.what = good ? what : Malformed; };
  switch (line[0]) {
    case 't':
    case 'T':
    case 'r':
    case 'R':
      when(parse_frame(line, saying.frame), Frame);
      break;
    case 'z':
    case 'Z':
      when(line.size() == 1, Confirmed);
      break;
    case 's':
      when(parse_state(line, saying.state), State);
      break;
    case 'e':
      when(parse_errors(line, saying), Error);
      break;
    case 'F': {
      std::uint32_t flags = 0;
      line.remove_prefix(1);
      when(take_hex(line, 2, flags) && line.empty(), Flags);
      saying.flags = static_cast<std::uint8_t>(flags);
      break;
    }
    case 'V':
    case 'v':
    case 'N':
      saying.what = Version;
      break;
    default:
      break;
  }
  return saying;
}

bool SlcanReader::push(std::uint8_t byte) noexcept {
  if (byte != '\r' && byte != kBell) {
    if (byte == '\n') return false;  // some adapters send CR LF
    if (size_ == text_.size()) {
      too_long_ = true;
    } else {
      text_[size_++] = static_cast<char>(byte);
    }
    return false;
  }
  if (byte == kBell && size_ == 0) {
    saying_ = {};
    saying_.what = SlcanSaying::What::No;
  } else {
    saying_ = too_long_ || byte == kBell ? SlcanSaying{} : parse_slcan_line({text_.data(), size_});
  }
  size_ = 0;
  too_long_ = false;
  return true;
}

}  // namespace tandem::bridges
