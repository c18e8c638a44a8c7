#include "bridges/eyebot/readings.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "bridges/eyebot/flight_plan.hpp"

namespace tandem::bridges::eyebot {
namespace {

namespace messages = eyebot_messages;

constexpr double kRpm = 2.0 * std::numbers::pi / 60.0;  // rad/s

Vector vector_of(const double (&v)[3]) noexcept {
  return {v[0], v[1], v[2]};
}
Quaternion quaternion_of(const double (&q)[4]) noexcept {
  return {q[0], q[1], q[2], q[3]};
}
void put(const Vector& v, double (&out)[3]) noexcept {
  std::copy(v.begin(), v.end(), out);
}

}  // namespace

void read(const messages::State& m, const WorldFrame& world, hal::Positioning& port) noexcept {
  port.p_WB = world.place_in_run(vector_of(m.pos));
  port.q_WB = world.orientation_in_run(quaternion_of(m.quat));
}

void read(const messages::State& m, const WorldFrame& world, hal::FlightState& port) noexcept {
  port.velocity = world.direction_in_run(vector_of(m.vel));
  const Quaternion q = world.orientation_in_run(quaternion_of(m.quat));
  port.yaw_rad_s = turned(q, vector_of(m.omega))[2];
}

void read(const messages::State& m, hal::Gyroscope& port) noexcept {
  for (std::size_t i = 0; i < 3; ++i) port.rate_rad_s[i] = static_cast<float>(m.omega[i]);
}

void read(const messages::Status& m, hal::FlightState& port) noexcept {
  port.phase = phase_of(mode_of(m.mode));
  port.failsafe = failsafe_of(m.failsafe);
}

void read(const messages::Altitude& m, hal::Altimeter& port) noexcept {
  port.ground_m = m.ground < 0.0F ? -1.0F : m.ground;
  port.ceiling_m = m.ceiling < 0.0F ? -1.0F : m.ceiling;
}

void read(const messages::Battery& m, const hal::RobotKind& kind, hal::Battery& port) noexcept {
  const auto* const part = kind.part<hal::BatteryPart>();
  const float empty = part != nullptr ? static_cast<float>(part->empty_V) : 0.0F;
  const float full = part != nullptr ? static_cast<float>(part->full_V) : 1.0F;
  port.supply_V = m.voltage;
  port.charge = std::clamp(m.charge < 0.0F ? (m.voltage - empty) / (full - empty) : m.charge, 0.0F, 1.0F);
}

void read(const messages::Scan& m, const hal::RobotKind& kind, hal::DistanceScanner& port) noexcept {
  using hal::DistanceScanner;
  const auto* const part = kind.part<hal::ScannerPart>();
  const hal::ScannerHead head_part = part != nullptr ? part->heads[0] : hal::ScannerHead{};  // all heads see alike
  const auto least_m = static_cast<float>(head_part.min_m);
  const auto most_m = static_cast<float>(head_part.max_m);
  port.short_min_m = port.long_min_m = least_m;
  port.short_max_m = port.long_max_m = most_m;
  port.turn_rad = m.head_angle;
  std::array<std::size_t, DistanceScanner::kHeads> counts{};
  const auto n = static_cast<std::size_t>(m.n);
  for (std::size_t i = 0; i < n; ++i) {
    if (m.sensor[i] < counts.size()) ++counts[m.sensor[i]];
  }
  const std::size_t most = *std::max_element(counts.begin(), counts.end());
  port.samples = static_cast<std::uint32_t>(std::min(most, DistanceScanner::kSamples));
  port.count = static_cast<std::uint32_t>(DistanceScanner::kHeads) * port.samples;
  std::array<std::size_t, DistanceScanner::kHeads> seen{}, kept{};
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t head = m.sensor[i];
    if (head >= counts.size() || seen[head]++ + DistanceScanner::kSamples < counts[head]) continue;
    const std::size_t at = port.at(head, kept[head]++);
    port.angle_rad[at] = m.angle[i];
    port.distance_m[at] = m.range[i] <= -2.0F ? most_m : std::clamp(m.range[i], least_m, most_m);  // -1: too near
  }
  for (std::size_t head = 0; head < kept.size(); ++head) {
    for (std::size_t k = kept[head]; k < port.samples; ++k) {
      port.angle_rad[port.at(head, k)] = m.head_angle;
      port.distance_m[port.at(head, k)] = most_m;
    }
  }
}

void read(const messages::Prox& m, const hal::RobotKind& kind, hal::Proximity& port) noexcept {
  const auto* const part = kind.part<hal::ProximityPart>();
  if (part == nullptr) return;
  port.count = static_cast<std::uint32_t>(std::min(part->mounts.size(), std::size(m.proximity)));
  port.range_m = static_cast<float>(part->range_m);
  for (std::size_t i = 0; i < port.count; ++i) {
    port.distance_m[i] = port.range_m * (1.0F - std::clamp(m.proximity[i], 0.0F, 1.0F));
  }
}

void read(const messages::Light& m, const hal::RobotKind& kind, hal::Light& port) noexcept {
  const auto* const part = kind.part<hal::LightPart>();
  if (part == nullptr) return;
  port.count = static_cast<std::uint32_t>(std::min(part->mounts.size(), std::size(m.light)));
  for (std::size_t i = 0; i < port.count; ++i) port.level[i] = std::clamp(m.light[i], 0.0F, 1.0F);
}

void read(const messages::PanTilt& m, hal::PanTiltEncoder& port) noexcept {
  port.pan_rad = static_cast<double>(m.pan);
  port.tilt_rad = static_cast<double>(m.tilt);
}

void read(const messages::Blobs& m, hal::PerspectiveCamera& port) noexcept {
  port.count = port.dropped = 0;
  port.width_px = static_cast<std::uint32_t>(std::max<std::int16_t>(m.width, 0));
  port.height_px = static_cast<std::uint32_t>(std::max<std::int16_t>(m.height, 0));
  const auto append = [&](const messages::Blob& b) { port.append(b.x, b.y, {b.rgb[0], b.rgb[1], b.rgb[2]}); };
  // By selection: what the port holds is little, and nothing is allocated.
  float last = -1.0F;
  std::size_t last_index = 0;
  for (bool more = true; more;) {
    const messages::Blob* next = nullptr;
    std::size_t next_index = 0;
    for (std::size_t i = 0; i < m.blob.size(); ++i) {
      const float range = m.blob[i].range;
      const bool behind = range > last || (range == last && i > last_index);
      if (range >= 0.0F && behind && (next == nullptr || range < next->range)) {
        next = &m.blob[i];
        next_index = i;
      }
    }
    more = next != nullptr && port.count < hal::PerspectiveCamera::kCapacity;
    if (!more) break;
    last = next->range;
    last_index = next_index;
    append(*next);
  }
  std::size_t known = 0;
  for (const messages::Blob& b : m.blob) {
    if (b.range < 0.0F) append(b);
    known += b.range < 0.0F ? 0U : 1U;
  }
  if (known > hal::PerspectiveCamera::kCapacity) {
    port.dropped += static_cast<std::uint32_t>(known - hal::PerspectiveCamera::kCapacity);
  }
}

void add(const messages::Rab& m, hal::RangeAndBearing& port) noexcept {
  for (const messages::RabPacket& p : m.pkt) {
    const auto n = static_cast<std::uint8_t>(std::min(p.data.size(), hal::kRabPayloadMax));
    port.insert(std::max(p.range, 0.0F), p.bearing, p.elevation, p.data.data(), n);
  }
}

void write(const hal::RingLeds* lower, const hal::UpperRingLeds* upper, const hal::CameraLed* camera,
           messages::Leds& m) noexcept {
  m.rings =
      static_cast<std::int8_t>((lower != nullptr ? 1 : 0) | (upper != nullptr ? 2 : 0) | (camera != nullptr ? 4 : 0));
  const auto ring = [](const hal::RingLeds* leds, std::uint8_t(&out)[16][3]) {
    for (std::size_t i = 0; i < 16; ++i) {
      for (std::size_t k = 0; k < 3; ++k) out[i][k] = leds == nullptr ? std::uint8_t{0} : leds->rgb[3 * i + k];
    }
  };
  ring(lower, m.lower);
  ring(upper, m.upper);
  for (std::size_t k = 0; k < 3; ++k) m.beacon[k] = camera == nullptr ? std::uint8_t{0} : camera->rgb[k];
}

void write(const hal::PanTiltDrive& port, messages::CmdPanTilt& m) noexcept {
  m.pan_target = static_cast<float>(port.pan_rad);
  m.tilt_target = static_cast<float>(port.tilt_rad);
  m.laser = port.laser ? 1 : 0;
}

void write(const hal::ScannerDrive& port, messages::CmdScanner& m) noexcept {
  m.enable = port.mode != hal::ScannerMode::Off ? 1 : 0;
  m.fixed = port.mode == hal::ScannerMode::Position ? 1 : 0;
  m.rpm = port.mode == hal::ScannerMode::Speed ? static_cast<float>(port.speed_rad_s / kRpm) : 0.0F;
  m.angle = port.mode == hal::ScannerMode::Position ? static_cast<float>(port.angle_rad) : 0.0F;
}

void write(const hal::RangeAndBearingSend& port, messages::CmdRab& m) noexcept {
  const std::size_t n = port.sending ? std::min<std::size_t>(port.size, hal::kRabPayloadMax) : 0;
  m.len = static_cast<std::int8_t>(n);
  m.data.assign(port.payload.begin(), port.payload.begin() + static_cast<std::ptrdiff_t>(n));
}

void write(const hal::QuadrotorSpeed& port, const WorldFrame& world, messages::CmdVelocity& m) noexcept {
  m.frame = messages::CmdVelocity::FRAME_WORLD;
  put(world.direction_of_robot(port.velocity), m.vel);
  m.yaw_rate = port.yaw_rad_s;
}

void write(const hal::QuadrotorPosition& port, const WorldFrame& world, messages::CmdPosition& m) noexcept {
  m.frame = messages::CmdPosition::FRAME_WORLD;
  put(world.place_of_robot(port.target), m.pos);
  m.use_yaw = 1;
  m.yaw = world.heading_of_robot(port.yaw_rad);
}

}  // namespace tandem::bridges::eyebot
