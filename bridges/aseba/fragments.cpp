#include "bridges/aseba/fragments.hpp"

namespace tandem::bridges::aseba {
namespace {

enum class Kind : std::uint32_t { Normal = 0, Start = 1, Stop = 2, Small = 3 };

constexpr std::uint32_t identifier(Kind kind, std::uint16_t source) noexcept {
  return static_cast<std::uint32_t>(kind) << 8U | (source & 0xFFU);
}

constexpr Kind kind_of(std::size_t index, std::size_t frames) noexcept {
  if (frames == 1) return Kind::Small;
  if (index == 0) return Kind::Start;
  return index + 1 == frames ? Kind::Stop : Kind::Normal;
}

}  // namespace

std::vector<CanFilter> aseba_filters() {
  return {{0x000, 0x400, false}};
}

CanFrame fragment(std::uint16_t source, std::uint16_t type, std::span<const std::uint8_t> payload,
                  std::size_t index) noexcept {
  CanFrame frame;
  frame.id = identifier(kind_of(index, frames_for(payload.size())), source);
  // The first frame begins with the type; payload byte k stands at place k + 2 of the whole.
  std::size_t at = 8 * index;
  if (index == 0) {
    write_u16(frame.data.data(), type);
    frame.size = 2;
    at = 2;
  }
  const std::size_t n = std::min<std::size_t>(8U - frame.size, payload.size() + 2 - at);
  std::copy_n(payload.begin() + static_cast<std::ptrdiff_t>(at - 2), n, frame.data.begin() + frame.size);
  frame.size = static_cast<std::uint8_t>(frame.size + n);
  return frame;
}

CanFrame closing_frame(std::uint16_t source) noexcept {
  CanFrame frame;
  frame.id = identifier(Kind::Stop, source);
  frame.size = 2;
  return frame;
}

Assembler::Assembler() : sources_(std::make_unique<std::array<Source, kNodeIds>>()) {}

void Assembler::drop(Source& source, std::uint64_t& counter) noexcept {
  if (source.size == 0) return;
  source.size = 0;
  --open_;
  ++counter;
}

void Assembler::begin(Source& source, const CanFrame& frame) noexcept {
  std::copy_n(frame.data.begin(), 8, source.bytes.begin());
  source.size = 8;
  source.last_ns = frame.at_ns;
  ++open_;
}

bool Assembler::extend(Source& source, const CanFrame& frame) noexcept {
  if (source.size + frame.size > kMostInner) {
    drop(source, statistics_.too_long);
    return false;
  }
  std::copy_n(frame.data.begin(), frame.size, source.bytes.begin() + source.size);
  source.size = static_cast<std::uint16_t>(source.size + frame.size);
  source.last_ns = frame.at_ns;
  return true;
}

std::optional<MessageView> Assembler::deliver(std::uint16_t id, std::span<const std::uint8_t> bytes,
                                              hal::TimeNs at) noexcept {
  ++statistics_.messages;
  return MessageView{id, read_u16(bytes.data()), bytes.subspan(2), at};
}

std::optional<MessageView> Assembler::push(const CanFrame& frame) noexcept {
  ++statistics_.frames;
  if (frame.extended || frame.remote || frame.id >= 0x400 || frame.size > 8) {
    ++statistics_.foreign;
    return std::nullopt;
  }
  const auto id = static_cast<std::uint16_t>(frame.id & 0xFFU);
  const auto kind = static_cast<Kind>(frame.id >> 8U);
  Source& source = (*sources_)[id];
  if (source.size > 0 && frame.at_ns - source.last_ns > kLongestGap) drop(source, statistics_.timed_out);
  switch (kind) {
    case Kind::Start:
      drop(source, statistics_.lost_stop);
      if (frame.size != 8) {
        ++statistics_.bad_length;
      } else {
        begin(source, frame);
      }
      return std::nullopt;
    case Kind::Normal:
      if (source.size == 0) {
        ++statistics_.stray_normal;
      } else if (frame.size != 8) {
        drop(source, statistics_.bad_length);
      } else {
        extend(source, frame);
      }
      return std::nullopt;
    case Kind::Stop:
      if (source.size == 0) {
        ++statistics_.stray_stop;
        return std::nullopt;
      }
      if (frame.size == 0) {
        drop(source, statistics_.bad_length);
        return std::nullopt;
      }
      if (!extend(source, frame)) return std::nullopt;
      --open_;
      return deliver(id, std::span(source.bytes).first(std::exchange(source.size, std::uint16_t{0})), frame.at_ns);
    case Kind::Small:
      break;
  }
  drop(source, statistics_.lost_stop);  // a node never puts one message into another
  if (frame.size < 2) {
    ++statistics_.bad_length;
    return std::nullopt;
  }
  small_ = frame.data;
  return deliver(id, std::span(small_).first(frame.size), frame.at_ns);
}

void Assembler::expire(hal::TimeNs now) noexcept {
  if (open_ == 0) return;
  for (Source& source : *sources_) {
    if (source.size > 0 && now - source.last_ns > kLongestGap) drop(source, statistics_.timed_out);
  }
}

void Assembler::clear() noexcept {
  if (open_ == 0) return;
  for (Source& source : *sources_) drop(source, statistics_.timed_out);
}

}  // namespace tandem::bridges::aseba
