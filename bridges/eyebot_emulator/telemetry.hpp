// Telemetry of an eye-bot, as LCM payloads.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "bridges/eyebot_emulator/body.hpp"
#include "bridges/eyebot_emulator/commands.hpp"

namespace tandem::bridges::eyebot_emulator {

using Bytes = std::vector<std::byte>;

inline constexpr int kProtocolMajor = 1;
inline constexpr int kProtocolMinor = 0;

struct StatusReport {
  std::int8_t mode = 0;
  std::int8_t failsafe = 0;
  bool armed = false;
  bool magnet_on = false;
  bool attached = false;
  Header command{};  ///< of the last flight command that was accepted
  std::int32_t command_age_ms = -1;
  std::int32_t rejected = 0;
  std::string text{};
};

struct AckReport {
  std::string channel{};
  std::int32_t session = 0;
  std::int32_t seq = 0;
  std::int8_t result = 0;
  std::string text{};
};

struct BatteryReport {
  double voltage_V = 0.0;
  double current_A = 0.0;
  double charge = 0.0;
  double time_left_s = 0.0;  ///< negative: unknown
  bool low = false;
};

/// A measurement of the turning scanner.
struct ScanSample {
  std::uint8_t head = 0;
  std::int64_t utime = 0;
  double angle_rad = 0.0;
  double range_m = 0.0;  ///< -1: too near, -2: nothing in range
};

/// Promised by every heartbeat.
inline constexpr std::int32_t kHeartbeatPeriod_ms = 200;

/// A robot's, or a hub's.
Bytes write_heartbeat(const Header& header, const std::string& name, std::int64_t uptime_ms, bool hub = false);
Bytes write_status(const Header& header, const StatusReport& status);
Bytes write_state(const Header& header, const BodySenses& senses, bool position_valid);
Bytes write_altitude(const Header& header, const BodySenses& senses);
Bytes write_battery(const Header& header, const BatteryReport& battery);
Bytes write_scan(const Header& header, double rpm, double head_rad, const std::vector<ScanSample>& samples);
Bytes write_radio(const Header& header, const std::vector<Heard>& heard, std::int64_t received_utime);
/// 0 with nothing in range, 1 at contact, linear between.
Bytes write_proximity(const Header& header, const BodySenses& senses);
Bytes write_light(const Header& header, const BodySenses& senses);
Bytes write_pan_tilt(const Header& header, const BodySenses& senses, bool laser);
Bytes write_blobs(const Header& header, const BodySenses& senses);
/// The image of a ground that is a chessboard of decimetres: 64 by 48 pixels, grey.
Bytes write_image(const Header& header, const BodySenses& senses);
Bytes write_leds(const Header& header, const Lights& lights);
Bytes write_ack(const Header& header, const AckReport& ack);

}  // namespace tandem::bridges::eyebot_emulator
