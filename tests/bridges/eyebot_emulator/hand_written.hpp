// Messages of an eye-bot put together and taken apart byte by byte, without any generated code.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::bridges::eyebot_emulator::hand_written {

using Bytes = std::vector<std::byte>;

/// What lcm-gen computes of the types' members, from two implementations that agree.
inline const std::map<std::string_view, std::uint64_t> kFingerprints = {
    {"heartbeat", 0x7d370a605beb9bcc},    {"status", 0x3769e950259b2a50},       {"state", 0xc447b9961529edc3},
    {"altitude", 0x7e25f75ecbf0250b},     {"battery", 0xcf663832974eb4b4},      {"scan", 0xf811139700a58352},
    {"rab", 0x885e4473e611e92c},          {"prox", 0x4c8675de71f80fb1},         {"light", 0x38b7656495718092},
    {"pan_tilt", 0xc6be20f903991655},     {"blobs", 0x86121504ba53e1dd},        {"image", 0xefcb2ef0cd671fbc},
    {"leds", 0xb562848b8a385e4c},         {"ack", 0x8e40b25f0cb11049},          {"cmd/leds", 0xb562848b8a385e4c},
    {"cmd/mode", 0x1d06fec683b92e45},     {"cmd/position", 0xeb2e3942cbf7b819}, {"cmd/velocity", 0xe914935f104f8214},
    {"cmd/pan_tilt", 0x459d5ec80c55142d}, {"cmd/scanner", 0x7fdcb6f49522b835},  {"cmd/rab", 0x45c4aa329f54ecfd}};

struct Head {
  std::int64_t utime = 0;
  std::int32_t seq = 0;
  std::int32_t session = 0;
};

class Writer {
 public:
  Writer(std::string_view topic, const Head& head) {
    number(kFingerprints.at(topic), 8);
    i64(head.utime).i32(head.seq).i32(head.session);
  }
  Writer& i8(int v) { return number(static_cast<std::uint64_t>(v), 1); }
  Writer& i32(std::int32_t v) { return number(static_cast<std::uint32_t>(v), 4); }
  Writer& i64(std::int64_t v) { return number(static_cast<std::uint64_t>(v), 8); }
  Writer& f32(float v) { return number(std::bit_cast<std::uint32_t>(v), 4); }
  Writer& f64(double v) { return number(std::bit_cast<std::uint64_t>(v), 8); }
  Writer& text(std::string_view v) {
    i32(static_cast<std::int32_t>(v.size()) + 1);
    for (const char c : v) i8(c);
    return i8(0);
  }
  Bytes bytes;

 private:
  Writer& number(std::uint64_t v, int size) {
    for (int i = size - 1; i >= 0; --i) bytes.push_back(static_cast<std::byte>(v >> (8 * i) & 0xFFU));
    return *this;
  }
};

class Reader {
 public:
  explicit Reader(const Bytes& bytes) : bytes_(bytes) {}
  std::uint64_t fingerprint() { return number(8); }
  Head head() {
    Head h;
    h.utime = i64();
    h.seq = i32();
    h.session = i32();
    return h;
  }
  int i8() { return static_cast<std::int8_t>(number(1)); }
  std::int32_t i32() { return static_cast<std::int32_t>(number(4)); }
  std::int64_t i64() { return static_cast<std::int64_t>(number(8)); }
  float f32() { return std::bit_cast<float>(static_cast<std::uint32_t>(number(4))); }
  double f64() { return std::bit_cast<double>(number(8)); }
  std::string text() {
    std::string v;
    for (int i = i32(); i > 1; --i) v += static_cast<char>(i8());
    i8();
    return v;
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::uint64_t number(int size) {
    std::uint64_t v = 0;
    for (int i = 0; i < size; ++i) v = v << 8U | std::to_integer<std::uint64_t>(bytes_.at(at_++));
    return v;
  }
  const Bytes& bytes_;
  std::size_t at_ = 0;
};

/// Spells bytes as documents do: "7E 25".
inline Bytes from_hex(std::string_view text) {
  Bytes bytes;
  int digits = 0;
  unsigned value = 0;
  for (const char c : text) {
    const std::string_view kDigits = "0123456789ABCDEF";
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) continue;
    value = value << 4U | static_cast<unsigned>(digit);
    if (++digits % 2 == 0) bytes.push_back(static_cast<std::byte>(value & 0xFFU));
  }
  return bytes;
}

inline Bytes mode(const Head& head, int action, float param = 0.0F) {
  return Writer("cmd/mode", head).i8(action).f32(param).bytes;
}
inline Bytes velocity(const Head& head, double x, double y, double z, double yaw_rate = 0.0, int timeout_ms = 0,
                      int frame = 0) {
  return Writer("cmd/velocity", head).i8(frame).f64(x).f64(y).f64(z).f64(yaw_rate).i32(timeout_ms).bytes;
}
struct Place {
  double x = 0.0, y = 0.0, z = 0.0;
  int frame = 0;
  bool use_yaw = false;
  double yaw = 0.0;
  float max_speed = 0.0F;
  int timeout_ms = 0;
};
inline Bytes position(const Head& head, const Place& p) {
  return Writer("cmd/position", head)
      .i8(p.frame)
      .i8(p.use_yaw ? 1 : 0)
      .f64(p.x)
      .f64(p.y)
      .f64(p.z)
      .f64(p.yaw)
      .f32(p.max_speed)
      .i32(p.timeout_ms)
      .bytes;
}
inline Bytes hub_heartbeat(const Head& head, const std::string& name = "lab", int major = 1) {
  return Writer("heartbeat", head).text(name).i8(0).i8(major).i8(0).i32(200).i64(0).bytes;
}

struct Status {
  Head head;
  int mode = 0;
  int failsafe = 0;
  bool armed = false, magnet = false, attached = false;
  std::int32_t cmd_session = 0, cmd_seq = 0, cmd_age_ms = 0, rejected = 0;
  std::string text;
};
inline Status read_status(const Bytes& bytes) {
  Reader r(bytes);
  r.fingerprint();
  Status s;
  s.head = r.head();
  s.mode = r.i8();
  s.failsafe = r.i8();
  s.armed = r.i8() != 0;
  s.magnet = r.i8() != 0;
  s.attached = r.i8() != 0;
  s.cmd_session = r.i32();
  s.cmd_seq = r.i32();
  s.cmd_age_ms = r.i32();
  s.rejected = r.i32();
  s.text = r.text();
  return s;
}

struct Ack {
  Head head;
  std::string channel;
  std::int32_t session = 0, seq = 0;
  int result = 0;
  std::string text;
};
inline Ack read_ack(const Bytes& bytes) {
  Reader r(bytes);
  r.fingerprint();
  Ack a;
  a.head = r.head();
  a.channel = r.text();
  a.session = r.i32();
  a.seq = r.i32();
  a.result = r.i8();
  a.text = r.text();
  return a;
}

}  // namespace tandem::bridges::eyebot_emulator::hand_written
