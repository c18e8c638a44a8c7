#include "bridges/eyebot_emulator/eyebot.hpp"

#include <algorithm>
#include <cmath>

#include "hal/angle.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

constexpr std::size_t kRadioBytes = 10;  // of a message, at most

using hal::TimeNs;
using std::numbers::pi;

constexpr TimeNs kLoopNs = 10 * hal::kNsPerMs;
constexpr int kLoopRate_Hz = 100;
constexpr std::int64_t kFreshUs = 250'000;                // a command whose stamp is farther off is stale
constexpr TimeNs kVelocityValidNs = 500 * hal::kNsPerMs;  // where a velocity says nothing of it
constexpr TimeNs kDamageTellNs = 10 * hal::kNsPerSecond;
constexpr double kAmpere = 12.0;  // [chosen] of a hovering robot; a twentieth of it at rest
constexpr std::size_t kMostHeard = 64;

// Places of command channels in `kCommandChannels`.
constexpr std::size_t kMode = 0;
constexpr std::size_t kHubHeartbeat = 7;

/// Whether something that happens `rate_Hz` times a second happens in loop number `n`; `offset` spreads the channels.
bool is_due(std::int64_t n, int rate_Hz, int offset) {
  const int every = kLoopRate_Hz / rate_Hz;
  return n % every == offset % every;
}

std::vector<std::int64_t> numbers(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

/// What was asked, as fields of the log.
struct Asked {
  EventFields& fields;
  void operator()(const ModeCommand& c) const {
    fields.emplace_back("action", name_of_action(c.action));
    fields.emplace_back("param", static_cast<double>(c.param));
  }
  void operator()(const PositionCommand& c) const {
    fields.emplace_back("frame", static_cast<int>(c.frame));
    vector(c.pos);
    if (c.use_yaw) fields.emplace_back("yaw", c.yaw);
    fields.emplace_back("max_speed", static_cast<double>(c.max_speed));
    fields.emplace_back("timeout_ms", c.timeout_ms);
  }
  void operator()(const VelocityCommand& c) const {
    fields.emplace_back("frame", static_cast<int>(c.frame));
    vector(c.vel);
    fields.emplace_back("yaw_rate", c.yaw_rate);
    fields.emplace_back("timeout_ms", c.timeout_ms);
  }
  void operator()(const auto&) const {}  // devices tell what they do themselves

  void vector(const Vec3& v) const {
    fields.emplace_back("x", v[0]);
    fields.emplace_back("y", v[1]);
    fields.emplace_back("z", v[2]);
  }
};

/// Whether both are worth the same status report: all but what counts and ages.
bool same_situation(const Supervisor& s, Mode mode, Failsafe failsafe, bool armed) {
  return s.mode() == mode && s.failsafe() == failsafe && s.armed() == armed;
}

Manoeuvre manoeuvre_of(Mode mode) {
  switch (mode) {
    case Mode::TakeOff:
      return Manoeuvre::TakeOff;
    case Mode::Hover:
    case Mode::Position:
    case Mode::Velocity:
      return Manoeuvre::Fly;
    case Mode::Land:
    case Mode::Estop:
      return Manoeuvre::Land;
    case Mode::Attaching:
    case Mode::Attached:
      return Manoeuvre::Attach;
    case Mode::Detaching:
      return Manoeuvre::Detach;
    case Mode::Off:
    case Mode::Idle:
      break;
  }
  return Manoeuvre::Rest;
}

}  // namespace

Eyebot::Eyebot(const Options& options, EmulatedBody& body, EventSink sink)
    : options_(options),
      body_(body),
      sink_(sink ? std::move(sink) : [](TimeNs, std::string_view, const EventFields&) {}),
      prefix_("eyebot/" + options.name + "/"),
      session_(options.session),
      pilot_(options.fence),
      battery_(options.flight_s),
      to_body_(options.delays.command_s + options.delays.body_s),
      from_body_(options.delays.counters_s) {}

void Eyebot::tell(TimeNs at, std::string_view event, EventFields fields) const {
  fields.insert(fields.begin(), EventField("robot", options_.name));
  sink_(at, event, fields);
}

void Eyebot::power_on(TimeNs at, std::int64_t unix_us) {
  clock_us_ = unix_us - at / 1000;
  booted_at_ = next_loop_ = at + options_.boot_ns;
  looked_at_ = at;
}

void Eyebot::restart(std::int32_t session, TimeNs at) {
  run_until(at);
  session_ = session;
  supervisor_ = {};
  senders_ = {};
  traffic_.clear();
  scan_.clear();
  heard_.clear();
  pilot_ = Pilot(options_.fence);
  last_obeyed_ = {};
  last_obeyed_at_.reset();
  rejected_ = 0;
  text_.clear();
  state_seq_ = answered_seq_ = -1;
  answering_session_ = 0;
  hubs_.clear();
  loops_ = flooded_ = 0;
  booted_at_ = next_loop_ = at + options_.boot_ns;
  command_ = {};
  to_body_.clear();  // at once: there is no power
  body_.actuate(at, command_);
  tell_changes(at);
}

void Eyebot::set_charge(double charge) noexcept {
  battery_.set(charge);
  charge_is_set_ = true;
}

void Eyebot::take_sent(std::vector<Datagram>& out) {
  out.insert(out.end(), std::make_move_iterator(outbox_.begin()), std::make_move_iterator(outbox_.end()));
  outbox_.clear();
}

void Eyebot::run_until(TimeNs now) {
  for (; next_loop_ <= now; next_loop_ += kLoopNs) loop(next_loop_);
}

void Eyebot::loop(TimeNs at) {
  if (supervisor_.mode() == Mode::Off) {
    supervisor_.power_on();
    tell(at, "boot", {{"session", session_}});
  }
  look(at);
  act(at);
  report(at);
  ++loops_;
}

void Eyebot::look(TimeNs at) {
  const bool was_up = !senses_.on_ground;
  const double sinking_m_s = -senses_.v_WB[2];
  battery_.run(at - looked_at_, supervisor_.motors());
  looked_at_ = at;
  to_body_.take(at, [this](TimeNs from, const BodyCommand& command) { body_.actuate(from, command); });
  const BodySenses now = body_.sense(at);
  if (loops_ == 0) senses_ = now;  // older ones there are not
  from_body_.put(at, now);
  from_body_.take(at, [this](TimeNs, const BodySenses& senses) { senses_ = senses; });
  if (senses_.charge && !charge_is_set_) battery_.set(*senses_.charge);
  for (Heard& heard : body_.take_heard()) heard_.push_back(std::move(heard));
  if (heard_.size() > kMostHeard) {
    heard_.erase(heard_.begin(), heard_.end() - static_cast<std::ptrdiff_t>(kMostHeard));
  }
  sample_scan(at);
  if (was_up && senses_.on_ground) tell(at, "landed", {{"speed_m_s", sinking_m_s}});
}

Conditions Eyebot::conditions() const {
  return {.hardware_fault = hardware_fault_,
          .battery_critical = battery_.charge() < EmulatedBattery::kCritical,
          .position_valid = !position_lost_,
          .inside_fence = options_.fence.contains(senses_.p_WB),
          .on_ground = senses_.on_ground,
          .at_ceiling = senses_.at_ceiling,
          .ceiling_seen = senses_.ceiling_m >= 0.0,
          .height_m = senses_.ground_m >= 0.0 ? senses_.ground_m : senses_.p_WB[2]};
}

void Eyebot::act(TimeNs at) {
  supervisor_.update(conditions(), at);
  tell_changes(at);
  const Guidance guidance = pilot_.guide(supervisor_, senses_);
  command_.motors = supervisor_.motors();
  command_.magnet = supervisor_.magnet();
  command_.manoeuvre = manoeuvre_of(supervisor_.mode());
  command_.manoeuvre_m_s = supervisor_.speed_m_s();
  command_.velocity_m_s = guidance.velocity_m_s;
  command_.yaw_rad_s = guidance.yaw_rad_s;
  to_body_.put(at, command_);
  to_body_.take(at, [this](TimeNs from, const BodyCommand& command) { body_.actuate(from, command); });
}

void Eyebot::sample_scan(TimeNs at) {
  if (command_.scanner == ScannerMode::Off) return scan_.clear();
  for (std::size_t head = 0; head < senses_.scan_m.size(); ++head) {
    const double range_m = senses_.scan_m[head];
    ScanSample sample;
    sample.head = static_cast<std::uint8_t>(head);
    sample.utime = utime(at);
    sample.angle_rad = hal::wrapped(senses_.scanner_rad + 0.5 * pi * static_cast<double>(head));
    const hal::ScannerHead& seen = robot_part<hal::ScannerPart>().heads[head];
    sample.range_m = range_m < seen.min_m ? -1.0 : range_m > seen.max_m ? -2.0 : range_m;
    scan_.push_back(sample);
  }
}

// Telemetry ------------------------------------------------------------------

void Eyebot::send(std::string_view topic, TimeNs at, const std::function<Bytes(const Header&)>& write) {
  auto found = traffic_.find(topic);
  if (found == traffic_.end()) found = traffic_.emplace(topic, Traffic{}).first;
  Traffic& traffic = found->second;
  const Header header{utime(at), traffic.next_seq, session_};
  outbox_.push_back({prefix_ + std::string(topic), write(header), at});
  traffic.next_seq = traffic.next_seq == std::numeric_limits<std::int32_t>::max()
                         ? std::numeric_limits<std::int32_t>::min()
                         : traffic.next_seq + 1;
  ++traffic.sent;
}

StatusReport Eyebot::status(TimeNs at) const {
  StatusReport status;
  status.mode = static_cast<std::int8_t>(supervisor_.mode());
  status.failsafe = static_cast<std::int8_t>(supervisor_.failsafe());
  status.armed = supervisor_.armed();
  status.magnet_on = supervisor_.magnet();
  status.attached = supervisor_.mode() == Mode::Attached;
  status.command = last_obeyed_;
  if (last_obeyed_at_) {
    const TimeNs age_ms = (at - *last_obeyed_at_) / hal::kNsPerMs;
    status.command_age_ms = static_cast<std::int32_t>(std::min<TimeNs>(age_ms, 0x7FFFFFFF));
  }
  status.rejected = rejected_;
  status.text = text_;
  return status;
}

void Eyebot::report(TimeNs at) {
  const std::int64_t n = loops_;
  const auto send_state = [&] {
    state_seq_ = traffic_.contains("state") ? traffic_.find("state")->second.next_seq : 0;
    state_sent_at_ = at;
    BodySenses believed = senses_;
    believed.p_WB[0] += place_error_m_;
    send("state", at, [&](const Header& h) { return write_state(h, believed, !position_lost_); });
  };
  if (state_rate_Hz_ <= kStateRate_Hz) {
    if (is_due(n, kStateRate_Hz, 0)) send_state();
  } else {
    for (flooded_ += state_rate_Hz_; flooded_ >= kLoopRate_Hz; flooded_ -= kLoopRate_Hz) send_state();
  }
  if (is_due(n, 50, 1)) send("altitude", at, [&](const Header& h) { return write_altitude(h, senses_); });
  if (is_due(n, 10, 2)) send_status(at);
  if (is_due(n, 5, 3)) {
    const std::int64_t uptime_ms = (at - booted_at_) / hal::kNsPerMs;
    send("heartbeat", at, [&](const Header& h) { return write_heartbeat(h, options_.name, uptime_ms); });
  }
  if (is_due(n, 1, 4)) {
    const bool motors = supervisor_.motors();
    BatteryReport battery;
    battery.charge = battery_.charge();
    const auto& cells = robot_part<hal::BatteryPart>();
    battery.voltage_V = cells.empty_V + battery.charge * (cells.full_V - cells.empty_V);
    battery.current_A = motors ? kAmpere : 0.05 * kAmpere;
    battery.time_left_s = battery_.time_left_s(motors);
    battery.low = battery.charge < EmulatedBattery::kLow;
    send("battery", at, [&](const Header& h) { return write_battery(h, battery); });
  }
  report_rings(at);
  const bool moves = command_.motors || senses_.v_WB != Vec3{};
  if (moves && is_due(n, 10, 0)) {
    const Vec3& p = senses_.p_WB;
    const Vec3& v = senses_.v_WB;
    tell(at, "motion",
         {{"x", p[0]}, {"y", p[1]}, {"z", p[2]}, {"vx", v[0]}, {"vy", v[1]}, {"vz", v[2]}, {"yaw", senses_.yaw_rad()}});
  }
}

void Eyebot::report_rings(TimeNs at) {
  const std::int64_t n = loops_;
  if (is_due(n, 10, 5)) send("prox", at, [&](const Header& h) { return write_proximity(h, senses_); });
  if (is_due(n, 10, 6)) send("light", at, [&](const Header& h) { return write_light(h, senses_); });
  if (is_due(n, 10, 7)) {
    send("rab", at, [&](const Header& h) { return write_radio(h, heard_, h.utime); });
    heard_.clear();
  }
  if (is_due(n, 10, 8)) {
    send("pan_tilt", at, [&](const Header& h) { return write_pan_tilt(h, senses_, command_.laser); });
  }
  if (is_due(n, 10, 9)) {
    send("blobs", at, [&](const Header& h) { return write_blobs(h, senses_); });
    if (command_.scanner != ScannerMode::Off) {
      const double rpm = command_.scanner == ScannerMode::Speed ? command_.scanner_rad_s * 30.0 / pi : 0.0;
      send("scan", at, [&](const Header& h) { return write_scan(h, rpm, senses_.scanner_rad, scan_); });
      scan_.clear();
    }
  }
  if (options_.image_hz > 0.0) {
    const auto every = static_cast<std::int64_t>(std::lround(kLoopRate_Hz / std::min(options_.image_hz, 2.0)));
    if (n % every == 0) send("image", at, [&](const Header& h) { return write_image(h, senses_); });
  }
}

void Eyebot::tell_sent(TimeNs at) const {
  for (const auto& [topic, traffic] : traffic_) {
    tell(at, "sent", {{"channel", prefix_ + topic}, {"count", traffic.sent}, {"last_seq", traffic.next_seq - 1}});
  }
}

// Commands -------------------------------------------------------------------

void Eyebot::receive(std::string_view channel, std::span<const std::byte> payload, TimeNs at) {
  run_until(at);
  if (supervisor_.mode() == Mode::Off) return;
  const bool from_hub = channel.starts_with("hub/") && channel.ends_with("/heartbeat");
  if (!from_hub && !channel.starts_with(prefix_ + "cmd/")) return;
  const std::string_view topic = from_hub ? kCommandChannels[kHubHeartbeat] : channel.substr(prefix_.size());
  const auto found = std::ranges::find(kCommandChannels, topic);
  const auto command = read_command(topic, payload);
  if (!command.ok()) return damaged(channel, command.error().message, at);
  hear(command.value(), static_cast<std::size_t>(found - kCommandChannels.begin()), at);
}

void Eyebot::damaged(std::string_view channel, const std::string& why, TimeNs at) {
  constexpr std::size_t kMostChannels = 64;  // names of channels come from outside, too
  auto found = damage_.find(channel);
  if (found == damage_.end()) {
    if (damage_.size() == kMostChannels) return;
    found = damage_.emplace(channel, Damage{}).first;
  }
  Damage& damage = found->second;
  ++damage.count;
  if (damage.count > 1 && at - damage.told_at < kDamageTellNs) return;
  damage.told_at = at;
  tell(at, "malformed", {{"channel", channel}, {"why", why}, {"count", damage.count}});
}

void Eyebot::hear(const Command& command, std::size_t channel, TimeNs at) {
  if (command.header.session == 0) return damaged(kCommandChannels[channel], "session 0", at);
  if (channel == kHubHeartbeat) return hear_hub(command, at);
  if (channel == kMode) return hear_order(command, at);
  const Answer answer = decide(command, channel, at);
  tell_command(command, channel, answer, false, at);
  tell_changes(at);
}

// Every hub of the network is heard, the one in control matters.
void Eyebot::hear_hub(const Command& command, TimeNs at) {
  constexpr std::size_t kMostHubs = 64;
  const HubHeartbeat& hub = std::get<HubHeartbeat>(command.body);
  if (hub.major != kProtocolMajor) return damaged("heartbeat", "protocol " + std::to_string(hub.major), at);
  const std::int32_t session = command.header.session;
  if (hubs_.size() < kMostHubs && hubs_.insert(session).second) {
    tell(at, "heartbeat", {{"name", hub.name}, {"session", session}});
  }
  if (session != supervisor_.controller() || !senders_.hear(command.header, kHubHeartbeat)) return;
  supervisor_.heartbeat(session, at);
}

// Every order is carried out once and answered as often as it is heard.
void Eyebot::hear_order(const Command& command, TimeNs at) {
  const std::optional<Answer> before = senders_.answer_to(command.header);
  const Answer answer = before ? *before : decide(command, kMode, at);
  if (!before) senders_.remember(command.header, answer);
  tell_command(command, kMode, answer, before.has_value(), at);
  const AckReport ack{prefix_ + std::string(kCommandChannels[kMode]), command.header.session, command.header.seq,
                      static_cast<std::int8_t>(answer.verdict), answer.text};
  send("ack", at, [&](const Header& h) { return write_ack(h, ack); });
  tell_changes(at);
}

bool Eyebot::is_stale(const Header& header, TimeNs at) const {
  if (!options_.clock_synced) return false;
  const std::int64_t now_us = utime(at);
  // Stamps are any numbers at all: no difference that could overflow.
  return header.utime < now_us - kFreshUs || header.utime > now_us + kFreshUs;
}

Answer Eyebot::decide(const Command& command, std::size_t channel, TimeNs at) {
  const bool flight = channel <= 2;
  const auto* order = std::get_if<ModeCommand>(&command.body);
  const bool estop = order != nullptr && order->action == static_cast<std::int8_t>(Action::Estop);
  Answer answer;
  if (!senders_.hear(command.header, channel) && !estop) {
    answer = {Verdict::RejectedStale, "an older one than the last"};
  } else if (flight && !estop && is_stale(command.header, at)) {
    answer = {Verdict::RejectedStale, "its stamp is more than 250 ms off"};
  } else if (!is_finite(command.body)) {
    answer = {Verdict::RejectedRange, "a number that is none"};
  } else {
    answer = obey(command.body, command.header.session, at);
  }
  if (flight && !answer.ok()) ++rejected_;
  if (flight && answer.ok()) {
    last_obeyed_ = command.header;
    last_obeyed_at_ = at;
  }
  return answer;
}

Answer Eyebot::obey(const CommandBody& body, std::int32_t session, TimeNs at) {
  if (const auto* order = std::get_if<ModeCommand>(&body)) return supervisor_.order(session, *order, at);
  if (const auto* place = std::get_if<PositionCommand>(&body)) {
    std::optional<TimeNs> until;
    if (place->timeout_ms > 0) until = at + place->timeout_ms * hal::kNsPerMs;
    Pilot planned = pilot_;
    if (Answer answer = planned.go_to(*place, senses_); !answer.ok()) return answer;
    Answer answer = supervisor_.setpoint(session, Mode::Position, until, at);
    if (answer.ok()) pilot_ = planned;
    return answer;
  }
  if (const auto* velocity = std::get_if<VelocityCommand>(&body)) {
    const TimeNs valid_ns = velocity->timeout_ms > 0 ? velocity->timeout_ms * hal::kNsPerMs : kVelocityValidNs;
    Pilot planned = pilot_;
    if (Answer answer = planned.fly(*velocity); !answer.ok()) return answer;
    Answer answer = supervisor_.setpoint(session, Mode::Velocity, at + valid_ns, at);
    if (answer.ok()) pilot_ = planned;
    return answer;
  }
  if (supervisor_.controller() != 0 && session != supervisor_.controller()) {
    return {Verdict::RejectedSource, "another hub is in control"};
  }
  const BodyCommand before = command_;
  if (const auto* leds = std::get_if<LedsCommand>(&body)) {
    const auto on = [&](int bit) { return (leds->rings & bit) != 0; };
    command_.lights = {on(1), on(2), on(4), leds->lower, leds->upper, leds->beacon};
    if (command_.lights != before.lights) {
      send("leds", at, [&](const Header& h) { return write_leds(h, command_.lights); });
    }
  } else if (const auto* head = std::get_if<PanTiltCommand>(&body)) {
    command_.pan_rad = static_cast<double>(head->pan);
    command_.tilt_rad = static_cast<double>(head->tilt);
    command_.laser = head->laser;
  } else if (const auto* scanner = std::get_if<ScannerCommand>(&body)) {
    command_.scanner = !scanner->enable ? ScannerMode::Off
                       : scanner->fixed ? ScannerMode::Position
                                        : ScannerMode::Speed;
    command_.scanner_rad_s = static_cast<double>(scanner->rpm) * pi / 30.0;
    command_.scanner_rad = static_cast<double>(scanner->angle);
  } else if (const auto* radio = std::get_if<RadioCommand>(&body)) {
    if (radio->data.size() > kRadioBytes) {
      return {Verdict::RejectedRange, "the radio sends " + std::to_string(kRadioBytes) + " bytes at most"};
    }
    command_.radio = radio->data;
  }
  tell_devices(at, before);
  return {};
}

// What the log is told -------------------------------------------------------

void Eyebot::tell_devices(TimeNs at, const BodyCommand& before) const {
  const BodyCommand& c = command_;
  if (c == before) return;
  if (c.lights != before.lights) {
    tell(at, "lights",
         {{"lower_on", c.lights.lower_on},
          {"upper_on", c.lights.upper_on},
          {"beacon_on", c.lights.beacon_on},
          {"lower", numbers(c.lights.lower)},
          {"upper", numbers(c.lights.upper)},
          {"beacon", numbers(c.lights.beacon)}});
  } else if (c.radio != before.radio) {
    tell(at, "radio", {{"payload", numbers(c.radio)}});
  } else if (c.scanner != before.scanner || c.scanner_rad_s != before.scanner_rad_s ||
             c.scanner_rad != before.scanner_rad) {
    tell(at, "scanner",
         {{"mode", static_cast<int>(c.scanner)}, {"speed_rad_s", c.scanner_rad_s}, {"angle_rad", c.scanner_rad}});
  } else {
    tell(at, "pan_tilt", {{"pan_rad", c.pan_rad}, {"tilt_rad", c.tilt_rad}, {"laser", c.laser}});
  }
}

void Eyebot::tell_command(const Command& command, std::size_t channel, const Answer& answer, bool again, TimeNs at) {
  const Header& h = command.header;
  const bool first =
      state_seq_ >= 0 && at >= state_sent_at_ && (answered_seq_ != state_seq_ || answering_session_ != h.session);
  answered_seq_ = state_seq_;
  answering_session_ = h.session;
  // The age of a stamp that is nowhere near is told as the clock's own time.
  const bool sane = h.utime >= 0 && h.utime < std::int64_t{1} << 62U;
  EventFields fields = {{"channel", kCommandChannels[channel]},
                        {"session", h.session},
                        {"seq", h.seq},
                        {"utime", h.utime},
                        {"age_us", sane ? utime(at) - h.utime : utime(at)},
                        {"verdict", name_of(answer.verdict)},
                        {"why", answer.text},
                        {"again", again}};
  std::visit(Asked{fields}, command.body);
  fields.emplace_back("state_seq", state_seq_);
  fields.emplace_back("state_sent_ns", state_sent_at_);
  fields.emplace_back("first", first);
  tell(at, "command", std::move(fields));
}

void Eyebot::tell_changes(TimeNs at) {
  const Supervisor& s = supervisor_;
  if (told_controller_ != s.controller()) tell(at, "control", {{"session", s.controller()}});
  told_controller_ = s.controller();
  if (same_situation(s, told_mode_, told_failsafe_, told_armed_)) return;
  if (told_failsafe_ != s.failsafe()) {
    tell(at, "failsafe", {{"from", name_of(told_failsafe_)}, {"to", name_of(s.failsafe())}});
  }
  if (told_mode_ != s.mode()) tell(at, "mode", {{"from", name_of(told_mode_)}, {"to", name_of(s.mode())}});
  if (!first_driven_at_ && (s.mode() == Mode::Position || s.mode() == Mode::Velocity)) first_driven_at_ = at;
  if (s.mode() == Mode::Hover && told_mode_ != Mode::Hover) pilot_.stay(senses_);
  told_mode_ = s.mode();
  told_failsafe_ = s.failsafe();
  told_armed_ = s.armed();
  text_ = s.failsafe() == Failsafe::None ? "" : "fail-safe " + std::string(name_of(s.failsafe()));
  if (s.mode() != Mode::Off) send_status(at);
}

}  // namespace tandem::bridges::eyebot_emulator
