#include "hal/printable.hpp"

#include <cstdint>

namespace tandem::hal {
namespace {

constexpr char kHex[] = "0123456789abcdef";

/// Bytes of the UTF-8 character at the beginning of `text` [RFC 3629]; 0: it is none, or a control character.
std::size_t character_at(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first == '\n' || first == '\t') return 1;
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  const std::uint8_t second = byte(1);
  if (first == 0xC2 && second < 0xA0) return 0;                                        // C1 control characters
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;  // too long; half of a pair
  if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;  // too long; beyond Unicode
  return length;
}

std::uint32_t code_of(std::string_view character) {
  if (character.size() == 1) return static_cast<std::uint8_t>(character[0]);
  std::uint32_t code = static_cast<std::uint8_t>(character[0]) & (0xFFU >> (character.size() + 1));
  for (const char c : character.substr(1)) code = code << 6U | (static_cast<std::uint8_t>(c) & 0x3FU);
  return code;
}

/// Whether a character turns or hides others [Unicode 15, UAX 9 and general category Cf; the separators U+2028,
/// U+2029].
bool deceives(std::uint32_t code) {
  return code == 0xAD || code == 0x61C || code == 0x180E || (code >= 0x200B && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF ||
         (code >= 0xFFF9 && code <= 0xFFFB) || (code >= 0xE0000 && code <= 0xE007F);
}

void append_code(std::string& out, std::uint32_t code) {
  out += code > 0xFFFF ? "\\U" : "\\u";
  for (int shift = code > 0xFFFF ? 28 : 12; shift >= 0; shift -= 4) out += kHex[(code >> shift) & 15U];
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_at(text);
    if (length == 0) {
      const auto byte = static_cast<std::uint8_t>(text.front());
      out += "\\x";
      out += kHex[byte >> 4U];
      out += kHex[byte & 15U];
    } else if (const std::uint32_t code = code_of(text.substr(0, length)); deceives(code)) {
      append_code(out, code);
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(length > 0 ? length : 1);
  }
  return out;
}

std::string printable_entry(std::string_view text) {
  const std::string plain = printable(text);
  std::string out;
  out.reserve(plain.size());
  for (const char c : plain) {
    out += c;
    if (c == '\n') out += "    ";
  }
  return out;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;
  while (end > 0 && (static_cast<std::uint8_t>(text[end]) & 0xC0U) == 0x80) --end;
  return std::string(text.substr(0, end)) + "… (cut: " + std::to_string(text.size()) + " bytes in all)";
}

}  // namespace tandem::hal
