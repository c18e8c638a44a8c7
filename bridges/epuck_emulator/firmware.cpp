#include "bridges/epuck_emulator/firmware.hpp"

#include <algorithm>

#include "bridges/epuck_emulator/converters.hpp"
#include "bridges/epuck_emulator/raw_units.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

constexpr std::string_view kGreeting =
    "\x0C\x07WELCOME to the SerCom protocol on e-Puck\r\nthe EPFL education robot type \"H\" for help\r\n";
constexpr hal::TimeNs kMotorTickNs = 100'000;  // e-puck1: one timer of 0.1 ms turns both motors

bool ends_line(std::uint8_t byte) {
  return byte == '\r' || byte == '\n';
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

Firmware::Firmware(const Options& options, EmulatedBody& body, EventSink sink)
    : options_(options),
      facts_(facts_of(options.variant)),
      body_(body),
      sink_(std::move(sink)),
      to_motors_(options.delays.command_s + options.delays.body_s),
      to_counters_(options.delays.command_s + options.delays.counters_s),
      left_(facts_.speed_limit_steps_s, facts_.whole_ticks ? kMotorTickNs : 0),
      right_(left_),
      left_motor_(left_),
      right_motor_(left_) {}

void Firmware::event(hal::TimeNs at, std::string_view name, const EventFields& fields) const {
  if (sink_) sink_(at, name, fields);
}

void Firmware::power_on(hal::TimeNs at) {
  now_ = std::max(now_, at);
  start_errand(Errand::Boot, now_);
  run_until(now_);
}

void Firmware::receive(std::uint8_t byte, hal::TimeNs at) {
  at = std::max(at, now_);
  run_until(at);
  if (errand_ == Errand::Boot) return;  // its receiver is not switched on yet
  if (received_.size() == kReceiveBytes) {
    received_.pop_front();  // silently, says the robot; its emulator tells
    memory_.uart_error = true;
    if (!overflowing_) event(at, "overflow", {{"buffer", "receive"}, {"bytes", kReceiveBytes}});
    overflowing_ = true;
  }
  received_.push_back({byte, at});
  run_until(at);
}

void Firmware::run_until(hal::TimeNs now) {
  now_ = std::max(now_, now);
  for (;;) {
    if (errand_ != Errand::None) {
      if (errand_until_ > now_) break;
      turn_motors(errand_until_);
      finish_errand();
      continue;
    }
    if (received_.empty()) break;
    const Arrived next = received_.front();
    const hal::TimeNs start = std::max(free_at_, next.at);
    if (start > now_) break;
    received_.pop_front();
    overflowing_ = false;
    turn_motors(start);
    consume(next.byte, start);
  }
  turn_motors(now_);
}

void Firmware::take_sent(hal::TimeNs now, std::vector<SentByte>& out) {
  while (!sending_.empty() && sending_.front().at <= now) {
    out.push_back(sending_.front());
    sending_.pop_front();
  }
}

std::optional<hal::TimeNs> Firmware::next_event(hal::TimeNs patience_ns) const {
  std::optional<hal::TimeNs> next;
  const auto consider = [&next](hal::TimeNs at) { next = next ? std::min(*next, at) : at; };
  if (!sending_.empty()) {
    const hal::TimeNs first = sending_.front().at;
    consider(std::min(sending_.back().at, first + patience_ns));
  }
  if (errand_ != Errand::None)
    consider(errand_until_);
  else if (!received_.empty())
    consider(std::max(free_at_, received_.front().at));
  if (const auto at = to_motors_.next_at()) consider(*at);
  return next;
}

void Firmware::reset(hal::TimeNs at, std::string_view why) {
  at = std::max(at, now_);
  now_ = at;
  sending_.clear();
  received_.clear();
  overflowing_ = false;
  count_steps(at);
  memory_ = Memory{};
  left_.set_count(0);
  right_.set_count(0);
  event(at, "reset", {{"why", why}});
  event(at, "wheels", {{"left", 0}, {"right", 0}, {"by", "reset"}});
  stop_wheels(at);
  free_at_ = at;
  start_errand(Errand::Boot, at + options_.boot_ns);
}

void Firmware::start_errand(Errand errand, hal::TimeNs until) {
  errand_ = errand;
  errand_until_ = until;
}

void Firmware::finish_errand() {
  const Errand done = errand_;
  errand_ = Errand::None;
  switch (done) {
    case Errand::Boot:
      greet(errand_until_);
      break;
    case Errand::Calibration:
      calibrate(body_.sense(errand_until_));
      send_text("k, Calibration finished\r\n", errand_until_);
      break;
    case Errand::BusScan:
      send_text("192: 1\r\n", errand_until_);
      break;  // the ground board's address
    case Errand::None:
      break;
  }
}

void Firmware::greet(hal::TimeNs at) {
  // Switched on in the open and then set in its place: whether a shared body has sensed yet must not matter. A reset
  // calibrates where the robot stands, like the real one's.
  calibrate(greeted_ ? body_.sense(at) : BodySenses{});
  greeted_ = true;
  actuate(at);
  event(at, "greeting", {});
  send_text(kGreeting, at);
}

// One byte of the command loop. After the first byte of an ASCII line the robot skips line ends for as long as they
// come, whatever follows, and then collects to the next line end: so a CR LF eats the head of a binary packet.
void Firmware::consume(std::uint8_t byte, hal::TimeNs at) {
  switch (memory_.mode) {
    case Mode::Idle:
      if (byte == 0) return;
      if (byte >= 0x80) {
        memory_.answer.clear();
        memory_.mode = Mode::BinaryCommand;
        take_command(byte, at);
        return;
      }
      memory_.line.clear();
      memory_.mode = Mode::SkipToLine;
      [[fallthrough]];
    case Mode::SkipToLine:
      if (ends_line(byte)) return;
      memory_.mode = Mode::Line;
      [[fallthrough]];
    case Mode::Line:
      if (ends_line(byte)) {
        memory_.mode = Mode::Idle;
        obey_line(at);
        return;
      }
      // The robot would write beyond its buffer; here the rest is lost.
      if (memory_.line.size() < facts_.buffer_bytes + kMarginBytes)
        memory_.line += static_cast<char>(byte);
      else
        event(at, "overflow", {{"buffer", "line"}, {"bytes", memory_.line.size()}});
      return;
    case Mode::BinaryCommand:
      take_command(byte, at);
      return;
    case Mode::BinaryPayload:
      memory_.payload.push_back(byte);
      if (memory_.payload.size() < memory_.payload_bytes) return;
      memory_.mode = Mode::BinaryCommand;
      obey_binary(at);
      return;
  }
}

void Firmware::send(std::span<const std::uint8_t> bytes, hal::TimeNs at) {
  if (cut_next_answer_ && bytes.size() > 1) {
    bytes = bytes.first(bytes.size() / 2);
    cut_next_answer_ = false;
  }
  free_at_ = std::max(free_at_, at);
  for (const std::uint8_t byte : bytes) {
    free_at_ += kByteNs;
    sending_.push_back({byte, free_at_});
  }
}

void Firmware::send_text(std::string_view text, hal::TimeNs at) {
  send(bytes_of(text), at);
}

void Firmware::count_steps(hal::TimeNs at) {
  to_counters_.take(at, [this](hal::TimeNs from, const Speeds& speeds) {
    left_.set_speed(speeds.left, from);
    right_.set_speed(speeds.right, from);
  });
  left_.advance(at);
  right_.advance(at);
}

// `left` and `right` as they came; the motors take 16 bits of them.
void Firmware::set_speeds(std::int32_t left, std::int32_t right, std::string_view by, hal::TimeNs at) {
  event(at, "wheels", {{"left", left}, {"right", right}, {"by", by}});
  if (!first_driven_at_ && (left != 0 || right != 0)) first_driven_at_ = at;
  turn_wheels(left, right, at);
}

void Firmware::turn_wheels(std::int32_t left, std::int32_t right, hal::TimeNs at) {
  const Speeds speeds{static_cast<std::int16_t>(left), static_cast<std::int16_t>(right)};
  to_motors_.put(at, speeds);
  to_counters_.put(at, speeds);
  turn_motors(at);
}

/// At once: there is no power.
void Firmware::stop_wheels(hal::TimeNs at) {
  to_motors_.clear();
  to_counters_.clear();
  for (Stepper* stepper : {&left_, &right_, &left_motor_, &right_motor_}) stepper->set_speed(0, at);
  actuate(at);
}

/// What was told reaches the motors in its time.
void Firmware::turn_motors(hal::TimeNs now) {
  to_motors_.take(now, [this](hal::TimeNs at, const Speeds& speeds) {
    left_motor_.set_speed(speeds.left, at);
    right_motor_.set_speed(speeds.right, at);
    actuate(at);
  });
}

void Firmware::actuate(hal::TimeNs at) {
  BodyCommand command = memory_.lights;
  command.left_m_s = left_motor_.real_steps_s() * step_m();
  command.right_m_s = right_motor_.real_steps_s() * step_m();
  command.told_left_m_s = left_motor_.told_steps_s() * step_m();
  command.told_right_m_s = right_motor_.told_steps_s() * step_m();
  body_.actuate(at, command);
}

// 0 off, 1 on, anything else toggles. Ring LEDs 0 to 7; in binary also 8, the body, and 9, the front; others mean the
// ring.
void Firmware::set_led(bool any_device, std::int32_t index, std::int32_t action, hal::TimeNs at) {
  const auto change = [action](bool lit) { return action == 0 ? false : action == 1 ? true : !lit; };
  BodyCommand lights = memory_.lights;
  const auto change_ring = [&](std::int32_t i) {
    const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(i));
    lights.ring = static_cast<std::uint8_t>(change((lights.ring & bit) != 0) ? lights.ring | bit : lights.ring & ~bit);
  };
  if (index >= 0 && index < 8) {
    change_ring(index);
  } else if (any_device && index == 8) {
    lights.body_led = change(lights.body_led);
  } else if (any_device && index == 9) {
    lights.front_led = change(lights.front_led);
  } else {
    for (std::int32_t i = 0; i < 8; ++i) change_ring(i);
  }
  show_lights(lights, at);
}

void Firmware::show_lights(const BodyCommand& lights, hal::TimeNs at) {
  if (lights == memory_.lights) return;
  memory_.lights = lights;
  EventFields fields{{"ring", lights.ring}, {"body", lights.body_led}, {"front", lights.front_led}};
  if (options_.variant == Variant::Epuck2) {
    std::string rgb;
    for (const std::uint8_t level : lights.rgb) rgb += (rgb.empty() ? "" : ",") + std::to_string(level);
    fields.emplace_back("rgb", rgb);
  }
  event(at, "leds", fields);
  actuate(at);
}

void Firmware::play(std::int32_t sound, hal::TimeNs at) {
  event(at, "sound", {{"number", sound >= 1 && sound <= 5 ? sound : 0}});
}

// The chip is mounted so that its first axis points left, its second forward, its third up.
std::array<int, 3> Firmware::acceleration(const BodySenses& senses, int zero) const {
  const std::array<double, 3>& force = senses.force_m_s2;
  std::array<int, 3> raw = {acceleration_counts(force[1]), acceleration_counts(force[0]),
                            acceleration_counts(force[2])};
  for (int& value : raw) {
    value += zero;
    if (zero != 0) value = std::clamp(value, 0, kTwelveBits);  // the converter's own, without sign
  }
  return raw;
}

// The e-puck2's chip is told as it is mounted: its axes point right, forward, up. The older robots' is not there.
std::array<int, 3> Firmware::gyro(const BodySenses& senses) const {
  if (options_.variant != Variant::Epuck2) return {};
  const std::array<double, 3>& turn = senses.turn_rad_s;
  return {gyro_counts(-turn[1]), gyro_counts(turn[0]), gyro_counts(turn[2])};
}

// The board counts from left to right; the body as the kind does.
std::array<double, 3> Firmware::ground(const BodySenses& senses) const {
  if (!options_.ground_board) return {};
  return {senses.ground[2], senses.ground[1], senses.ground[0]};
}

std::array<int, 8> Firmware::proximity(const BodySenses& senses, bool calibrated) const {
  std::array<int, 8> raw{};
  for (std::size_t i = 0; i < raw.size(); ++i) {
    raw[i] = proximity_counts(senses.distance_m[i]) + kInfraredOffsetRaw;
    if (calibrated) raw[i] = std::max(0, raw[i] - memory_.infrared_offset[i]);
    raw[i] = std::min(raw[i], kTwelveBits);
  }
  return raw;
}

int Firmware::battery_raw(const BodySenses& senses) const {
  if (options_.variant == Variant::Epuck2) return battery_counts_epuck2(senses.battery_V);
  return battery_counts(senses.battery_V);
}

std::size_t Firmware::image_bytes() const {
  const std::int64_t pixels = std::int64_t{memory_.camera_width} * memory_.camera_height;
  return static_cast<std::size_t>(pixels * (memory_.camera_mode == static_cast<std::int32_t>(Camera::Grey) ? 1 : 2));
}

}  // namespace tandem::bridges::epuck_emulator
