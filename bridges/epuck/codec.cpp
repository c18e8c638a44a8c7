#include "bridges/epuck/codec.hpp"

#include <algorithm>
#include <bit>

namespace tandem::bridges::epuck {
namespace {

/// Command byte of an ASCII letter.
constexpr std::uint8_t code(char letter) noexcept {
  return static_cast<std::uint8_t>(256 - letter);
}

constexpr std::uint8_t kRgbLeds = 0xF6;
constexpr std::uint8_t kAllSensors = 0xF8;
constexpr std::uint8_t kFourMicrophones = 0xF4;
constexpr std::uint8_t kTimeOfFlight = 0xF3;
constexpr std::uint8_t kWifiCommand = 0x80;
constexpr std::uint8_t kWifiImage = 0x01, kWifiSensors = 0x02, kWifiEmpty = 0x03;

constexpr std::array<std::uint8_t, kQuantityCount> kQueries = {code('Q'),     code('N'),   code('O'), code('a'),
                                                               code('u'),     code('g'),   code('b'), code('M'),
                                                               kTimeOfFlight, kAllSensors, code('E')};

std::uint8_t low(std::int16_t v) noexcept {
  return static_cast<std::uint8_t>(static_cast<std::uint16_t>(v) & 0xFF);
}
std::uint8_t high(std::int16_t v) noexcept {
  return static_cast<std::uint8_t>(static_cast<std::uint16_t>(v) >> 8);
}

/// Reads little-endian values one after the other. The caller has checked the length.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) noexcept : bytes_(bytes) {}

  std::uint8_t u8() noexcept { return at_ < bytes_.size() ? bytes_[at_++] : std::uint8_t{0}; }
  std::uint16_t u16() noexcept {
    const unsigned lo = u8();
    return static_cast<std::uint16_t>(lo | static_cast<unsigned>(u8()) << 8);
  }
  std::int16_t i16() noexcept { return static_cast<std::int16_t>(u16()); }
  float f32() noexcept {
    const std::uint32_t lo = u16();
    return std::bit_cast<float>(lo | std::uint32_t{u16()} << 16);
  }
  template <std::size_t N>
  void fill(std::array<std::uint16_t, N>& values) noexcept {
    for (auto& v : values) v = u16();
  }
  template <std::size_t N>
  void fill(std::array<std::int16_t, N>& values) noexcept {
    for (auto& v : values) v = i16();
  }
  std::span<const std::uint8_t> take(std::size_t n) noexcept {
    const auto part = bytes_.subspan(at_, std::min(n, bytes_.size() - at_));
    at_ += part.size();
    return part;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

bool within_12_bits(std::span<const std::uint16_t> values) noexcept {
  return std::all_of(values.begin(), values.end(), [](std::uint16_t v) { return v <= 4095; });
}

void read_ground(Reader& in, std::size_t size, RawSensors& s) noexcept {
  if (size == 0) return;
  in.fill(s.ground);
  s.cliffs = static_cast<std::uint8_t>(std::clamp<std::size_t>(size / 2, 3, 5) - s.ground.size());
  for (std::size_t i = 0; i < s.cliffs; ++i) s.cliff[i] = in.u16();
}

/// Of all sensors: the others are asked for by themselves.
void read_selector(Reader& in, RawSensors& s) noexcept {
  AllSensors all;
  if (decode_all_sensors(in.take(kAllSensorsSize), all) == Decoded::Ok) s.selector = all.common.selector;
}

void read_quantity(Reader& in, Quantity q, std::size_t size, RawSensors& s) noexcept {
  switch (q) {
    case Quantity::Encoders:
      in.fill(s.encoders);
      break;
    case Quantity::Proximity:
      in.fill(s.proximity);
      break;
    case Quantity::Ambient:
      in.fill(s.ambient);
      break;
    case Quantity::Acceleration:
      in.fill(s.acceleration);
      break;
    case Quantity::Microphones:
      for (std::size_t i = 0; i < size / 2; ++i) s.microphones[i] = in.u16();
      break;
    case Quantity::Gyro:
      if (size > 0) in.fill(s.gyro);
      break;
    case Quantity::Battery:
      if (size > 0) s.battery = in.u16();
      break;
    case Quantity::Ground:
      read_ground(in, size, s);
      break;
    case Quantity::TimeOfFlight:
      if (size > 0) s.time_of_flight_mm = in.u16();
      break;
    case Quantity::Selector:
      if (size > 0) read_selector(in, s);
      break;
    case Quantity::CommandedSpeeds:
      in.fill(s.commanded);
      break;
  }
}

template <class F>
void for_each(QuantitySet quantities, F&& f) {
  for (std::size_t i = 0; i < kQuantityCount; ++i) {
    if (quantities.has(static_cast<Quantity>(i))) f(static_cast<Quantity>(i));
  }
}

}  // namespace

bool Packet::append(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() > kCapacity - size_) return false;
  std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += bytes.size();
  return true;
}

bool append_speeds(Packet& packet, StepsPerS left, StepsPerS right) noexcept {
  return packet.append({code('D'), low(left.value), high(left.value), low(right.value), high(right.value)});
}

bool append_led(Packet& packet, std::uint8_t index, LedAction action) noexcept {
  return packet.append({code('L'), index, static_cast<std::uint8_t>(action)});
}

bool append_rgb_leds(Packet& packet, const std::array<std::uint8_t, 12>& percent) noexcept {
  std::array<std::uint8_t, 13> bytes{kRgbLeds};
  std::transform(percent.begin(), percent.end(), bytes.begin() + 1,
                 [](std::uint8_t p) { return std::min<std::uint8_t>(p, 100); });
  return packet.append(bytes);
}

bool append_query(Packet& packet, Quantity quantity, const AnswerLayout& layout) noexcept {
  if (quantity == Quantity::Microphones && layout.microphone_bytes == 8) return packet.append({kFourMicrophones});
  return packet.append({kQueries[static_cast<std::size_t>(quantity)]});
}

bool append_queries(Packet& packet, QuantitySet quantities, const AnswerLayout& layout) noexcept {
  Packet queries;
  for_each(quantities, [&](Quantity q) {
    if (answer_size(q, layout) > 0) append_query(queries, q, layout);
  });
  return packet.append(queries.bytes());
}

bool append_end(Packet& packet) noexcept {
  return packet.append({0});
}

std::size_t answer_size(Quantity quantity, const AnswerLayout& layout) noexcept {
  switch (quantity) {
    case Quantity::Proximity:
    case Quantity::Ambient:
      return 16;
    case Quantity::Acceleration:
      return 6;
    case Quantity::Microphones:
      return layout.microphone_bytes;
    case Quantity::TimeOfFlight:
      return layout.time_of_flight_bytes;
    case Quantity::Selector:
      return layout.selector_bytes;
    case Quantity::Encoders:
    case Quantity::CommandedSpeeds:
      return 4;
    case Quantity::Gyro:
      return layout.gyro_bytes;
    case Quantity::Battery:
      return layout.battery_bytes;
    case Quantity::Ground:
      return layout.ground_bytes;
  }
  return 0;
}

std::size_t answer_size(QuantitySet quantities, const AnswerLayout& layout) noexcept {
  std::size_t size = 0;
  for_each(quantities, [&](Quantity q) { size += answer_size(q, layout); });
  return size;
}

Decoded decode_answer(std::span<const std::uint8_t> bytes, QuantitySet quantities, const AnswerLayout& layout,
                      RawSensors& sensors) noexcept {
  if (bytes.size() != answer_size(quantities, layout)) return Decoded::WrongLength;
  RawSensors read = sensors;
  Reader in(bytes);
  for_each(quantities, [&](Quantity q) { read_quantity(in, q, answer_size(q, layout), read); });
  if (!within_12_bits(read.proximity) || !within_12_bits(read.ambient)) return Decoded::Implausible;
  sensors = read;
  return Decoded::Ok;
}

bool append_wifi_command(Packet& packet, const AllActuators& a) noexcept {
  constexpr std::uint8_t kTellSensors = 2;  // 1: the camera's images
  // Behind its head: flags, all off, the speeds, the lamps; no sound.
  std::array<std::uint8_t, kWifiCommandSize> bytes{kWifiCommand, kTellSensors,  0,     low(a.left), high(a.left),
                                                   low(a.right), high(a.right), a.leds};
  std::transform(a.rgb_percent.begin(), a.rgb_percent.end(), bytes.begin() + 8,
                 [](std::uint8_t p) { return std::min<std::uint8_t>(p, 100); });
  return packet.append(bytes);
}

WifiReader::Event WifiReader::push(std::uint8_t byte) noexcept {
  if (lost_) return Event::OutOfStep;
  if (skip_ > 0) {
    --skip_;
    return Event::None;
  }
  if (in_body_) {
    body_[size_++] = byte;
    if (size_ < body_.size()) return Event::None;
    in_body_ = false;
    return Event::Sensors;
  }
  switch (byte) {
    case kWifiSensors:
      in_body_ = true;
      size_ = 0;
      return Event::None;
    case kWifiImage:
      skip_ = kImage;
      return Event::None;
    case kWifiEmpty:
      return Event::Empty;
    default:
      lost_ = true;
      return Event::OutOfStep;
  }
}

Decoded decode_all_sensors(std::span<const std::uint8_t> bytes, AllSensors& sensors) noexcept {
  if (bytes.size() != kAllSensorsSize) return Decoded::WrongLength;
  AllSensors s;
  Reader in(bytes);
  in.fill(s.common.acceleration);
  s.acceleration_norm = in.f32();
  s.orientation_deg = in.f32();
  s.inclination_deg = in.f32();
  in.fill(s.common.gyro);
  for (float& v : s.magnetic_field_uT) v = in.f32();
  s.temperature_C = static_cast<std::int8_t>(in.u8());
  in.fill(s.common.proximity);
  in.fill(s.common.ambient);
  s.common.time_of_flight_mm = in.u16();
  in.fill(s.common.microphones);
  in.fill(s.common.encoders);
  s.common.battery = in.u16();
  s.sd_card = in.u8();
  for (std::uint8_t& v : s.remote_control) v = in.u8();
  s.common.selector = in.u8();
  in.fill(s.common.ground);
  in.fill(s.ground_ambient);
  s.button = in.u8();
  if (!within_12_bits(s.common.proximity) || !within_12_bits(s.common.ambient)) return Decoded::Implausible;
  sensors = s;
  return Decoded::Ok;
}

}  // namespace tandem::bridges::epuck
