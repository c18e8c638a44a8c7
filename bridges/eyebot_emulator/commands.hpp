// Decoder of commands to an eye-bot from LCM payloads; whatever is not exactly a command is refused.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hal/result.hpp"

namespace tandem::bridges::eyebot_emulator {

/// Begins every message.
struct Header {
  std::int64_t utime = 0;  ///< microseconds since the Unix epoch, the sender's clock, of issue
  std::int32_t seq = 0;    ///< one more for every message of this sender on this channel; wraps
  std::int32_t session = 0;
};

/// The numbers are the protocol's.
enum class Action : std::int8_t { Nop, Arm, Disarm, TakeOff, Hover, Land, Attach, Detach, Estop, ClearFailsafe };
enum class Frame : std::int8_t { World = 0, Body = 1 };

struct ModeCommand {
  std::int8_t action = 0;  ///< as received: perhaps none of `Action`
  float param = 0.0F;      ///< speed of climbing or sinking, m/s; 0: the robot's own
};
struct PositionCommand {
  std::int8_t frame = 0;
  bool use_yaw = false;
  std::array<double, 3> pos{};
  double yaw = 0.0;
  float max_speed = 0.0F;
  std::int32_t timeout_ms = 0;
};
struct VelocityCommand {
  std::int8_t frame = 0;
  std::array<double, 3> vel{};
  double yaw_rate = 0.0;
  std::int32_t timeout_ms = 0;
};
struct LedsCommand {
  std::int8_t rings = 0;
  std::array<std::uint8_t, 48> lower{};
  std::array<std::uint8_t, 48> upper{};
  std::array<std::uint8_t, 3> beacon{};
};
struct PanTiltCommand {
  float pan = 0.0F;
  float tilt = 0.0F;
  bool laser = false;
};
struct ScannerCommand {
  bool enable = false;
  bool fixed = false;
  float rpm = 0.0F;
  float angle = 0.0F;
};
struct RadioCommand {
  std::vector<std::uint8_t> data{};
};
struct HubHeartbeat {
  std::string name{};
  std::int8_t role = 0;
  std::int8_t major = 0;
  std::int8_t minor = 0;
  std::int32_t period_ms = 0;
};

/// In the order of `kCommandChannels`.
using CommandBody = std::variant<ModeCommand, PositionCommand, VelocityCommand, LedsCommand, PanTiltCommand,
                                 ScannerCommand, RadioCommand, HubHeartbeat>;
struct Command {
  Header header{};
  CommandBody body{};
};

/// Ends of the channels' names behind "eyebot/<robot>/", and at last that of hubs.
inline constexpr std::array<std::string_view, 8> kCommandChannels = {
    "cmd/mode", "cmd/position", "cmd/velocity", "cmd/leds", "cmd/pan_tilt", "cmd/scanner", "cmd/rab", "heartbeat"};

/// Reads what came on the channel that ends in `topic`. Errors: no such topic; a payload of another size, type or
/// fingerprint, lengths that are negative or do not fit, texts without end. Never throws, whatever the bytes.
hal::Result<Command> read_command(std::string_view topic, std::span<const std::byte> payload);

/// No number in it is NaN or infinite.
bool is_finite(const CommandBody& body);

}  // namespace tandem::bridges::eyebot_emulator
