#include "bridges/eyebot_messages/codec.hpp"

#include <algorithm>
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
};

void walk(Walk& w, const Heartbeat&) noexcept {
  w.text();
  w.skip(15);
}
void walk(Walk& w, const Status&) noexcept {
  w.skip(21);
  w.text();
}
void walk(Walk& w, const State&) noexcept {
  w.skip(111);
}
void walk(Walk& w, const Altitude&) noexcept {
  w.skip(8);
}
void walk(Walk& w, const Battery&) noexcept {
  w.skip(17);
}
void walk(Walk& w, const Scan&) noexcept {
  w.skip(8);
  w.skip(13 * w.count(4, kMostElements));
}
void walk(Walk& w, const Rab&) noexcept {
  const std::size_t packets = w.count(4, kMostElements);
  for (std::size_t i = 0; i < packets && w.flaw == Flaw::None; ++i) {
    w.skip(24);
    w.skip(w.count(1, 127));
  }
}
void walk(Walk& w, const Prox&) noexcept {
  w.skip(96);
}
void walk(Walk& w, const Light&) noexcept {
  w.skip(96);
}
void walk(Walk& w, const PanTilt&) noexcept {
  w.skip(9);
}
void walk(Walk& w, const Blobs&) noexcept {
  w.skip(4);
  w.skip(27 * w.count(4, kMostElements));
}
void walk(Walk& w, const Image&) noexcept {
  w.skip(12);
  w.skip(w.count(4, kMostImageBytes));
}
void walk(Walk& w, const Leds&) noexcept {
  w.skip(100);
}
void walk(Walk& w, const Ack&) noexcept {
  w.text();
  w.skip(9);
  w.text();
}
void walk(Walk& w, const CmdMode&) noexcept {
  w.skip(5);
}
void walk(Walk& w, const CmdPosition&) noexcept {
  w.skip(42);
}
void walk(Walk& w, const CmdVelocity&) noexcept {
  w.skip(37);
}
void walk(Walk& w, const CmdPanTilt&) noexcept {
  w.skip(9);
}
void walk(Walk& w, const CmdScanner&) noexcept {
  w.skip(10);
}
void walk(Walk& w, const CmdRab&) noexcept {
  w.skip(w.count(1, 127));
}

// --- whether its numbers are numbers ---

bool is_orientation(const double (&q)[4]) noexcept {
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return square > 0.81 && square < 1.21;  // false for NaN
}

template <class Message>
bool sane(const Message&) noexcept {
  return true;  // has no numbers with a point
}
/// What the robot itself says is not valid may be anything.
bool sane(const State& m) noexcept {
  const bool place = !m.pos_valid || (all_finite(m.pos) && all_finite(m.vel));
  return place && is_orientation(m.quat) && all_finite(m.omega) && std::isfinite(m.pos_sigma);
}
bool sane(const Altitude& m) noexcept {
  return all_finite({m.ground, m.ceiling});
}
bool sane(const Battery& m) noexcept {
  return all_finite({m.voltage, m.current, m.charge, m.time_left});
}
bool sane(const Scan& m) noexcept {
  return all_finite({m.rpm, m.head_angle}) && all_finite(m.angle) && all_finite(m.range);
}
bool sane(const Rab& m) noexcept {
  for (const RabPacket& p : m.pkt) {
    if (!all_finite({p.range, p.bearing, p.elevation})) return false;
  }
  return true;
}
bool sane(const Prox& m) noexcept {
  return all_finite(m.proximity);
}
bool sane(const Light& m) noexcept {
  return all_finite(m.light);
}
bool sane(const PanTilt& m) noexcept {
  return all_finite({m.pan, m.tilt});
}
bool sane(const Blobs& m) noexcept {
  for (const Blob& b : m.blob) {
    if (!all_finite({b.x, b.y, b.area, b.range, b.azimuth, b.elevation})) return false;
  }
  return true;
}
bool sane(const CmdMode& m) noexcept {
  return std::isfinite(m.param);
}
bool sane(const CmdPosition& m) noexcept {
  return all_finite(m.pos) && all_finite({m.yaw, m.max_speed});
}
bool sane(const CmdVelocity& m) noexcept {
  return all_finite(m.vel) && std::isfinite(m.yaw_rate);
}
bool sane(const CmdPanTilt& m) noexcept {
  return all_finite({m.pan_target, m.tilt_target});
}
bool sane(const CmdScanner& m) noexcept {
  return all_finite({m.rpm, m.angle});
}

// --- whether its counts are those of its arrays ---

bool is(std::int64_t count, std::size_t length) noexcept {
  return count >= 0 && static_cast<std::uint64_t>(count) == length;
}
template <class Message>
bool counted(const Message&) noexcept {
  return true;  // has no arrays of variable length
}
bool counted(const Scan& m) noexcept {
  return is(m.n, m.sensor.size()) && is(m.n, m.dt_us.size()) && is(m.n, m.angle.size()) && is(m.n, m.range.size());
}
bool counted(const Rab& m) noexcept {
  for (const RabPacket& p : m.pkt) {
    if (!is(p.len, p.data.size())) return false;
  }
  return is(m.n, m.pkt.size());
}
bool counted(const Blobs& m) noexcept {
  return is(m.n, m.blob.size());
}
bool counted(const Image& m) noexcept {
  return is(m.size, m.data.size());
}
bool counted(const CmdRab& m) noexcept {
  return is(m.len, m.data.size());
}

template <class Message>
constexpr std::size_t most_bytes() noexcept {
  return std::is_same_v<Message, Image> ? kMostImageBytes + kMostBytes : kMostBytes;
}

}  // namespace

const char* flaw_name(Flaw flaw) noexcept {
  switch (flaw) {
    case Flaw::None:
      return "none";
    case Flaw::WrongType:
      return "another type";
    case Flaw::WrongSize:
      return "wrong size";
    case Flaw::BadCount:
      return "bad count";
    case Flaw::BadText:
      return "bad text";
    case Flaw::NotFinite:
      return "not finite";
  }
  return "";
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
  walk(w, message);
  if (w.flaw != Flaw::None) return w.flaw;
  if (w.at != data.size()) return Flaw::WrongSize;
  try {
    const int size = static_cast<int>(data.size());
    if (message.decode(data.data(), 0, size) != size) return Flaw::WrongSize;
  } catch (const std::exception&) {
    return Flaw::BadCount;  // there was no memory for it
  }
  return sane(message) ? Flaw::None : Flaw::NotFinite;
}

template <class Message>
Bytes Codec<Message>::encode(const Message& message, std::span<std::byte> buffer) noexcept {
  if (!counted(message)) return {};
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
