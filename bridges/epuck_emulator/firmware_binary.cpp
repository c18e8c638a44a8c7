// The commands that programs send: negated letters, raw numbers, a zero at the end.
#include <algorithm>
#include <bit>

#include "bridges/epuck_emulator/converters.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
#include "bridges/epuck_emulator/raw_units.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

std::string hex_of(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kHex[byte >> 4U];
    text += kHex[byte & 15U];
  }
  return text;
}

std::string name_of(int command) {
  if (command >= 'A' && command <= 'z') return std::string(1, static_cast<char>(command));
  const std::array<std::uint8_t, 1> byte{static_cast<std::uint8_t>(256 - command)};
  return "0x" + hex_of(byte);
}

}  // namespace

// A byte where a command is expected. The packet ends with 0, and only then all answers leave together.
void Firmware::take_command(std::uint8_t byte, hal::TimeNs at) {
  if (byte == 0) {
    memory_.mode = Mode::Idle;
    send(memory_.answer, at);
    memory_.answer.clear();
    return;
  }
  const int command = 256 - byte;
  const std::optional<std::size_t> payload = byte < 0x80 ? std::nullopt : payload_of(command);
  if (!payload) {
    event(at, "unknown", {{"mode", "binary"}, {"byte", byte}});
    return;
  }
  memory_.command = command;
  memory_.payload.clear();
  memory_.payload_bytes = *payload;
  if (*payload > 0)
    memory_.mode = Mode::BinaryPayload;
  else
    obey_binary(at);
}

/// Bytes that follow the command; nothing when this firmware does not know it.
std::optional<std::size_t> Firmware::payload_of(int command) const {
  const bool is_epuck2 = options_.variant == Variant::Epuck2;
  switch (command) {
    case 'a':
    case 'A':
    case 'E':
    case 'I':
    case 'M':
    case 'N':
    case 'O':
    case 'Q':
    case 'u':
    case 'U':
      return 0;
    case 'D':
    case 'P':
      return 4;
    case 'L':
      return 2;
    case 'b':
    case 'g':
    case 't':
      if (facts_.small_b_g) return 0;
      break;
    case 'W':
      if (facts_.i2c) return 3;
      break;
    case 'w':
      if (facts_.i2c) return 35;
      break;
    case 'Y':
      if (is_epuck2) return 2;
      break;
    default:
      break;
  }
  return is_epuck2 ? epuck2_payload_of(command) : std::nullopt;
}

void Firmware::obey_binary(hal::TimeNs at) {
  event(at, "command",
        {{"mode", "binary"}, {"command", name_of(memory_.command)}, {"payload", hex_of(memory_.payload)}});
  count_steps(at);
  if (memory_.command < 'A')
    obey_epuck2(at);
  else
    obey_binary_letter(static_cast<char>(memory_.command), at);
}

void Firmware::obey_binary_letter(char letter, hal::TimeNs at) {
  Memory& m = memory_;
  const BodySenses senses = body_.sense(at);
  switch (letter) {
    case 'a':
      for (const int value : acceleration(senses, facts_.acceleration_zero)) put16(value);
      break;
    case 'A': {
      const Tilt tilt = tilt_of(acceleration(senses, 0));
      put_float(tilt.acceleration_raw);
      put_float(tilt.orientation_deg);
      put_float(tilt.inclination_deg);
      break;
    }
    case 'b':
      if (options_.variant == Variant::Epuck2 || options_.hardware_1_3)
        put16(battery_raw(senses));
      else
        put16(senses.battery_V < kCellEmpty_V ? 0 : 1);
      break;
    case 'D':
      // A 32-bit int keeps the 16 bits unsigned: E then prints 65036 for -500, while the motors take them right.
      m.speed_left = payload16(0);
      m.speed_right = payload16(2);
      set_speeds(static_cast<std::int16_t>(m.speed_left), static_cast<std::int16_t>(m.speed_right), "D", at);
      break;
    case 'E':
      put16(m.speed_left);
      put16(m.speed_right);
      break;
    case 'g':
      for (const int value : gyro(senses)) put16(value);
      break;
    case 'I':
      put_image();
      break;
    case 'L':
      set_led(true, m.payload[0], m.payload[1], at);
      break;
    case 'M':
      put_ground(senses);
      break;
    case 'N':
      for (const int value : proximity(senses, facts_.calibrated_binary)) put16(value);
      break;
    case 'O':
      for (const double level : senses.light) put16(ambient_counts(level));
      break;
    case 'P':
      left_.set_count(payload16(0));
      right_.set_count(payload16(2));
      break;
    case 'Q':
      put16(left_.count());
      put16(right_.count());
      break;
    case 't':  // the e-puck2 asks its thermometer the wrong way round
      put8(options_.variant == Variant::Epuck2 ? 0 : std::clamp(static_cast<int>(senses.temperature_C), -128, 127));
      break;
    case 'u':
      for (std::size_t i = 0; i < 3; ++i) put16(microphone_counts(senses.sound[i]));
      break;
    case 'U':
      if (options_.variant != Variant::Epuck2) put_sound_samples(senses, at);
      break;
    case 'W':
      bus_[static_cast<std::uint16_t>(m.payload[0] * 256 + m.payload[1])] = m.payload[2];
      break;
    case 'Y': {
      const auto known = bus_.find(static_cast<std::uint16_t>(m.payload[0] * 256 + m.payload[1]));
      put8(known == bus_.end() ? 0 : known->second);
      break;
    }
    default:
      break;  // w, the RGB panel: taken, and nothing to see
  }
}

/// Little-endian, with or without sign as this processor's int has it.
std::int32_t Firmware::payload16(std::size_t at) const {
  const auto bits = static_cast<std::uint16_t>(memory_.payload[at] | (memory_.payload[at + 1] << 8));
  return facts_.wide_int ? static_cast<std::int32_t>(bits) : static_cast<std::int16_t>(bits);
}

// An endless packet would run over the robot's buffer; here what does not fit is lost.
void Firmware::put8(std::int64_t value) {
  if (memory_.answer.size() < facts_.buffer_bytes + kMarginBytes) {
    memory_.answer.push_back(static_cast<std::uint8_t>(value & 0xFF));
  }
}

void Firmware::put16(std::int64_t value) {
  put8(value);
  put8(value >> 8);
}

void Firmware::put_float(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  put16(bits & 0xFFFFU);
  put16(bits >> 16U);
}

// The e-puck2 tells the right cliff sensor behind the ground's three, and never the left one: 8 bytes.
void Firmware::put_ground(const BodySenses& senses) {
  for (const double g : ground(senses)) put16(ground_counts(g));
  if (options_.variant == Variant::Epuck2) {
    put16(options_.cliff_sensors ? ground_counts(senses.cliff[0]) : 0);
  } else if (options_.cliff_sensors && options_.variant == Variant::Gctronic) {
    for (const double g : senses.cliff) put16(ground_counts(g));
  }
}

// A test pattern: brighter to the right, and moving, so that a host sees new frames. RGB565 has its high byte first.
void Firmware::put_image() {
  const Memory& m = memory_;
  put8(m.camera_mode);
  put8(m.camera_width);
  put8(m.camera_height);
  for (std::int32_t y = 0; y < m.camera_height; ++y) {
    for (std::int32_t x = 0; x < m.camera_width; ++x) {
      const auto across = (static_cast<std::uint32_t>(x * 256 / m.camera_width) + 8 * m.frames) & 0xFFU;
      const auto down = static_cast<std::uint32_t>(y * 256 / m.camera_height) & 0xFFU;
      if (m.camera_mode == static_cast<std::int32_t>(Camera::Grey)) {
        put8(across);
      } else if (m.camera_mode == static_cast<std::int32_t>(Camera::Yuv)) {
        put8(across);
        put8(0x80);
      } else {
        const std::uint32_t pixel = ((across >> 3U) << 11U) | ((down >> 2U) << 5U) | 0x10U;
        put8(pixel >> 8U);
        put8(pixel);
      }
    }
  }
  ++memory_.frames;
}

// 100 samples of each of three microphones leave at once, before all other answers of the packet; the number of the
// last scan waits with the rest.
void Firmware::put_sound_samples(const BodySenses& senses, hal::TimeNs at) {
  std::vector<std::uint8_t> samples;
  for (std::size_t microphone = 0; microphone < 3; ++microphone) {
    const int swing = microphone_counts(senses.sound[microphone]) / 2;
    for (int k = 0; k < 100; ++k) {
      const int value = 2048 + (k % 2 == 0 ? swing : -swing);
      samples.push_back(static_cast<std::uint8_t>(value & 0xFF));
      samples.push_back(static_cast<std::uint8_t>((value >> 8) & 0xFF));
    }
  }
  send(samples, at);
  put8(99);
}

}  // namespace tandem::bridges::epuck_emulator
