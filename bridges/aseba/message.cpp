#include "bridges/aseba/message.hpp"

namespace tandem::bridges::aseba {
namespace {

/// Takes fields from the front of a payload. What is missing makes it `short_`.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  bool word(std::uint16_t& value) noexcept {
    if (rest_.size() < 2) return false;
    value = read_u16(rest_.data());
    rest_ = rest_.subspan(2);
    return true;
  }
  bool text(std::string_view& value) noexcept {
    if (rest_.empty() || rest_.size() < 1U + rest_[0]) return false;
    value = {reinterpret_cast<const char*>(rest_.data()) + 1, rest_[0]};
    rest_ = rest_.subspan(1U + rest_[0]);
    return true;
  }
  /// All that is left, but half a word.
  bool words(Words& value) noexcept {
    value = Words(rest_);
    rest_ = rest_.subspan(value.bytes().size());
    return true;
  }
  bool bytes(std::array<std::uint8_t, 4>& value) noexcept {
    if (rest_.size() < value.size()) return false;
    std::copy_n(rest_.begin(), value.size(), value.begin());
    rest_ = rest_.subspan(value.size());
    return true;
  }
  bool parameters(std::uint16_t count, std::span<const std::uint8_t>& value) noexcept {
    const auto before = rest_;
    for (std::uint16_t i = 0; i < count; ++i) {
      std::uint16_t size = 0;
      std::string_view name;
      if (!word(size) || !text(name)) return false;
    }
    value = before.first(before.size() - rest_.size());
    return true;
  }
  bool at_end() const noexcept { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
};

/// Appends fields to a payload.
class Writer {
 public:
  explicit Writer(Payload& payload) : payload_(payload) {}

  bool word(std::uint16_t value) noexcept { return payload_.append(value); }
  bool text(std::string_view value) noexcept {
    if (value.size() > 255) return false;
    const auto length = static_cast<std::uint8_t>(value.size());
    return payload_.append(std::span(&length, 1)) &&
           payload_.append(std::span(reinterpret_cast<const std::uint8_t*>(value.data()), value.size()));
  }
  bool words(Words value) noexcept { return payload_.append(value.bytes()); }
  bool bytes(const std::array<std::uint8_t, 4>& value) noexcept { return payload_.append(std::span(value)); }
  bool parameters(std::uint16_t count, std::span<const std::uint8_t> value) noexcept {
    Reader check(value);
    std::span<const std::uint8_t> all;
    return check.parameters(count, all) && check.at_end() && payload_.append(value);
  }

 private:
  Payload& payload_;
};

template <class M>
Decoded decode_as(std::span<const std::uint8_t> payload, Message& message) noexcept {
  Reader reader(payload);
  M& read = message.emplace<M>();
  if (!M::fields(read, reader)) return Decoded::TooShort;
  return reader.at_end() ? Decoded::Good : Decoded::TooLong;
}

using Decoder = Decoded (*)(std::span<const std::uint8_t>, Message&) noexcept;

/// One row a type: 0x8000, 0x9000 and 0xA000 each begin a range of at most 32.
constexpr std::size_t kRow = 32;
constexpr std::size_t place_of(std::uint16_t type) noexcept {
  return static_cast<std::size_t>(type >> 12U & 7U) * kRow + (type & 0xFFFU);
}

template <class... M>
constexpr auto make_decoders(std::variant<UserEvent, M...>*) noexcept {
  std::array<Decoder, 3 * kRow> table{};
  ((table[place_of(static_cast<std::uint16_t>(M::kType))] = &decode_as<M>), ...);
  return table;
}
constexpr std::array<Decoder, 3 * kRow> kDecoders = make_decoders(static_cast<Message*>(nullptr));

}  // namespace

Decoded decode(std::uint16_t type, std::span<const std::uint8_t> payload, Message& message) noexcept {
  if (type < kFirstBootloader) {
    const Words words(payload);
    if (words.size() > kMostWords || payload.size() % 2 != 0) return Decoded::TooLong;
    message.emplace<UserEvent>(UserEvent{type, words});
    return Decoded::Good;
  }
  if (payload.size() > kMostPayload) return Decoded::TooLong;
  const std::size_t row = type >> 12U & 7U;
  if (row > 2 || (type & 0xFFFU) >= kRow) return Decoded::UnknownType;
  const Decoder decoder = kDecoders[place_of(type)];
  return decoder == nullptr ? Decoded::UnknownType : decoder(payload, message);
}

std::uint16_t type_of(const Message& message) noexcept {
  return std::visit(
      []<class M>(const M& m) {
        if constexpr (std::is_same_v<M, UserEvent>) {
          return m.number;
        } else {
          return static_cast<std::uint16_t>(m.kType);
        }
      },
      message);
}

bool encode(const Message& message, Payload& payload) noexcept {
  payload.clear();
  return std::visit(
      [&payload]<class M>(const M& m) {
        if constexpr (std::is_same_v<M, UserEvent>) {
          return m.number < kFirstBootloader && payload.append(m.arguments.bytes());
        } else {
          Writer writer(payload);
          return M::fields(m, writer);
        }
      },
      message);
}

}  // namespace tandem::bridges::aseba
