#include "bridges/thymio_emulator/thymio.hpp"

#include <algorithm>

#include "bridges/thymio_emulator/raw_units.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

namespace type = aseba_emulation::type;
using aseba_emulation::NativeFunction;

constexpr hal::TimeNs kLoopNs = 10 * hal::kNsPerMs;  // the motors' rate; the others are parts of it
constexpr std::int64_t kButtonsEvery = 5, kProximityEvery = 10, kAccelerometerEvery = 6, kTemperatureEvery = 100;
constexpr std::int16_t kProduct = 8;
constexpr std::size_t kCircle = 8, kBottomLeft = 8, kBottomRight = 9, kTop = 10;

std::vector<NativeFunction::Argument> words_named(std::initializer_list<const char*> names) {
  std::vector<NativeFunction::Argument> all;
  for (const char* name : names) all.push_back({1, name});
  return all;
}

}  // namespace

Thymio::Thymio(const Options& options, EmulatedBody& body, EventSink sink)
    : options_(options),
      body_(body),
      sink_(sink ? std::move(sink) : [](hal::TimeNs, std::string_view, const EventFields&) {}),
      node_(spec()),
      to_motors_(options.delays.command_s + options.delays.body_s),
      to_counters_(options.delays.command_s + options.delays.counters_s) {}

aseba_emulation::NodeSpec Thymio::spec() {
  aseba_emulation::NodeSpec spec;
  spec.id = options_.node;
  spec.name = "thymio-II";
  spec.variables = {{"_id", 1},
                    {"event.source", 1},
                    {"event.args", 32},
                    {"_productId", 1},
                    {"_fwversion", 2},
                    {"button.backward", 1},
                    {"button.left", 1},
                    {"button.center", 1},
                    {"button.forward", 1},
                    {"button.right", 1},
                    {"prox.horizontal", 7},
                    {"prox.comm.rx", 1},
                    {"prox.comm.tx", 1},
                    {"prox.ground.ambiant", 2},
                    {"prox.ground.reflected", 2},
                    {"prox.ground.delta", 2},
                    {"motor.left.target", 1},
                    {"motor.right.target", 1},
                    {"motor.left.speed", 1},
                    {"motor.right.speed", 1},
                    {"motor.left.pwm", 1},
                    {"motor.right.pwm", 1},
                    {"acc", 3},
                    {"temperature", 1},
                    {"rc5.address", 1},
                    {"rc5.command", 1},
                    {"mic.intensity", 1},
                    {"mic.threshold", 1},
                    {"timer.period", 2},
                    {"sd.present", 1}};
  for (const char* event :
       {"button.backward", "button.left", "button.center", "button.forward", "button.right", "buttons", "prox",
        "prox.comm", "tap", "acc", "mic", "sound.finished", "temperature", "rc5", "motor", "timer0", "timer1"})
    spec.events.push_back({event, ""});
  const auto light = [this](std::size_t led) {
    return [this, led](std::span<const std::int16_t> v) {
      for (std::size_t i = 0; i < 3; ++i) rgb_[3 * led + i] = lamp_channel(v[i]);
    };
  };
  const auto circle = [this](std::span<const std::int16_t> v) {
    for (std::size_t i = 0; i < kCircle; ++i) {
      rgb_[3 * i] = rgb_[3 * i + 1] = lamp_channel(v[i]);  // yellow
    }
  };
  const auto tone = [this](std::span<const std::int16_t> v) {
    sink_(now_, "tone", {{"hz", v[0]}, {"length", v[1]}});
    tone_Hz_ = v[1] >= 0 ? std::max<double>(v[0], 0.0) : 0.0;
    tone_ends_.reset();
    if (v[1] > 0) tone_ends_ = now_ + v[1] * hal::kNsPerSecond / 60;
  };
  const auto colors = words_named({"red", "green", "blue"});
  spec.functions = {{"math.copy", "copies src to dest element by element", {{-1, "dest"}, {-1, "src"}}},
                    {"math.fill", "fills dest with constant", {{-1, "dest"}, {1, "value"}}},
                    {"sound.play", "Start playback of pN.wav", words_named({"N"})},
                    {"sound.system", "Start playback of system sound N", words_named({"N"})},
                    {"leds.circle", "Set circular ring leds",
                     words_named({"led 0", "led 1", "led 2", "led 3", "led 4", "led 5", "led 6", "led 7"}), circle},
                    {"leds.top", "Set RGB top led", colors, light(kTop)},
                    {"leds.bottom.right", "Set RGB botom right led", colors, light(kBottomRight)},
                    {"leds.bottom.left", "Set RGB botom left led", colors, light(kBottomLeft)},
                    {"sound.freq", "Play frequency", words_named({"Hz", "ds"}), tone}};
  spec.bytecode_words = 1534;
  spec.stack_words = 32;
  spec.variable_words = 586;
  spec.runs_programs = true;
  spec.reset_clears = true;
  return spec;
}

void Thymio::power_on(hal::TimeNs at) {
  now_ = next_loop_ = ready_at_ = at;
  (void)node_.take_reset();
  identify();
  sink_(at, "boot", {{"module", node_.name()}, {"id", node_.id()}});
  sensors_to_variables(at, true);
  body_.actuate(at, command_);
}

void Thymio::identify() {
  node_.words("_productId")[0] = kProduct;
  node_.words("_fwversion")[0] = options_.firmware;
}

/// What a reset leaves behind, beside the variables that it clears.
void Thymio::note_reset() {
  if (!node_.take_reset()) return;
  identify();
  rgb_.fill(0);
  tone_Hz_ = 0.0;
  timers_ = {};
}

void Thymio::restart(hal::TimeNs at, std::string_view why) {
  run_until(at);
  sink_(at, "off", {{"why", why}});
  node_.restart();
  note_reset();
  waiting_.clear();
  told_ = false;
  ready_at_ = at + options_.boot_ns;
  // At once: there is no power.
  to_motors_.clear();
  to_counters_.clear();
  motors_ = shown_ = {};
  variables_to_actuators(at);
}

void Thymio::load_other_program(hal::TimeNs at) {
  run_until(at);
  if (!works(at)) return;
  const auto node = static_cast<std::uint16_t>(node_.id());
  std::vector<Message> answers;
  node_.obey(Message{0, type::kSetBytecode, {}}.add(node).add(0).add(1), at, answers, sink_);
  node_.obey(Message{0, type::kRun, {}}.add(node), at, answers, sink_);
  note_reset();
  variables_to_actuators(at);
  say(std::move(answers), at);
}

void Thymio::receive(const Message& message, hal::TimeNs at) {
  run_until(at);
  if (!works(at) || deaf_) return;
  std::vector<Message> answers;
  node_.obey(message, at, answers, sink_);
  note_reset();
  variables_to_actuators(at);
  say(std::move(answers), at);
  if (message.type == type::kReboot && message.word(0) == node_.id()) restart(at, "reboot");
}

void Thymio::say(std::vector<Message> answers, hal::TimeNs at) {
  if (silent_) return;
  for (Message& answer : answers) waiting_.push_back({std::move(answer), at + options_.answer_ns});
}

void Thymio::run_until(hal::TimeNs now) {
  for (; next_loop_ <= now; next_loop_ += kLoopNs) loop(next_loop_);
  turn_motors(now);
  now_ = std::max(now_, now);
  for (; !waiting_.empty() && waiting_.front().at <= now; waiting_.pop_front()) {
    sent_.push_back(std::move(waiting_.front()));
  }
}

void Thymio::take_sent(std::vector<TimedMessage>& out) {
  out.insert(out.end(), sent_.begin(), sent_.end());
  sent_.clear();
}

hal::TimeNs Thymio::next_event() const {
  const hal::TimeNs next = std::min(next_loop_, to_motors_.next_at().value_or(next_loop_));
  return waiting_.empty() ? next : std::min(next, waiting_.front().at);
}

void Thymio::loop(hal::TimeNs at) {
  turn_motors(at);
  now_ = std::max(now_, at);
  if (!works(at)) return;
  if (!std::exchange(told_, true)) {
    sink_(at, "boot", {{"module", node_.name()}, {"id", node_.id()}});
    sensors_to_variables(at, true);
  }
  ++loops_;
  if (tone_ends_ && at >= *tone_ends_) {
    tone_Hz_ = 0.0;
    tone_ends_.reset();
  }
  sensors_to_variables(at, false);
  happen("motor", at);
  if (loops_ % kButtonsEvery == 0) happen("buttons", at);
  if (loops_ % kProximityEvery == 0) happen("prox", at);
  if (loops_ % kAccelerometerEvery == 0) happen("acc", at);
  if (loops_ % kTemperatureEvery == 0) happen("temperature", at);
  for (std::size_t i = 0; i < timers_.size(); ++i) run_timer(i, at);
  variables_to_actuators(at);
}

void Thymio::happen(std::string_view event, hal::TimeNs at) {
  std::vector<Message> answers;
  node_.happen(event, at, answers, sink_);
  say(std::move(answers), at);
}

void Thymio::run_timer(std::size_t i, hal::TimeNs at) {
  Timer& timer = timers_[i];
  const std::int16_t period_ms = node_.words("timer.period")[i];
  if (period_ms != timer.period_ms) timer = {period_ms, at + period_ms * hal::kNsPerMs};
  if (period_ms <= 0 || at < timer.next) return;
  timer.next = std::max(timer.next + period_ms * hal::kNsPerMs, at);
  happen(i == 0 ? "timer0" : "timer1", at);
}

/// Each device has a rate of its own; `all`: it was just switched on.
void Thymio::sensors_to_variables(hal::TimeNs at, bool all) {
  to_counters_.take(at, [this](hal::TimeNs, const Targets& targets) { shown_ = targets; });
  node_.words("motor.left.speed")[0] = std::clamp<std::int16_t>(shown_[0], -kMostMotorRaw, kMostMotorRaw);
  node_.words("motor.right.speed")[0] = std::clamp<std::int16_t>(shown_[1], -kMostMotorRaw, kMostMotorRaw);
  const bool proximity = all || loops_ % kProximityEvery == 0;
  const bool acceleration = all || loops_ % kAccelerometerEvery == 0;
  if (!proximity && !acceleration) return;
  const BodySenses s = body_.sense(at);
  if (acceleration) {
    // Its axes point left, to the rear and down, and it shows which way things fall.
    const auto acc = node_.words("acc");
    acc[0] = acceleration_raw(-s.force_m_s2[1]);
    acc[1] = acceleration_raw(s.force_m_s2[0]);
    acc[2] = acceleration_raw(s.force_m_s2[2]);
  }
  constexpr std::array<const char*, 5> kButtons = {"button.backward", "button.left", "button.center", "button.forward",
                                                   "button.right"};
  for (std::size_t i = 0; i < kButtons.size(); ++i) node_.words(kButtons[i])[0] = s.buttons[i] ? 1 : 0;
  node_.words("mic.intensity")[0] = sound_raw(s.sound);
  node_.words("temperature")[0] = 220;
  if (!proximity) return;
  const auto horizontal = node_.words("prox.horizontal");
  for (std::size_t i = 0; i < horizontal.size(); ++i) horizontal[i] = proximity_raw(s.distance_m[i]);
  for (std::size_t i = 0; i < s.ground.size(); ++i) {
    node_.words("prox.ground.delta")[i] = node_.words("prox.ground.reflected")[i] = ground_raw(s.ground[i]);
  }
}

void Thymio::variables_to_actuators(hal::TimeNs at) {
  if (left_target() != told_left_ || right_target() != told_right_) {
    told_left_ = left_target();
    told_right_ = right_target();
    wheels_commanded_at_ = at;
    if (!first_driven_at_ && (told_left_ != 0 || told_right_ != 0)) first_driven_at_ = at;
    sink_(at, "wheels", {{"left", told_left_}, {"right", told_right_}});
    to_motors_.put(at, {told_left_, told_right_});
    to_counters_.put(at, {told_left_, told_right_});
  }
  turn_motors(at);
  actuate(at);
}

/// What the node has been told reaches the motors in its time.
void Thymio::turn_motors(hal::TimeNs now) {
  to_motors_.take(now, [this](hal::TimeNs at, const Targets& targets) {
    motors_ = targets;
    actuate(at);
  });
}

void Thymio::actuate(hal::TimeNs at) {
  const BodyCommand before = command_;
  command_ = {wheel_m_s(motors_[0]), wheel_m_s(motors_[1]), rgb_, tone_Hz_};
  if (command_ == before) return;
  if (command_.rgb != before.rgb)
    sink_(at, "leds", {{"rgb", std::vector<std::int64_t>(command_.rgb.begin(), command_.rgb.end())}});
  body_.actuate(at, command_);
}

}  // namespace tandem::bridges::thymio_emulator
