#include "bridges/aseba/rest_message.hpp"

#include <charconv>

namespace tandem::bridges::aseba {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::string_view kConfirm = " read back";

/// All of `text` is one number of this base.
template <class Number>
bool read_number(std::string_view text, int base, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc{} && end == text.data() + text.size();
}

std::optional<RestMessage> read_line(std::string_view line) {
  const std::size_t blank = line.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  RestMessage message;
  if (line.ends_with(kConfirm)) {
    message.confirm = true;
    line.remove_suffix(kConfirm.size());
  }
  if (!read_number(line.substr(0, blank), 10, message.type)) return std::nullopt;
  const std::string_view digits = line.substr(blank + 1);
  if (digits.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    std::uint8_t byte = 0;
    if (!read_number(digits.substr(i, 2), 16, byte)) return std::nullopt;
    message.payload.push_back(byte);
  }
  return message;
}

}  // namespace

std::string to_stop_body(const std::vector<RestMessage>& messages) {
  std::string body;
  for (const RestMessage& message : messages) {
    body += std::to_string(message.type) + ' ';
    for (const std::uint8_t byte : message.payload) {
      body += kDigits[byte >> 4];
      body += kDigits[byte & 15];
    }
    if (message.confirm) body += kConfirm;
    body += '\n';
  }
  return body;
}

std::optional<std::vector<RestMessage>> from_stop_body(std::string_view body) {
  std::vector<RestMessage> messages;
  while (!body.empty()) {
    const std::size_t end = body.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    auto message = read_line(body.substr(0, end));
    if (!message) return std::nullopt;
    messages.push_back(std::move(*message));
    body.remove_prefix(end + 1);
  }
  return messages;
}

}  // namespace tandem::bridges::aseba
