#include "bridges/eyebot_emulator/telemetry.hpp"

#include <algorithm>
#include <cmath>
#include <eyebot_c/eyebot_ack_t.h>
#include <eyebot_c/eyebot_altitude_t.h>
#include <eyebot_c/eyebot_battery_t.h>
#include <eyebot_c/eyebot_blobs_t.h>
#include <eyebot_c/eyebot_heartbeat_t.h>
#include <eyebot_c/eyebot_image_t.h>
#include <eyebot_c/eyebot_leds_t.h>
#include <eyebot_c/eyebot_light_t.h>
#include <eyebot_c/eyebot_pan_tilt_t.h>
#include <eyebot_c/eyebot_prox_t.h>
#include <eyebot_c/eyebot_rab_t.h>
#include <eyebot_c/eyebot_scan_t.h>
#include <eyebot_c/eyebot_state_t.h>
#include <eyebot_c/eyebot_status_t.h>

#include "hal/angle.hpp"
#include "hal/check.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

float as_float(double value) {
  return static_cast<float>(value);
}

/// The generated encoder changes nothing, although it asks for texts that could be changed.
char* text_of(const std::string& text) {
  return const_cast<char*>(text.c_str());
}

/// `hdr` of the message is `header`.
template <auto size, auto encode, class Message>
Bytes encoded(const Header& header, Message message) {
  message.hdr = {header.utime, header.seq, header.session};
  Bytes bytes(static_cast<std::size_t>(size(&message)));
  const int written = encode(bytes.data(), 0, static_cast<int>(bytes.size()), &message);
  TANDEM_CHECK(written == static_cast<int>(bytes.size()), "a message is as long as it says");
  return bytes;
}

/// Brightness of a ground that is a chessboard of decimetres.
std::uint8_t ground_at(double x_m, double y_m) {
  const auto field = static_cast<long>(std::floor(x_m / 0.1)) + static_cast<long>(std::floor(y_m / 0.1));
  return field % 2 == 0 ? 200 : 50;
}

struct Direction {
  double azimuth_rad;
  double elevation_rad;
};

/// Where a pixel looks, in the body frame. The upper edge of the image is ahead of a camera that looks down.
Direction direction_of(const Blob& blob, const BodySenses& senses) {
  const auto& camera = robot_part<hal::CameraPart>();
  const auto width = static_cast<double>(camera.width_px);
  const auto height = static_cast<double>(camera.height_px);
  const double per_px = 2.0 * std::tan(0.5 * camera.aperture_rad) / width;
  const double ahead = (0.5 * height - blob.y_px) * per_px;
  const double left = (0.5 * width - blob.x_px) * per_px;
  const double c = std::cos(senses.tilt_rad);
  const double s = std::sin(senses.tilt_rad);
  const double along = c * ahead + s;
  const double down = c - s * ahead;
  return {hal::wrapped(std::atan2(left, along) + senses.pan_rad), -std::atan2(down, std::hypot(along, left))};
}

}  // namespace

Bytes write_heartbeat(const Header& header, const std::string& name, std::int64_t uptime_ms, bool hub) {
  const auto role = static_cast<std::int8_t>(hub ? EYEBOT_HEARTBEAT_T_ROLE_HUB : EYEBOT_HEARTBEAT_T_ROLE_ROBOT);
  return encoded<eyebot_heartbeat_t_encoded_size, eyebot_heartbeat_t_encode>(
      header,
      eyebot_heartbeat_t{{}, text_of(name), role, kProtocolMajor, kProtocolMinor, kHeartbeatPeriod_ms, uptime_ms});
}

Bytes write_status(const Header& header, const StatusReport& status) {
  return encoded<eyebot_status_t_encoded_size, eyebot_status_t_encode>(
      header, eyebot_status_t{.hdr = {},
                              .mode = status.mode,
                              .failsafe = status.failsafe,
                              .armed = status.armed,
                              .magnet_on = status.magnet_on,
                              .attached = status.attached,
                              .cmd_session = status.command.session,
                              .cmd_seq = status.command.seq,
                              .cmd_age_ms = status.command_age_ms,
                              .cmd_rejected = status.rejected,
                              .text = text_of(status.text)});
}

Bytes write_state(const Header& header, const BodySenses& senses, bool position_valid) {
  constexpr double kSigma_m = 0.01;
  eyebot_state_t m{};
  m.source = EYEBOT_STATE_T_SRC_ONBOARD;
  m.pos_valid = position_valid ? 1 : 0;
  m.yaw_valid = 1;
  std::ranges::copy(senses.p_WB, m.pos);
  std::ranges::copy(senses.v_WB, m.vel);
  std::ranges::copy(senses.q_WB, m.quat);
  std::ranges::copy(senses.turn_rad_s, m.omega);
  m.pos_sigma = position_valid ? as_float(kSigma_m) : -1.0F;
  return encoded<eyebot_state_t_encoded_size, eyebot_state_t_encode>(header, m);
}

Bytes write_altitude(const Header& header, const BodySenses& senses) {
  return encoded<eyebot_altitude_t_encoded_size, eyebot_altitude_t_encode>(
      header, eyebot_altitude_t{{}, as_float(senses.ground_m), as_float(senses.ceiling_m)});
}

Bytes write_battery(const Header& header, const BatteryReport& battery) {
  return encoded<eyebot_battery_t_encoded_size, eyebot_battery_t_encode>(
      header, eyebot_battery_t{.hdr = {},
                               .voltage = as_float(battery.voltage_V),
                               .current = as_float(battery.current_A),
                               .charge = as_float(battery.charge),
                               .time_left = as_float(battery.time_left_s),
                               .low = battery.low});
}

Bytes write_scan(const Header& header, double rpm, double head_rad, const std::vector<ScanSample>& samples) {
  std::vector<std::uint8_t> sensor;
  std::vector<std::int32_t> dt_us;
  std::vector<float> angle;
  std::vector<float> range;
  for (const ScanSample& s : samples) {
    sensor.push_back(s.head);
    dt_us.push_back(static_cast<std::int32_t>(s.utime - header.utime));
    angle.push_back(as_float(s.angle_rad));
    range.push_back(as_float(s.range_m));
  }
  return encoded<eyebot_scan_t_encoded_size, eyebot_scan_t_encode>(
      header, eyebot_scan_t{.hdr = {},
                            .rpm = as_float(rpm),
                            .head_angle = as_float(head_rad),
                            .n = static_cast<std::int32_t>(samples.size()),
                            .sensor = sensor.data(),
                            .dt_us = dt_us.data(),
                            .angle = angle.data(),
                            .range = range.data()});
}

Bytes write_radio(const Header& header, const std::vector<Heard>& heard, std::int64_t received_utime) {
  std::vector<eyebot_rab_packet_t> packets;
  for (const Heard& h : heard) {
    const auto length = static_cast<std::int8_t>(std::min<std::size_t>(h.payload.size(), 127));
    packets.push_back({h.sender, as_float(h.range_m), as_float(h.bearing_rad), as_float(h.elevation_rad),
                       received_utime, length, const_cast<std::uint8_t*>(h.payload.data())});  // only read
  }
  return encoded<eyebot_rab_t_encoded_size, eyebot_rab_t_encode>(
      header, eyebot_rab_t{{}, static_cast<std::int32_t>(packets.size()), packets.data()});
}

Bytes write_proximity(const Header& header, const BodySenses& senses) {
  eyebot_prox_t m{};
  for (std::size_t i = 0; i < senses.distance_m.size(); ++i) {
    m.proximity[i] =
        as_float(std::clamp(1.0 - senses.distance_m[i] / robot_part<hal::ProximityPart>().range_m, 0.0, 1.0));
  }
  return encoded<eyebot_prox_t_encoded_size, eyebot_prox_t_encode>(header, m);
}

Bytes write_light(const Header& header, const BodySenses& senses) {
  eyebot_light_t m{};
  std::ranges::transform(senses.light, m.light, as_float);
  return encoded<eyebot_light_t_encoded_size, eyebot_light_t_encode>(header, m);
}

Bytes write_pan_tilt(const Header& header, const BodySenses& senses, bool laser) {
  return encoded<eyebot_pan_tilt_t_encoded_size, eyebot_pan_tilt_t_encode>(
      header, eyebot_pan_tilt_t{{}, as_float(senses.pan_rad), as_float(senses.tilt_rad), laser});
}

Bytes write_blobs(const Header& header, const BodySenses& senses) {
  std::vector<eyebot_blob_t> blobs;
  for (const Blob& b : senses.blobs) {
    const Direction seen = direction_of(b, senses);
    blobs.push_back({.x = as_float(b.x_px),
                     .y = as_float(b.y_px),
                     .area = 1.0F,
                     .rgb = {b.rgb[0], b.rgb[1], b.rgb[2]},
                     .range = -1.0F,
                     .azimuth = as_float(seen.azimuth_rad),
                     .elevation = as_float(seen.elevation_rad)});
  }
  const auto& camera = robot_part<hal::CameraPart>();
  return encoded<eyebot_blobs_t_encoded_size, eyebot_blobs_t_encode>(
      header, eyebot_blobs_t{{},
                             static_cast<std::int16_t>(camera.width_px),
                             static_cast<std::int16_t>(camera.height_px),
                             static_cast<std::int32_t>(blobs.size()),
                             blobs.data()});
}

Bytes write_image(const Header& header, const BodySenses& senses) {
  constexpr int kWidth = 64;
  constexpr int kHeight = 48;
  constexpr std::int32_t kGrey = 'G' | 'R' << 8 | 'E' << 16 | 'Y' << 24;
  const double m_per_px =
      2.0 * std::max(0.0, senses.p_WB[2]) * std::tan(0.5 * robot_part<hal::CameraPart>().aperture_rad) / kWidth;
  std::vector<std::uint8_t> pixels;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double x_m = senses.p_WB[0] + m_per_px * (0.5 * kHeight - row);
      const double y_m = senses.p_WB[1] + m_per_px * (0.5 * kWidth - column);
      pixels.push_back(ground_at(x_m, y_m));
    }
  }
  return encoded<eyebot_image_t_encoded_size, eyebot_image_t_encode>(
      header,
      eyebot_image_t{{}, kWidth, kHeight, kWidth, kGrey, static_cast<std::int32_t>(pixels.size()), pixels.data()});
}

Bytes write_leds(const Header& header, const Lights& lights) {
  eyebot_leds_t m{};
  m.rings =
      static_cast<std::int8_t>((lights.lower_on ? 1 : 0) | (lights.upper_on ? 2 : 0) | (lights.beacon_on ? 4 : 0));
  std::ranges::copy(lights.lower, &m.lower[0][0]);
  std::ranges::copy(lights.upper, &m.upper[0][0]);
  std::ranges::copy(lights.beacon, m.beacon);
  return encoded<eyebot_leds_t_encoded_size, eyebot_leds_t_encode>(header, m);
}

Bytes write_ack(const Header& header, const AckReport& ack) {
  return encoded<eyebot_ack_t_encoded_size, eyebot_ack_t_encode>(
      header, eyebot_ack_t{{}, text_of(ack.channel), ack.session, ack.seq, ack.result, text_of(ack.text)});
}

}  // namespace tandem::bridges::eyebot_emulator
