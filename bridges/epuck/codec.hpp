// Binary packets of the e-puck's serial protocol, both ways. Pure functions on fixed buffers; no input is undefined.
//
// A packet is a row of commands, each a byte (256 minus the ASCII letter) with its payload, ended by 0. The robot
// answers when it has read the 0: the values of all commands back to back, in order, without header, length or
// checksum. Little-endian. Sources: gctronic/e-puck-library (BTcom.c, Asercom.c), e-puck2/e-puck2_main-processor
// (Asercom2.c).
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace tandem::bridges::epuck {

/// Wheel speed as the firmware takes it: steps a second, 1000 a turn.
struct StepsPerS {
  std::int16_t value = 0;
  friend bool operator==(const StepsPerS&, const StepsPerS&) = default;
};

/// Bytes to be sent. The robot's receive buffer has 64 bytes and overwrites itself silently when full: never more than
/// that.
class Packet {
 public:
  static constexpr std::size_t kCapacity = 64;

  /// False, and nothing appended, when the bytes do not all fit.
  bool append(std::span<const std::uint8_t> bytes) noexcept;
  bool append(std::initializer_list<std::uint8_t> bytes) noexcept {
    return append(std::span(bytes.begin(), bytes.size()));
  }
  void clear() noexcept { size_ = 0; }
  bool empty() const noexcept { return size_ == 0; }
  std::size_t size() const noexcept { return size_; }
  std::span<const std::uint8_t> bytes() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<std::uint8_t, kCapacity> bytes_{};
  std::size_t size_ = 0;
};

/// Quantities that a binary packet can ask for, in the order in which this side asks.
enum class Quantity : std::uint8_t {
  Encoders,         ///< Q: 2 x int16, steps, wrapping
  Proximity,        ///< N: 8 values 0 to 4095, larger is nearer
  Ambient,          ///< O: 8 values 0 to 4095, larger is darker
  Acceleration,     ///< a: 3 x int16
  Microphones,      ///< u: 3 values; F4, 4 values, on the e-puck2
  Gyro,             ///< g: 3 x int16; GCtronic firmware and e-puck2
  Battery,          ///< b: 1 value; GCtronic firmware and e-puck2
  Ground,           ///< M: 3 values; 5 with cliff sensors; on the e-puck2 4, the last of the right cliff sensor
  TimeOfFlight,     ///< F3: 1 value, mm; e-puck2
  Selector,         ///< F8, all sensors: nothing shorter tells it in binary; e-puck2
  CommandedSpeeds,  ///< E: 2 x int16, the last speeds set
};
inline constexpr std::size_t kQuantityCount = 11;

/// A set of quantities.
class QuantitySet {
 public:
  constexpr QuantitySet() = default;
  constexpr QuantitySet(std::initializer_list<Quantity> quantities) noexcept {
    for (const Quantity q : quantities) add(q);
  }
  constexpr void add(Quantity q) noexcept { bits_ = static_cast<std::uint16_t>(bits_ | bit(q)); }
  constexpr void add(QuantitySet other) noexcept { bits_ = static_cast<std::uint16_t>(bits_ | other.bits_); }
  constexpr void remove(Quantity q) noexcept { bits_ = static_cast<std::uint16_t>(bits_ & ~bit(q)); }
  constexpr bool has(Quantity q) const noexcept { return (bits_ & bit(q)) != 0; }
  constexpr bool empty() const noexcept { return bits_ == 0; }
  friend bool operator==(const QuantitySet&, const QuantitySet&) = default;

 private:
  static constexpr std::uint16_t bit(Quantity q) noexcept {
    return static_cast<std::uint16_t>(1U << static_cast<unsigned>(q));
  }
  std::uint16_t bits_ = 0;
};

/// Length of a robot's answer in bytes where firmwares differ. 0: it does not answer at all.
struct AnswerLayout {
  std::uint8_t ground_bytes = 6;          ///< 0, 6, 8 (e-puck2) or 10 (cliff sensors)
  std::uint8_t battery_bytes = 2;         ///< 0 (EPFL's BTcom) or 2
  std::uint8_t gyro_bytes = 6;            ///< 0 (EPFL's BTcom) or 6
  std::uint8_t microphone_bytes = 6;      ///< or 8 (e-puck2)
  std::uint8_t time_of_flight_bytes = 0;  ///< or 2 (e-puck2)
  std::uint8_t selector_bytes = 0;        ///< or 103 (e-puck2)
  friend bool operator==(const AnswerLayout&, const AnswerLayout&) = default;
};

/// Values as they came over the wire.
struct RawSensors {
  std::array<std::int16_t, 2> encoders{};
  std::array<std::uint16_t, 8> proximity{};
  std::array<std::uint16_t, 8> ambient{};
  std::array<std::int16_t, 3> acceleration{};
  std::array<std::uint16_t, 4> microphones{};  ///< right, left, rear, front
  std::array<std::int16_t, 3> gyro{};
  std::uint16_t battery = 0;
  std::array<std::uint16_t, 3> ground{};
  std::array<std::uint16_t, 2> cliff{};  ///< right, left
  std::uint8_t cliffs = 0;               ///< how many of them were told
  std::uint16_t time_of_flight_mm = 0;   ///< 0: not yet measured
  std::uint8_t selector = 0;
  std::array<std::int16_t, 2> commanded{};
  friend bool operator==(const RawSensors&, const RawSensors&) = default;
};

// --- commands; each returns false, and appends nothing, when the packet is too full ---

bool append_speeds(Packet& packet, StepsPerS left, StepsPerS right) noexcept;
enum class LedAction : std::uint8_t { Off = 0, On = 1, Toggle = 2 };
inline constexpr std::uint8_t kBodyLedIndex = 8;
inline constexpr std::uint8_t kFrontLedIndex = 9;
/// `index` 0 to 7: ring; 8 body; 9 front; anything else: all of the ring.
bool append_led(Packet& packet, std::uint8_t index, LedAction action) noexcept;
/// e-puck2: colours of its RGB LEDs, r g b each of LED 2, 4, 6, 8 (ring 1, 3, 5, 7 counted from 0), 0 to 100.
bool append_rgb_leds(Packet& packet, const std::array<std::uint8_t, 12>& percent) noexcept;
bool append_query(Packet& packet, Quantity quantity, const AnswerLayout& layout = {}) noexcept;
/// All of `quantities` that the robot answers, in the order of the enumeration.
bool append_queries(Packet& packet, QuantitySet quantities, const AnswerLayout& layout) noexcept;
bool append_end(Packet& packet) noexcept;

// --- answers ---

std::size_t answer_size(Quantity quantity, const AnswerLayout& layout) noexcept;
std::size_t answer_size(QuantitySet quantities, const AnswerLayout& layout) noexcept;
/// Of all quantities together.
inline constexpr std::size_t kLongestAnswer = 4 + 16 + 16 + 6 + 8 + 6 + 2 + 10 + 2 + 103 + 4;

enum class Decoded : std::uint8_t {
  Ok,
  WrongLength,  ///< not exactly as many bytes as the quantities take
  Implausible   ///< a proximity or ambient value beyond 12 bits: the stream is out of step
};
/// Reads the values of `quantities` into `sensors`, which is left alone unless the result is Ok.
Decoded decode_answer(std::span<const std::uint8_t> bytes, QuantitySet quantities, const AnswerLayout& layout,
                      RawSensors& sensors) noexcept;

// --- the e-puck2's packets for everything at once ---

struct AllActuators {
  std::int16_t left = 0;
  std::int16_t right = 0;
  std::uint8_t leds = 0;  ///< bits: LED 1, 3, 5, 7, body, front
  std::array<std::uint8_t, 12> rgb_percent{};
};

inline constexpr std::size_t kAllSensorsSize = 103;
struct AllSensors {
  /// Acceleration (0 without a force, whatever the firmware answers to `a`), gyro, proximity, ambient, microphones,
  /// time of flight, encoders, battery, selector, ground.
  RawSensors common;
  float acceleration_norm = 0.0F;  ///< raw counts
  float orientation_deg = 0.0F;
  float inclination_deg = 0.0F;
  std::array<float, 3> magnetic_field_uT{};
  std::int8_t temperature_C = 0;
  std::uint8_t sd_card = 0;
  std::array<std::uint8_t, 3> remote_control{};  ///< check, address, data
  std::array<std::uint16_t, 3> ground_ambient{};
  std::uint8_t button = 0;  ///< over WiFi; over a serial line always 0
};
Decoded decode_all_sensors(std::span<const std::uint8_t> bytes, AllSensors& sensors) noexcept;

// --- the same over the e-puck2's own radio: commands of 21 bytes, answers with a header of one ---

inline constexpr std::size_t kWifiCommandSize = 21;
/// Sets everything, and has the robot tell its sensors.
bool append_wifi_command(Packet& packet, const AllActuators& actuators) noexcept;

/// Cuts the radio's stream into its packets. Pure; no input is undefined.
class WifiReader {
 public:
  enum class Event : std::uint8_t {
    None,
    Sensors,   ///< `sensors()` is complete
    Empty,     ///< the robot tells nothing: nothing was asked for
    OutOfStep  ///< no packet begins so: what follows means nothing until the link is reopened
  };
  Event push(std::uint8_t byte) noexcept;
  /// As `decode_all_sensors` takes them.
  std::span<const std::uint8_t> sensors() const noexcept { return std::span(body_).first(kAllSensorsSize); }
  void clear() noexcept { *this = WifiReader{}; }

 private:
  static constexpr std::size_t kBody = kAllSensorsSize + 1;  // a spare byte at the end
  static constexpr std::size_t kImage = 160 * 120 * 2;
  std::array<std::uint8_t, kBody> body_{};
  std::size_t size_ = 0;
  std::size_t skip_ = 0;  // of an unrequested image
  bool in_body_ = false;
  bool lost_ = false;
};

}  // namespace tandem::bridges::epuck
