#include "tests/controllers/decisions/made_up_robot.hpp"

#include <algorithm>
#include <cstring>
#include <numbers>

#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/time.hpp"

namespace tandem::decisions {
namespace {

template <class Part>
std::size_t mounts_of(const hal::RobotKind& kind) {
  const Part* const part = kind.part<Part>();
  return part != nullptr ? part->mounts.size() : 0;
}

constexpr std::int64_t kTick_ns = 100 * hal::kNsPerMs;
constexpr double kMostEntries = 12;  // of a list, e.g. of messages

/// SplitMix64's output function: one number, well mixed [Steele, Lea, Flood 2014].
std::uint64_t mixed(std::uint64_t z) noexcept {
  z += 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

std::uint64_t key_of(std::string_view text) noexcept {
  std::uint64_t key = 0;
  for (const char c : text) key = mixed(key ^ static_cast<unsigned char>(c));
  return key;
}

/// In [0, 1), with 24 bits: exact also as a float.
double part(std::uint64_t bits) noexcept {
  return static_cast<double>(bits >> 40U) * 0x1p-24;
}
double between(double least, double most, std::uint64_t bits) noexcept {
  return least + (most - least) * part(bits);
}
double whole(std::uint64_t most, std::uint64_t bits) noexcept {
  return static_cast<double>(bits % (most + 1));
}

bool is_float(hal::Scalar scalar) noexcept {
  return scalar == hal::Scalar::F32 || scalar == hal::Scalar::F64;
}

}  // namespace

void* MadeUpRobot::take(const hal::PortType& type) {
  auto& devices = type.role == hal::Role::Sensor ? sensors_ : actuators_;
  const auto [at, is_new] = devices.try_emplace(std::string(type.name));
  Device& device = at->second;
  if (is_new) {
    device.type = &type;
    device.memory.resize(type.size / sizeof(std::max_align_t) + 1);
    device.key = key_of(type.name);
    type.reset(device.port());
    if (type.role == hal::Role::Sensor) fill(device, 0);
  }
  return device.port();
}

void MadeUpRobot::sense(std::int64_t tick) {
  for (auto& [name, device] : sensors_) fill(device, tick);
}

void MadeUpRobot::fill_clock(Device& device, std::int64_t tick) {
  const hal::PortType& type = *device.type;
  hal::set_value(device.port(), *type.field("tick"), 0, static_cast<double>(tick));
  hal::set_value(device.port(), *type.field("now_ns"), 0, static_cast<double>(tick * kTick_ns));
  hal::set_value(device.port(), *type.field("tick_s"), 0, hal::to_seconds(kTick_ns));
}

void MadeUpRobot::fill(Device& device, std::int64_t tick) {
  auto* reading = static_cast<hal::Reading*>(device.port());
  reading->taken_ns = tick * kTick_ns;
  const std::uint64_t chance = mixed(device.key ^ static_cast<std::uint64_t>(tick)) % 128U;
  reading->validity = chance == 0 ? hal::Validity::Absent : chance == 1 ? hal::Validity::Stale : hal::Validity::Fresh;
  if (device.type->name == "clock") {
    reading->validity = hal::Validity::Fresh;
    return fill_clock(device, tick);
  }
  std::uint64_t stream = device.key;
  for (const hal::Field& field : device.type->fields) {
    if (field.name == "taken_ns" || field.name == "validity") continue;
    stream = mixed(stream);
    for (std::size_t i = 0; i < field.count; ++i) {
      // Every value is another one in every fourth tick, neighbours at different times.
      if (tick != 0 && (static_cast<std::uint64_t>(tick) + i) % 4U != 0) continue;
      const std::uint64_t bits = mixed(stream ^ mixed(static_cast<std::uint64_t>(tick) * 1024U + i));
      hal::set_value(device.port(), field, i, made_up(*device.type, field, i, bits));
    }
  }
}

double MadeUpRobot::entries(const hal::PortType& type, const hal::Field& field, std::uint64_t bits) const {
  const auto* const scanner = kind_.part<hal::ScannerPart>();
  const std::map<std::string_view, std::size_t> rings = {
      {"proximity", mounts_of<hal::ProximityPart>(kind_)},
      {"light", mounts_of<hal::LightPart>(kind_)},
      {"ground", mounts_of<hal::GroundPart>(kind_)},
      {"base_ground", mounts_of<hal::BaseGroundPart>(kind_)},
      {"motor_ground", mounts_of<hal::MotorGroundPart>(kind_)},
      {"microphones", mounts_of<hal::MicrophonesPart>(kind_)},
      {"distance_scanner", scanner != nullptr ? scanner->heads.size() : 0}};
  if (const auto ring = rings.find(type.name); ring != rings.end()) return static_cast<double>(ring->second);
  double capacity = kMostEntries;
  for (const hal::Field& other : type.fields) {
    if (other.used_by == field.name) capacity = std::min(capacity, static_cast<double>(other.count));
  }
  return whole(static_cast<std::uint64_t>(capacity), bits);
}

double MadeUpRobot::made_up(const hal::PortType& type, const hal::Field& field, std::size_t index,
                            std::uint64_t bits) const {
  constexpr double kPi = std::numbers::pi;
  if (field.name == "count") return entries(type, field, bits);
  if (field.name == "samples") return 1.0;
  if (field.name == "dropped") return 0.0;
  if (field.name == "size") return whole(10, bits);
  if (field.name == "width") return 640.0;
  if (field.name == "height") return 480.0;
  if (field.frame == hal::Frame::Sensor && field.unit.dim == hal::Dim::None && (field.name == "x" || field.name == "y"))
    return whole(479, bits);  // pixels
  if (field.name == "rgb") return bits % 2U == 0 ? 0.0 : 255.0;
  if (field.name == "orientation") return index == 0 ? 1.0 : 0.0;                 // a quaternion
  if (field.name == "phase") return bits % 8U == 0 ? whole(4, bits >> 8U) : 4.0;  // in the air, mostly
  if (field.name == "failsafe") return bits % 8U == 0 ? whole(2, bits >> 8U) : 0.0;
  if (field.name == "range" && field.count == 1) return kind_.part<hal::ProximityPart>()->range_m;
  if (field.scalar == hal::Scalar::Bool) return whole(1, bits);
  if (!is_float(field.scalar)) return whole(field.count == 1 ? 2 : 255, bits);
  switch (field.unit.dim) {
    case hal::Dim::Length:
      if (type.field("range") != nullptr && type.field("range")->count == 1)
        return bits % 2U == 0 ? kind_.part<hal::ProximityPart>()->range_m
                              : between(0.0, kind_.part<hal::ProximityPart>()->range_m, bits);
      return field.frame == hal::Frame::None || field.frame == hal::Frame::World ? between(-2.0, 2.0, bits)
                                                                                 : between(0.0, 1.5, bits);
    case hal::Dim::Speed:
      return between(-0.2, 0.2, bits);
    case hal::Dim::Angle:
      return between(-kPi, kPi, bits);
    case hal::Dim::AngularSpeed:
      return between(-1.0, 1.0, bits);
    case hal::Dim::Voltage:
      return between(3.0, 4.2, bits);
    case hal::Dim::Acceleration:
      return between(-10.0, 10.0, bits);
    case hal::Dim::None:
    case hal::Dim::Time:
    case hal::Dim::Frequency:
    case hal::Dim::Mass:
      break;
  }
  return between(0.0, 1.0, bits);
}

std::uint64_t MadeUpRobot::mix_commands(std::uint64_t hash) const noexcept {
  for (const auto& [name, device] : actuators_) {
    for (const hal::Field& field : device.type->fields) {
      for (std::size_t i = 0; i < field.count; ++i) {
        const double value = hal::get_value(device.port(), field, i);
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 1099511628211U;  // FNV-1a, eight bytes at once
        hash ^= hash >> 32U;
      }
    }
  }
  return hash;
}

}  // namespace tandem::decisions
