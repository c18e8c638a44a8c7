// The commands that people type: a letter, arguments, a line end.
#include <algorithm>

#include "bridges/epuck_emulator/converters.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
#include "bridges/epuck_emulator/raw_units.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

constexpr hal::TimeNs kBusScanNs = hal::kNsPerSecond;

constexpr std::string_view kHelp =
    "\n\"A\"         Accelerometer\r\n\"B,#\"       Body led 0=off 1=on 2=inverse\r\n"
    "\"C\"         Selector position\r\n\"D,#,#\"     Set motor speed left,right\r\n"
    "\"E\"         Get motor speed left,right\r\n\"F,#\"       Front led 0=off 1=on 2=inverse\r\n"
    "\"H\"         Help\r\n\"I\"         Get camera parameter\r\n"
    "\"J,#,#,#,#\" Set camera parameter mode,width,height,zoom(1,4 or 8)\r\n\"K\"         Calibrate proximity "
    "sensors\r\n"
    "\"L,#,#\"     Led number,0=off 1=on 2=inverse\r\n\"N\"         Proximity\r\n\"O\"         Light sensors\r\n"
    "\"P,#,#\"     Set motor position left,right\r\n\"Q\"         Get motor position left,right\r\n"
    "\"R\"         Reset e-puck\r\n\"S\"         Stop e-puck and turn off leds\r\n"
    "\"T,#\"       Play sound 1-5 else stop sound\r\n\"U\"         Get microphone amplitude\r\n"
    "\"V\"         Version of SerCom\r\n";

template <class Values>
std::string answer_of(char letter, const Values& values) {
  std::string text(1, letter);
  for (const auto value : values) text += "," + std::to_string(value);
  return text + "\r\n";
}

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

}  // namespace

// As C's scanf does with ",%d,%d": stops at the first argument that is not there, and leaves its variable and the rest
// as they were. Numbers too large for the processor's int wrap.
void Firmware::scan(std::string_view text, std::initializer_list<std::int32_t*> variables) const {
  for (std::int32_t* variable : variables) {
    if (text.empty() || text.front() != ',') return;
    text.remove_prefix(1);
    while (!text.empty() && (text.front() == ' ' || (text.front() >= '\t' && text.front() <= '\r')))
      text.remove_prefix(1);
    const bool negative = !text.empty() && text.front() == '-';
    if (negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
    if (text.empty() || text.front() < '0' || text.front() > '9') return;
    std::uint32_t magnitude = 0;
    for (; !text.empty() && text.front() >= '0' && text.front() <= '9'; text.remove_prefix(1)) {
      magnitude = magnitude * 10 + static_cast<std::uint32_t>(text.front() - '0');
    }
    const std::uint32_t bits = negative ? 0U - magnitude : magnitude;
    *variable = facts_.wide_int ? static_cast<std::int32_t>(bits) : static_cast<std::int16_t>(bits);
  }
}

// t has no place of its own: in upper case it is T, the sound.
void Firmware::obey_line(hal::TimeNs at) {
  const char typed = memory_.line.front();
  const char letter = facts_.small_b_g && (typed == 'b' || typed == 'g') ? typed : upper(typed);
  event(at, "command", {{"mode", "ascii"}, {"command", std::string(1, letter)}, {"text", memory_.line}});
  obey_letter(letter, std::string_view(memory_.line).substr(1), at);
}

void Firmware::obey_letter(char letter, std::string_view arguments, hal::TimeNs at) {
  count_steps(at);
  if (obey_question(letter, at) || obey_order(letter, arguments, at) || obey_optional(letter, arguments, at)) return;
  event(at, "unknown", {{"mode", "ascii"}, {"text", memory_.line}});
  send_text("z,Command not found\r\n", at);
}

// What every firmware answers with values. False: not one of them.
bool Firmware::obey_question(char letter, hal::TimeNs at) {
  const Memory& m = memory_;
  const BodySenses senses = body_.sense(at);
  switch (letter) {
    case 'A':
      send_text(answer_of('a', acceleration(senses, facts_.acceleration_zero_ascii)), at);
      return true;
    case 'C':
      send_text(answer_of('c', std::array{int{options_.selector}}), at);
      return true;
    case 'E':
      send_text(answer_of('e', std::array{m.speed_left, m.speed_right}), at);
      return true;
    case 'H':
      send_text(kHelp, at);
      return true;
    case 'I': {
      const auto size = static_cast<std::int32_t>(image_bytes());
      send_text(answer_of('i', std::array{m.camera_mode, m.camera_width, m.camera_height, m.camera_zoom, size}), at);
      return true;
    }
    case 'M': {
      std::vector<int> ground;
      for (const double g : this->ground(senses)) ground.push_back(ground_counts(g));
      if (options_.cliff_sensors && facts_.small_b_g) {
        for (const double g : senses.cliff) ground.push_back(ground_counts(g));
      }
      send_text(answer_of('m', ground), at);
      return true;
    }
    case 'N':
      send_text(answer_of('n', proximity(senses, true)), at);
      return true;
    case 'O': {
      std::array<int, 8> light{};
      std::transform(senses.light.begin(), senses.light.end(), light.begin(), ambient_counts);
      send_text(answer_of('o', light), at);
      return true;
    }
    case 'Q': {
      const auto shown = [this](std::int32_t n) { return facts_.wide_int ? n : static_cast<std::int16_t>(n); };
      send_text(answer_of('q', std::array{shown(left_.count()), shown(right_.count())}), at);
      return true;
    }
    case 'U': {
      std::array<int, 3> levels{};
      for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = microphone_counts(senses.sound[i]);
      send_text(answer_of('u', levels), at);
      return true;
    }
    case 'V': {
      std::string text = "v," + std::string(facts_.version) + "\r\n";
      if (!facts_.hardware.empty()) text += std::string(facts_.hardware) + "\r\n";
      send_text(text, at);
      return true;
    }
    default:
      return false;
  }
}

// What every firmware does and acknowledges. False: not one of them.
bool Firmware::obey_order(char letter, std::string_view arguments, hal::TimeNs at) {
  Memory& m = memory_;
  switch (letter) {
    case 'B':
      scan(arguments, {&m.led_action});
      set_led(true, 8, m.led_action, at);
      send_text("b\r\n", at);
      return true;
    case 'D':
      scan(arguments, {&m.speed_left, &m.speed_right});
      set_speeds(m.speed_left, m.speed_right, "D", at);
      send_text("d\r\n", at);
      return true;
    case 'F':
      scan(arguments, {&m.led_action});
      set_led(true, 9, m.led_action, at);
      send_text("f\r\n", at);
      return true;
    case 'J':
      set_camera(arguments);
      send_text("j\r\n", at);
      return true;
    case 'K':
      send_text("k, Starting calibration - Remove any object in sensors range\r\n", at);
      start_errand(Errand::Calibration, free_at_ + options_.calibration_ns);
      return true;
    case 'L':
      scan(arguments, {&m.led_index, &m.led_action});
      set_led(false, m.led_index, m.led_action, at);
      send_text("l\r\n", at);
      return true;
    case 'P':
      scan(arguments, {&m.count_left, &m.count_right});
      left_.set_count(m.count_left);
      right_.set_count(m.count_right);
      send_text("p\r\n", at);
      return true;
    case 'R': {
      if (options_.variant == Variant::Epuck2) return true;  // neither answer nor effect
      std::deque<SentByte> last_bytes;
      send_text("r\r\n", at);
      last_bytes.swap(sending_);
      const hal::TimeNs leaves = free_at_;
      reset(at, "command R");
      sending_.swap(last_bytes);
      start_errand(Errand::Boot, leaves + options_.boot_ns);
      return true;
    }
    case 'S': {
      event(at, "stop", {});
      if (facts_.stop_clears_all) m.speed_left = m.speed_right = 0;
      set_speeds(0, 0, "S", at);
      BodyCommand lights = m.lights;
      lights.ring = 0;
      if (facts_.stop_clears_all) lights.body_led = lights.front_led = false;
      show_lights(lights, at);
      send_text("s\r\n", at);
      return true;
    }
    case 'T':
      scan(arguments, {&m.sound});
      play(m.sound, at);
      send_text("t\r\n", at);
      return true;
    default:
      return false;
  }
}

// What only some have.
bool Firmware::obey_optional(char letter, std::string_view arguments, hal::TimeNs at) {
  Memory& m = memory_;
  const auto bus_key = [&m] {
    return static_cast<std::uint16_t>(((m.bus_module & 0xFF) << 8) | (m.bus_register & 0xFF));
  };
  if (letter == 'b' && facts_.small_b_g) {
    const double battery_V = body_.sense(at).battery_V;
    const int raw = battery_raw(body_.sense(at));
    const bool measured = options_.variant == Variant::Epuck2 || options_.hardware_1_3;
    if (measured) {
      send_text("b," + std::to_string(raw) + " (" + std::to_string(battery_percent(battery_V)) + "%)\r\n", at);
    } else {
      send_text(battery_V < kCellEmpty_V ? "b,0\r\n" : "b,1\r\n", at);
    }
    return true;
  }
  if (letter == 'g' && facts_.small_b_g) {
    send_text(answer_of('g', gyro(body_.sense(at))), at);
    return true;
  }
  if (letter == 'G' && facts_.small_b_g) {
    send_text("g IR check : 0x0, address : 0x0, data : 0x0\r\n", at);
    return true;
  }
  if (letter == 'W' && facts_.i2c) {
    scan(arguments, {&m.bus_module, &m.bus_register, &m.bus_value});
    bus_[bus_key()] = static_cast<std::uint8_t>(m.bus_value);
    send_text("w\r\n", at);
    return true;
  }
  if (letter == 'Y' && facts_.i2c) {
    scan(arguments, {&m.bus_module, &m.bus_register});
    const int value = bus_.contains(bus_key()) ? bus_[bus_key()] : 0;
    send_text(answer_of('y', std::array{m.bus_module, m.bus_register}) + answer_of('y', std::array{value}), at);
    return true;
  }
  if (letter == 'Z' && facts_.i2c) {
    start_errand(Errand::BusScan, std::max(at, free_at_) + kBusScanNs);
    return true;
  }
  if (letter == 'X' && facts_.link_test) {
    scan(arguments, {&m.ones});
    send_text("x," + std::string(static_cast<std::size_t>(std::max(0, m.ones)), '1') + "\r\n", at);
    return true;
  }
  return false;
}

// An image that does not fit the buffer silently becomes the smallest setting.
void Firmware::set_camera(std::string_view arguments) {
  Memory& m = memory_;
  m.camera_x = m.camera_y = -1;  // centred
  scan(arguments, {&m.camera_mode, &m.camera_width, &m.camera_height, &m.camera_zoom, &m.camera_x, &m.camera_y});
  const bool sensible = m.camera_width > 0 && m.camera_height > 0;
  if (sensible && image_bytes() <= facts_.buffer_bytes) return;
  m.camera_mode = static_cast<std::int32_t>(Camera::Rgb565);
  m.camera_width = m.camera_height = 40;
}

}  // namespace tandem::bridges::epuck_emulator
