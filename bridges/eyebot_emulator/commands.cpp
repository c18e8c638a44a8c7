#include "bridges/eyebot_emulator/commands.hpp"

#include <algorithm>
#include <cmath>
#include <eyebot_c/eyebot_cmd_mode_t.h>
#include <eyebot_c/eyebot_cmd_pan_tilt_t.h>
#include <eyebot_c/eyebot_cmd_position_t.h>
#include <eyebot_c/eyebot_cmd_rab_t.h>
#include <eyebot_c/eyebot_cmd_scanner_t.h>
#include <eyebot_c/eyebot_cmd_velocity_t.h>
#include <eyebot_c/eyebot_heartbeat_t.h>
#include <eyebot_c/eyebot_leds_t.h>

#include "hal/finite.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using hal::all_finite;
using Payload = std::span<const std::byte>;

constexpr std::size_t kHead = 24;  // fingerprint and header

hal::Error refused(std::string_view topic, const std::string& why) {
  return hal::Error{std::string(topic) + ": " + why};
}

/// The generated decoder allocates what a length says before it looks for the bytes, and takes a text without end: the
/// sizes of messages that carry lengths are checked before it sees them.
std::string wrong_size(std::size_t expected, Payload payload) {
  if (payload.size() == expected) return {};
  return std::to_string(payload.size()) + " bytes instead of " + std::to_string(expected);
}

std::int32_t int32_at(Payload payload, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | std::to_integer<std::uint32_t>(payload[at + i]);
  return static_cast<std::int32_t>(value);
}

std::string why_no_radio(Payload payload) {
  if (payload.size() <= kHead) return wrong_size(kHead + 1, payload);
  const int length = static_cast<std::int8_t>(payload[kHead]);
  if (length < 0) return "length " + std::to_string(length);
  return wrong_size(kHead + 1 + static_cast<std::size_t>(length), payload);
}

std::string why_no_heartbeat(Payload payload) {
  constexpr std::size_t kBeside = kHead + 4 + 3 + 4 + 8;  // all but the name
  constexpr std::int32_t kLongestName = 64;
  if (payload.size() < kBeside) return wrong_size(kBeside, payload);
  const std::int32_t length = int32_at(payload, kHead);
  if (length < 1 || length > kLongestName) return "a name of " + std::to_string(length) + " bytes";
  const auto size = static_cast<std::size_t>(length);
  if (const std::string wrong = wrong_size(kBeside + size, payload); !wrong.empty()) return wrong;
  const Payload name = payload.subspan(kHead + 4, size);
  if (std::ranges::find(name, std::byte{0}) != name.end() - 1) return "a name that does not end where it should";
  return {};
}

/// What commands say, as they are decoded.
struct Body {
  static CommandBody of(const eyebot_cmd_mode_t& m) { return ModeCommand{m.action, m.param}; }
  static CommandBody of(const eyebot_cmd_position_t& m) {
    return PositionCommand{m.frame, m.use_yaw != 0, std::to_array(m.pos), m.yaw, m.max_speed, m.timeout_ms};
  }
  static CommandBody of(const eyebot_cmd_velocity_t& m) {
    return VelocityCommand{m.frame, std::to_array(m.vel), m.yaw_rate, m.timeout_ms};
  }
  static CommandBody of(const eyebot_leds_t& m) {
    LedsCommand leds{.rings = m.rings, .beacon = std::to_array(m.beacon)};
    std::copy_n(&m.lower[0][0], leds.lower.size(), leds.lower.begin());
    std::copy_n(&m.upper[0][0], leds.upper.size(), leds.upper.begin());
    return leds;
  }
  static CommandBody of(const eyebot_cmd_pan_tilt_t& m) {
    return PanTiltCommand{m.pan_target, m.tilt_target, m.laser != 0};
  }
  static CommandBody of(const eyebot_cmd_scanner_t& m) {
    return ScannerCommand{m.enable != 0, m.fixed != 0, m.rpm, m.angle};
  }
  static CommandBody of(const eyebot_cmd_rab_t& m) { return RadioCommand{{m.data, m.data + m.len}}; }
  static CommandBody of(const eyebot_heartbeat_t& m) {
    return HubHeartbeat{m.name, m.role, m.proto_major, m.proto_minor, m.period_ms};
  }
};

template <class Message, auto decode, auto cleanup>
hal::Result<Command> read(std::string_view topic, Payload payload) {
  Message message{};
  const int used = decode(payload.data(), 0, static_cast<int>(payload.size()), &message);
  // A failure leaves nothing behind: it is noticed at the fingerprint, as the sizes have been checked.
  if (used < 0) return refused(topic, "another fingerprint");
  Command command{{message.hdr.utime, message.hdr.seq, message.hdr.session}, Body::of(message)};
  cleanup(&message);
  return command;
}

struct Reader {
  std::size_t size;  ///< 0: it depends
  std::string (*why_not)(Payload);
  hal::Result<Command> (*read)(std::string_view, Payload);
};

constexpr std::array<Reader, kCommandChannels.size()> kReaders = {{
    {29, nullptr, read<eyebot_cmd_mode_t, eyebot_cmd_mode_t_decode, eyebot_cmd_mode_t_decode_cleanup>},
    {66, nullptr, read<eyebot_cmd_position_t, eyebot_cmd_position_t_decode, eyebot_cmd_position_t_decode_cleanup>},
    {61, nullptr, read<eyebot_cmd_velocity_t, eyebot_cmd_velocity_t_decode, eyebot_cmd_velocity_t_decode_cleanup>},
    {124, nullptr, read<eyebot_leds_t, eyebot_leds_t_decode, eyebot_leds_t_decode_cleanup>},
    {33, nullptr, read<eyebot_cmd_pan_tilt_t, eyebot_cmd_pan_tilt_t_decode, eyebot_cmd_pan_tilt_t_decode_cleanup>},
    {34, nullptr, read<eyebot_cmd_scanner_t, eyebot_cmd_scanner_t_decode, eyebot_cmd_scanner_t_decode_cleanup>},
    {0, why_no_radio, read<eyebot_cmd_rab_t, eyebot_cmd_rab_t_decode, eyebot_cmd_rab_t_decode_cleanup>},
    {0, why_no_heartbeat, read<eyebot_heartbeat_t, eyebot_heartbeat_t_decode, eyebot_heartbeat_t_decode_cleanup>},
}};

struct Finite {
  bool operator()(const auto&) const { return true; }
  bool operator()(const ModeCommand& c) const { return std::isfinite(c.param); }
  bool operator()(const PositionCommand& c) const { return all_finite(c.pos) && all_finite({c.yaw, c.max_speed}); }
  bool operator()(const VelocityCommand& c) const { return all_finite(c.vel) && std::isfinite(c.yaw_rate); }
  bool operator()(const PanTiltCommand& c) const { return all_finite({c.pan, c.tilt}); }
  bool operator()(const ScannerCommand& c) const { return all_finite({c.rpm, c.angle}); }
};

}  // namespace

hal::Result<Command> read_command(std::string_view topic, std::span<const std::byte> payload) {
  const auto found = std::ranges::find(kCommandChannels, topic);
  if (found == kCommandChannels.end()) return refused(topic, "there is no such channel");
  const Reader& reader = kReaders[static_cast<std::size_t>(found - kCommandChannels.begin())];
  const std::string wrong = reader.why_not != nullptr ? reader.why_not(payload) : wrong_size(reader.size, payload);
  if (!wrong.empty()) return refused(topic, wrong);
  return reader.read(topic, payload);
}

bool is_finite(const CommandBody& body) {
  return std::visit(Finite{}, body);
}

}  // namespace tandem::bridges::eyebot_emulator
