#include "bridges/robot_identity.hpp"

#include <array>
#include <charconv>

namespace tandem::bridges {
namespace {

struct Word {
  std::string_view name;
  std::optional<std::string> RobotIdentity::*value;
};
// In the order in which people are told of a difference, and in which they are encoded.
constexpr std::array<Word, 5> kWords = {{{"device", &RobotIdentity::device},
                                         {"name", &RobotIdentity::name},
                                         {"address", &RobotIdentity::address},
                                         {"hardware", &RobotIdentity::hardware},
                                         {"firmware", &RobotIdentity::firmware}}};

std::string told(const std::optional<std::string>& word) {
  return word ? "'" + *word + "'" : "none";
}

std::string first_difference(const RobotIdentity& armed, const RobotIdentity& answers, bool both_tell) {
  for (const Word& word : kWords) {
    const auto& before = armed.*word.value;
    const auto& now = answers.*word.value;
    if (before == now || (both_tell && (!before || !now))) continue;
    return std::string(word.name) + ": " + told(before) + " was armed, " + told(now) + " answers";
  }
  return {};
}

constexpr std::string_view kHex = "0123456789abcdef";

bool plain(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '/' || c == ':';
}

void put(std::string& out, const std::string& text) {
  for (const char c : text) {
    if (plain(c)) {
      out += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    out += '%';
    out += kHex[byte >> 4U];
    out += kHex[byte & 15U];
  }
}

std::optional<std::string> unescaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (plain(text[i])) {
      out += text[i];
      continue;
    }
    if (text[i] != '%' || i + 2 >= text.size()) return std::nullopt;
    const std::size_t high = kHex.find(text[i + 1]), low = kHex.find(text[i + 2]);
    if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
    out += static_cast<char>(high << 4U | low);
    i += 2;
  }
  return out;
}

/// Takes the text before the next ';' off `in`. False: there is none.
bool take(std::string_view& in, std::string_view& field) {
  const std::size_t end = in.find(';');
  if (end == std::string_view::npos) return false;
  field = in.substr(0, end);
  in.remove_prefix(end + 1);
  return true;
}

}  // namespace

std::string difference(const RobotIdentity& armed, const RobotIdentity& answers) {
  return first_difference(armed, answers, false);
}

std::string contradiction(const RobotIdentity& armed, const RobotIdentity& answers) {
  return first_difference(armed, answers, true);
}

std::string to_text(const RobotIdentity& identity) {
  std::string text;
  const auto add = [&text](std::string_view before, const std::optional<std::string>& word) {
    if (word) text += (text.empty() ? "" : ", ") + std::string(before) + *word;
  };
  add("", identity.name);
  add("", identity.firmware);
  add("hardware ", identity.hardware);
  add("", identity.address);
  return text;
}

// "2;" session ';' link ';' then of each word '=' and its text, or nothing, and ';'.
std::string encode(const RobotIdentity& identity) {
  std::string out = "2;" + std::to_string(identity.session) + ";";
  put(out, identity.link);
  out += ';';
  for (const Word& word : kWords) {
    if (const auto& value = identity.*word.value; value) {
      out += '=';
      put(out, *value);
    }
    out += ';';
  }
  return out;
}

std::optional<RobotIdentity> decode_identity(std::string_view text) {
  RobotIdentity identity;
  std::string_view version, session, link;
  if (!take(text, version) || version != "2" || !take(text, session) || !take(text, link)) return std::nullopt;
  const auto [end, error] = std::from_chars(session.data(), session.data() + session.size(), identity.session);
  if (error != std::errc{} || end != session.data() + session.size()) return std::nullopt;
  const auto written = unescaped(link);
  if (!written) return std::nullopt;
  identity.link = *written;
  for (const Word& word : kWords) {
    std::string_view field;
    if (!take(text, field)) return std::nullopt;
    if (field.empty()) continue;
    if (field.front() != '=') return std::nullopt;
    auto value = unescaped(field.substr(1));
    if (!value) return std::nullopt;
    identity.*word.value = std::move(*value);
  }
  return text.empty() ? std::optional(std::move(identity)) : std::nullopt;
}

}  // namespace tandem::bridges
