#include "bridges/eyebot_messages/codec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>

#include "hal/finite.hpp"

namespace tandem::bridges::eyebot_messages {
namespace {

using hal::all_finite;
using Bytes = std::span<const std::byte>;

std::uint64_t big_endian(Bytes data, std::size_t at, std::size_t bytes) noexcept {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < bytes; ++i) n = n << 8 | std::to_integer<std::uint64_t>(data[at + i]);
  return n;
}

// --- how long a message is ---

/// Goes through data without taking it over. After the first flaw nothing moves any more.
struct Walk {
  Bytes data;
  std::size_t at = kHeaderEnd;
  Flaw flaw = Flaw::None;

  void fail(Flaw why) noexcept {
    if (flaw == Flaw::None) flaw = why;
  }
  void skip(std::size_t bytes) noexcept {
    if (flaw != Flaw::None) return;
    if (bytes > data.size() - at) return fail(Flaw::WrongSize);
    at += bytes;
  }
  std::int64_t integer(std::size_t bytes) noexcept {
    skip(bytes);
    if (flaw != Flaw::None) return 0;
    const std::uint64_t n = big_endian(data, at - bytes, bytes);
    return bytes == 1 ? static_cast<std::int8_t>(n) : static_cast<std::int32_t>(n);
  }
  std::size_t count(std::size_t bytes, std::size_t most) noexcept {
    const std::int64_t n = integer(bytes);
    if (n >= 0 && n <= static_cast<std::int64_t>(most)) return static_cast<std::size_t>(n);
    fail(Flaw::BadCount);
    return 0;
  }
  void text() noexcept {
    const std::int64_t length = integer(4);  // with the zero at its end
    if (flaw != Flaw::None) return;
    if (length < 1 || length > static_cast<std::int64_t>(kMostElements)) return fail(Flaw::BadText);
    skip(static_cast<std::size_t>(length));
    if (flaw != Flaw::None) return;
    const auto bytes = data.subspan(at - static_cast<std::size_t>(length), static_cast<std::size_t>(length));
    if (std::find(bytes.begin(), bytes.end(), std::byte{0}) != bytes.end() - 1) fail(Flaw::BadText);
  }
  void array(std::size_t before, std::size_t element, std::size_t most = kMostElements) noexcept {
    skip(before);
    skip(element * count(4, most));
  }

  // What lies behind the header.
  void body(const Heartbeat&) noexcept {
    text();
    skip(15);
  }
  void body(const Status&) noexcept {
    skip(21);
    text();
  }
  void body(const State&) noexcept { skip(111); }
  void body(const Altitude&) noexcept { skip(8); }
  void body(const Battery&) noexcept { skip(17); }
  void body(const Scan&) noexcept { array(8, 13); }
  void body(const Rab&) noexcept {
    const std::size_t packets = count(4, kMostElements);
    for (std::size_t i = 0; i < packets && flaw == Flaw::None; ++i) {
      skip(24);
      skip(count(1, 127));
    }
  }
  void body(const Prox&) noexcept { skip(96); }
  void body(const Light&) noexcept { skip(96); }
  void body(const PanTilt&) noexcept { skip(9); }
  void body(const Blobs&) noexcept { array(4, 27); }
  void body(const Image&) noexcept { array(12, 1, kMostImageBytes); }
  void body(const Leds&) noexcept { skip(100); }
  void body(const Ack&) noexcept {
    text();
    skip(9);
    text();
  }
  void body(const CmdMode&) noexcept { skip(5); }
  void body(const CmdPosition&) noexcept { skip(42); }
  void body(const CmdVelocity&) noexcept { skip(37); }
  void body(const CmdPanTilt&) noexcept { skip(9); }
  void body(const CmdScanner&) noexcept { skip(10); }
  void body(const CmdRab&) noexcept { skip(count(1, 127)); }
};

// --- whether its numbers are numbers ---

bool is_orientation(const double (&q)[4]) noexcept {
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return square > 0.81 && square < 1.21;  // false for NaN
}

struct Sane {
  static bool is(const auto&) noexcept { return true; }  // has no numbers with a point
  /// What the robot itself says is not valid may be anything.
  static bool is(const State& m) noexcept {
    const bool place = !m.pos_valid || (all_finite(m.pos) && all_finite(m.vel));
    return place && is_orientation(m.quat) && all_finite(m.omega) && std::isfinite(m.pos_sigma);
  }
  static bool is(const Altitude& m) noexcept { return all_finite({m.ground, m.ceiling}); }
  static bool is(const Battery& m) noexcept { return all_finite({m.voltage, m.current, m.charge, m.time_left}); }
  static bool is(const Scan& m) noexcept {
    return all_finite({m.rpm, m.head_angle}) && all_finite(m.angle) && all_finite(m.range);
  }
  static bool is(const Rab& m) noexcept {
    return std::ranges::all_of(m.pkt, [](const auto& p) { return is(p); });
  }
  static bool is(const RabPacket& p) noexcept { return all_finite({p.range, p.bearing, p.elevation}); }
  static bool is(const Prox& m) noexcept { return all_finite(m.proximity); }
  static bool is(const Light& m) noexcept { return all_finite(m.light); }
  static bool is(const PanTilt& m) noexcept { return all_finite({m.pan, m.tilt}); }
  static bool is(const Blobs& m) noexcept {
    return std::ranges::all_of(m.blob, [](const auto& b) { return is(b); });
  }
  static bool is(const Blob& b) noexcept { return all_finite({b.x, b.y, b.area, b.range, b.azimuth, b.elevation}); }
  static bool is(const CmdMode& m) noexcept { return std::isfinite(m.param); }
  static bool is(const CmdPosition& m) noexcept { return all_finite(m.pos) && all_finite({m.yaw, m.max_speed}); }
  static bool is(const CmdVelocity& m) noexcept { return all_finite(m.vel) && std::isfinite(m.yaw_rate); }
  static bool is(const CmdPanTilt& m) noexcept { return all_finite({m.pan_target, m.tilt_target}); }
  static bool is(const CmdScanner& m) noexcept { return all_finite({m.rpm, m.angle}); }
};

// --- whether its counts are those of its arrays ---

struct Counted {
  static bool is(const auto&) noexcept { return true; }  // has no arrays of variable length
  static bool is(std::int64_t count, const auto& array) noexcept {
    return count >= 0 && static_cast<std::uint64_t>(count) == array.size();
  }
  static bool is(const Scan& m) noexcept {
    return is(m.n, m.sensor) && is(m.n, m.dt_us) && is(m.n, m.angle) && is(m.n, m.range);
  }
  static bool is(const Rab& m) noexcept {
    return is(m.n, m.pkt) && std::ranges::all_of(m.pkt, [](const RabPacket& p) { return is(p.len, p.data); });
  }
  static bool is(const Blobs& m) noexcept { return is(m.n, m.blob); }
  static bool is(const Image& m) noexcept { return is(m.size, m.data); }
  static bool is(const CmdRab& m) noexcept { return is(m.len, m.data); }
};

template <class Message>
constexpr std::size_t most_bytes() noexcept {
  return std::is_same_v<Message, Image> ? kMostImageBytes + kMostBytes : kMostBytes;
}

}  // namespace

const char* flaw_name(Flaw flaw) noexcept {
  constexpr std::array kNames = {"none", "another type", "wrong size", "bad count", "bad text", "not finite"};
  return kNames[static_cast<std::size_t>(flaw)];
}

template <class Message>
std::uint64_t Codec<Message>::fingerprint() noexcept {
  return static_cast<std::uint64_t>(Message::getHash());
}

template <class Message>
Flaw Codec<Message>::decode(Bytes data, Message& message) noexcept {
  if (data.size() < 8 || big_endian(data, 0, 8) != fingerprint()) return Flaw::WrongType;
  if (data.size() < kHeaderEnd || data.size() > most_bytes<Message>()) return Flaw::WrongSize;
  Walk w{data};
  w.body(message);
  if (w.flaw != Flaw::None) return w.flaw;
  if (w.at != data.size()) return Flaw::WrongSize;
  try {
    const int size = static_cast<int>(data.size());
    if (message.decode(data.data(), 0, size) != size) return Flaw::WrongSize;
  } catch (const std::exception&) {
    return Flaw::BadCount;  // there was no memory for it
  }
  return Sane::is(message) ? Flaw::None : Flaw::NotFinite;
}

template <class Message>
Bytes Codec<Message>::encode(const Message& message, std::span<std::byte> buffer) noexcept {
  if (!Counted::is(message)) return {};
  const int written = message.encode(buffer.data(), 0, static_cast<int>(buffer.size()));
  return written > 0 ? buffer.first(static_cast<std::size_t>(written)) : buffer.first(0);
}

std::optional<Header> peek_header(Bytes data) noexcept {
  if (data.size() < kHeaderEnd) return {};
  Header header{};
  header.utime = static_cast<std::int64_t>(big_endian(data, 8, 8));
  header.seq = static_cast<std::int32_t>(big_endian(data, 16, 4));
  header.session = static_cast<std::int32_t>(big_endian(data, 20, 4));
  return header;
}

template struct Codec<Heartbeat>;
template struct Codec<Leds>;
template struct Codec<Status>;
template struct Codec<State>;
template struct Codec<Altitude>;
template struct Codec<Battery>;
template struct Codec<Scan>;
template struct Codec<Rab>;
template struct Codec<Prox>;
template struct Codec<Light>;
template struct Codec<PanTilt>;
template struct Codec<Blobs>;
template struct Codec<Image>;
template struct Codec<Ack>;
template struct Codec<CmdMode>;
template struct Codec<CmdPosition>;
template struct Codec<CmdVelocity>;
template struct Codec<CmdPanTilt>;
template struct Codec<CmdScanner>;
template struct Codec<CmdRab>;

}  // namespace tandem::bridges::eyebot_messages
