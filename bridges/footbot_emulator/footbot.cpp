#include "bridges/footbot_emulator/footbot.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bridges/footbot_emulator/raw_units.hpp"
#include "hal/device/distance_scanner.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr hal::TimeNs kLoopNs = 10 * hal::kNsPerMs;  // modules look at their devices at least so often
constexpr int kTimerEvery = 2;                       // loops: the modules' event "timer" has 50 Hz
constexpr auto kPulsePeriodNs = static_cast<std::int64_t>(kPulsePeriod_s * 1e9);
constexpr std::size_t kBeacon = 12;       // behind the ring
constexpr std::uint16_t kHeardEvent = 0;  // number of the radio's user event

template <std::size_t n, class Convert>
void fill(std::span<std::int16_t> words, const std::array<double, n>& values, Convert convert) {
  for (std::size_t i = 0; i < std::min(n, words.size()); ++i) words[i] = convert(values[i]);
}

std::array<std::uint8_t, kRadioBytes> bytes_of(std::span<const std::int16_t> words) {
  std::array<std::uint8_t, kRadioBytes> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto word = static_cast<std::uint16_t>(words[i / 2]);
    bytes[i] = static_cast<std::uint8_t>(i % 2 == 0 ? word : word >> 8U);
  }
  return bytes;
}

std::vector<std::int64_t> numbers(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

}  // namespace

void Footbot::Encoder::turn(std::int16_t speed_raw, hal::TimeNs duration_ns) {
  pulse_ns += std::clamp<std::int64_t>(speed_raw, -kMostSpeedRaw, kMostSpeedRaw) * duration_ns;
}

std::uint32_t Footbot::Encoder::count() const {
  // Towards minus infinity, so that a pulse is as long around 0 as elsewhere.
  const std::int64_t down = pulse_ns / kPulsePeriodNs - (pulse_ns % kPulsePeriodNs < 0 ? 1 : 0);
  return static_cast<std::uint32_t>(down);
}

Footbot::Footbot(const Options& options, EmulatedBody& body, EventSink sink)
    : options_(options),
      body_(body),
      sink_(sink ? std::move(sink) : [](hal::TimeNs, std::string_view, const EventFields&) {}),
      modules_(make_modules(options.protocol)),
      bus_(kModules),
      to_motors_(options.delays.command_s + options.delays.body_s),
      to_counters_(options.delays.command_s + options.delays.counters_s) {}

void Footbot::power_on(hal::TimeNs at) {
  now_ = next_loop_ = encoders_at_ = at;
  for (std::size_t i = 0; i < kModules; ++i) {
    conducts_[i].ready_at = at;
    sink_(at, "boot", {{"module", modules_[i].name()}, {"id", modules_[i].id()}});
  }
  body_.actuate(at, command_);
}

void Footbot::lose_power(Place place, hal::TimeNs at, std::string_view why) {
  run_until(at);
  module(place).restart();
  bus_.clear(static_cast<std::size_t>(place));
  conduct(place).told = false;
  if (place == Place::LeftMotor || place == Place::RightMotor) {
    encoders_[place == Place::LeftMotor ? 0 : 1] = {};
    note_wheels(at, why);
    // At once: there is no power.
    to_motors_.clear();
    to_counters_.clear();
    told_speeds_ = motors_ = counted_ = {word(Place::LeftMotor, "speed"), word(Place::RightMotor, "speed")};
  }
  variables_to_actuators(at);
}

void Footbot::restart(Place place, hal::TimeNs at, std::string_view why) {
  lose_power(place, at, why);
  conduct(place).ready_at = at + options_.boot_ns;
}

void Footbot::set_missing(Place place, bool missing, hal::TimeNs at) {
  lose_power(place, at, missing ? "missing" : "back");
  conduct(place).missing = missing;
  conduct(place).ready_at = at;
}

void Footbot::receive(const Frame& frame, hal::TimeNs at) {
  run_until(at);
  bus_.occupied_until(at);
  sink_(at, "frame", {{"way", "in"}, {"frame", to_text(frame)}});
  if (const auto message = assembler_.push(frame)) hear(*message, at);
}

void Footbot::hear(const Message& message, hal::TimeNs at) {
  turn_encoders(at);
  sensors_to_variables(at);
  for (std::size_t i = 0; i < kModules; ++i) {
    if (!works(i, at) || conducts_[i].deaf) continue;
    std::vector<Message> answers;
    modules_[i].obey(message, at, answers, sink_);
    if (conducts_[i].silent) continue;
    for (const Message& answer : answers) bus_.send(i, to_frames(answer), at + options_.answer_ns);
  }
  for (const Place motor : {Place::LeftMotor, Place::RightMotor}) {
    const bool told = message.type == type::kSetVariables && message.word(0) == module(motor).id() &&
                      works(static_cast<std::size_t>(motor), at) && !conduct(motor).deaf &&
                      module(motor).written("speed");
    if (!told) continue;
    wheels_commanded_at_ = at;
    note_wheels(at, "host");
  }
  variables_to_actuators(at);
  for (std::size_t i = 0; i < kModules && message.type == type::kReboot; ++i) {
    if (message.word(0) == modules_[i].id() && works(i, at) && !conducts_[i].deaf) restart(Place{i}, at, "reboot");
  }
}

void Footbot::run_until(hal::TimeNs now) {
  for (; next_loop_ <= now; next_loop_ += kLoopNs) loop(next_loop_);
  turn_motors(now);
  pass_frames(now);
  now_ = std::max(now_, now);
}

void Footbot::loop(hal::TimeNs at) {
  turn_motors(at);
  pass_frames(at);
  turn_encoders(at);
  for (std::size_t i = 0; i < kModules; ++i) {
    if (conducts_[i].told || !works(i, at)) continue;
    conducts_[i].told = true;
    sink_(at, "boot", {{"module", modules_[i].name()}, {"id", modules_[i].id()}});
  }
  if (++loops_ % kTimerEvery == 0) run_timers(at);
  variables_to_actuators(at);
  note_heard(at);
}

/// The modules' own programs, where there are any.
void Footbot::run_timers(hal::TimeNs at) {
  const auto speeds = [this] { return std::pair(word(Place::LeftMotor, "speed"), word(Place::RightMotor, "speed")); };
  const auto before = speeds();
  for (std::size_t i = 0; i < kModules; ++i) {
    if (!works(i, at)) continue;
    std::vector<Message> said;
    modules_[i].happen("timer", at, said, sink_);
    if (conducts_[i].silent) continue;
    for (const Message& message : said) bus_.send(i, to_frames(message), at);
  }
  if (speeds() != before) note_wheels(at, "program");
}

void Footbot::pass_frames(hal::TimeNs now) {
  while (const auto passed = bus_.next(now)) {
    sink_(passed->frame.at, "frame", {{"way", "out"}, {"frame", to_text(passed->frame.frame)}});
    sent_.push_back(passed->frame);
  }
}

void Footbot::take_sent(std::vector<TimedFrame>& out) {
  out.insert(out.end(), sent_.begin(), sent_.end());
  sent_.clear();
}

hal::TimeNs Footbot::next_event() const {
  return std::min({next_loop_, bus_.next_at().value_or(next_loop_), to_motors_.next_at().value_or(next_loop_)});
}

/// What the radio heard is told to everyone on the bus.
void Footbot::note_heard(hal::TimeNs at) {
  constexpr auto kRadio = static_cast<std::size_t>(Place::RangeAndBearing);
  for (const Heard& heard : body_.take_heard()) {
    if (!works(kRadio, at) || conducts_[kRadio].silent) continue;
    Message event{modules_[kRadio].id(), kHeardEvent, {}};
    event.add(static_cast<std::uint16_t>(std::clamp(std::lround(1000.0 * heard.range_m), 0L, 32767L)));
    event.add(static_cast<std::uint16_t>(angle_raw(heard.bearing_rad)));
    event.add(static_cast<std::uint16_t>(angle_raw(heard.elevation_rad)));
    event.payload.insert(event.payload.end(), heard.payload.begin(), heard.payload.end());
    bus_.send(kRadio, to_frames(event), at);
  }
}

void Footbot::turn_encoders(hal::TimeNs at) {
  to_counters_.take(at, [this](hal::TimeNs from, const Speeds& speeds) {
    count_pulses(from);
    counted_ = speeds;
  });
  count_pulses(at);
  for (const Place motor : {Place::LeftMotor, Place::RightMotor}) {
    const Encoder& encoder = encoders_[motor == Place::LeftMotor ? 0 : 1];
    const auto odo = module(motor).words("odo");
    odo[0] = static_cast<std::int16_t>(encoder.count());
    odo[1] = static_cast<std::int16_t>(encoder.count() >> 16U);
  }
}

void Footbot::count_pulses(hal::TimeNs until) {
  const hal::TimeNs duration_ns = until - encoders_at_;
  if (duration_ns <= 0) return;
  encoders_at_ = until;
  for (std::size_t i = 0; i < encoders_.size(); ++i) encoders_[i].turn(counted_[i], duration_ns);
}

/// What the modules have been told reaches motors and encoders in its time.
void Footbot::put_speeds(hal::TimeNs at) {
  const Speeds speeds{word(Place::LeftMotor, "speed"), word(Place::RightMotor, "speed")};
  if (speeds == told_speeds_) return;
  told_speeds_ = speeds;
  to_motors_.put(at, speeds);
  to_counters_.put(at, speeds);
}

void Footbot::turn_motors(hal::TimeNs now) {
  to_motors_.take(now, [this](hal::TimeNs at, const Speeds& speeds) {
    motors_ = speeds;
    actuate(at);
  });
}

void Footbot::sensors_to_variables(hal::TimeNs at) {
  const BodySenses s = body_.sense(at);
  fill(module(Place::Proximity).words("bumpers"), s.distance_m, proximity_raw);
  fill(module(Place::Proximity).words("light"), s.light, level_raw);
  const auto ground = module(Place::Proximity).words("ground");
  fill(ground.first(8), s.base_ground, level_raw);
  fill(ground.last(4), s.motor_ground, motor_ground_raw);
  const auto range = module(Place::Scanner).words("scan.range");
  for (std::size_t i = 0; i < range.size(); ++i) {
    const hal::ScannerHead& head = robot_part<hal::ScannerPart>().heads[i];
    range[i] = scan_raw(s.scan_m[i], head.min_m, head.max_m);
  }
  module(Place::Scanner).words("scan.angle")[0] = angle_raw(s.scanner_rad);
  module(Place::Turret).words("turret.angle")[0] = angle_raw(s.turret_rad);
  module(Place::Turret).words("turret.torque")[0] = 0;
  module(Place::Gripper).words("gripper.angle")[0] = angle_raw(s.gripper_rad);
  module(Place::Gripper).words("gripper.busy")[0] = s.gripper_busy ? 1 : 0;
  module(Place::Base).words("battery")[0] = thousandths_raw(s.battery_V);
  const auto force = module(Place::Base).words("acc");
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = thousandths_raw(s.force_m_s2[i] / 9.81);
  module(Place::Base).words("gyro")[0] = gyro_raw(s.turn_rad_s);
}

BodyCommand Footbot::commanded(bool gripper_busy) const {
  BodyCommand c;
  c.left_m_s = wheel_m_s(motors_[0]);
  c.right_m_s = wheel_m_s(motors_[1]);
  // While the robot tries its grip with the turret it obeys nobody else.
  const BodyCommand& last = command_;
  const auto turret_mode = static_cast<TurretMode>(std::clamp<int>(word(Place::Turret, "turret.mode"), 0, 3));
  c.turret = gripper_busy ? last.turret : turret_mode;
  c.turret_rad_s = gripper_busy ? last.turret_rad_s : turret_rad_s(word(Place::Turret, "turret.speed"));
  c.turret_rad = gripper_busy ? last.turret_rad : angle_rad(word(Place::Turret, "turret.target"));
  c.gripper_rad = angle_rad(std::clamp<std::int16_t>(word(Place::Gripper, "gripper.target"), -16384, 16384));
  c.scanner = static_cast<ScannerMode>(std::clamp<int>(word(Place::Scanner, "scan.mode"), 0, 2));
  c.scanner_rad_s = scanner_rad_s(word(Place::Scanner, "scan.speed"));
  c.scanner_rad = angle_rad(word(Place::Scanner, "scan.target"));
  constexpr std::array<std::string_view, 3> kColors = {"led.red", "led.green", "led.blue"};
  const auto beacon = module(Place::Leds).words("beacon");
  const auto light = [](std::int16_t word) { return static_cast<std::uint8_t>(std::clamp<int>(word, 0, 255)); };
  for (std::size_t color = 0; color < kColors.size(); ++color) {
    const auto words = module(Place::Leds).words(kColors[color]);
    for (std::size_t i = 0; i < words.size(); ++i) c.rgb[3 * i + color] = light(words[i]);
    c.rgb[3 * kBeacon + color] = light(beacon[color]);
  }
  // A radio that has nothing but zeros to say is silent.
  c.radio = bytes_of(module(Place::RangeAndBearing).words("rab.tx"));
  c.radio_sends = c.radio != decltype(c.radio){};
  return c;
}

void Footbot::variables_to_actuators(hal::TimeNs at) {
  put_speeds(at);
  turn_motors(at);
  actuate(at);
}

void Footbot::actuate(hal::TimeNs at) {
  const BodyCommand before = command_;
  command_ = commanded(body_.sense(at).gripper_busy);
  if (command_ == before) return;
  tell_changes(at, before);
  body_.actuate(at, command_);
}

void Footbot::tell_changes(hal::TimeNs at, const BodyCommand& before) const {
  const BodyCommand& c = command_;
  const auto turret = [](const BodyCommand& b) { return std::tuple(b.turret, b.turret_rad_s, b.turret_rad); };
  const auto scanner = [](const BodyCommand& b) { return std::tuple(b.scanner, b.scanner_rad_s, b.scanner_rad); };
  if (turret(c) != turret(before)) {
    sink_(at, "turret",
          {{"mode", static_cast<int>(c.turret)}, {"speed_rad_s", c.turret_rad_s}, {"angle_rad", c.turret_rad}});
  }
  if (scanner(c) != scanner(before)) {
    sink_(at, "scanner",
          {{"mode", static_cast<int>(c.scanner)}, {"speed_rad_s", c.scanner_rad_s}, {"angle_rad", c.scanner_rad}});
  }
  if (c.gripper_rad != before.gripper_rad) sink_(at, "gripper", {{"aperture_rad", c.gripper_rad}});
  if (c.rgb != before.rgb) sink_(at, "leds", {{"rgb", numbers(c.rgb)}});
  if (c.radio != before.radio) sink_(at, "radio", {{"sends", c.radio_sends}, {"payload", numbers(c.radio)}});
}

void Footbot::note_wheels(hal::TimeNs at, std::string_view by) {
  const int left = word(Place::LeftMotor, "speed");
  const int right = word(Place::RightMotor, "speed");
  const bool changed = left != told_left_ || right != told_right_;
  told_left_ = left;
  told_right_ = right;
  if (!first_driven_at_ && (left != 0 || right != 0)) first_driven_at_ = at;
  sink_(at, "wheels", {{"left", left}, {"right", right}, {"by", by}, {"changed", changed}});
}

}  // namespace tandem::bridges::footbot_emulator
