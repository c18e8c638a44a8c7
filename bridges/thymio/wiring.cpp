#include "bridges/thymio/wiring.hpp"

#include <algorithm>
#include <limits>

#include "bridges/thymio/units.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/infrared_response.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/speaker.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::thymio {
namespace {

using aseba::Node;
using hal::TimeNs;

const std::string kNodeName = "thymio-II";
constexpr std::string_view kFirmware = "_fwversion";
constexpr std::int16_t kProduct = 8;  // of the Thymio II; source: aseba/common/productids.h

constexpr TimeNs kSettle = 120 * hal::kNsPerMs;       // after a reset: the slowest sensor has 10 Hz
constexpr TimeNs kShowAgain = 300 * hal::kNsPerMs;    // for LEDs that were told to show
constexpr TimeNs kLongestRoll = 500 * hal::kNsPerMs;  // between two speeds that are added up

}  // namespace

const std::vector<const hal::PortType*>& port_types() {
  static const auto all =
      port_types_of<hal::WheelEncoders, hal::Odometry, hal::Proximity, hal::Ground, hal::Accelerometer,
                    hal::Microphones, hal::Buttons, hal::Clock, hal::WheelSpeeds, hal::RingLeds, hal::Speaker>();
  return all;
}

void WiringStatistics::describe(StatusVisitor& visitor) const {
  visitor.count("programs_sent", programs);
  visitor.count("stopped_without_word", lapses);
  visitor.count("programs_gone", restarts);
  visitor.count("told_again", not_shown);
}

Wiring::Wiring(const Calibration& calibration, aseba::Network& network, ThymioRobot& robot, bool observe)
    : NodeWiring(network, observe), calibration_(calibration), robot_(robot) {
  if (const auto* const part = robot.kind().part<hal::ProximityPart>(); part != nullptr) response_ = part->response;
  if (response_.empty()) response_ = hal::thymio::kind().part<hal::ProximityPart>()->response;
  sources_ = {{.type = &hal::port_type<hal::Proximity>(), .name = "prox.horizontal", .words = 7},
              {.type = &hal::port_type<hal::Ground>(), .name = "prox.ground.delta", .words = 2},
              {.type = &hal::port_type<hal::Accelerometer>(), .name = "acc", .words = 3},
              {.type = &hal::port_type<hal::Microphones>(), .name = "mic.intensity", .words = 1}};
  for (const std::string_view button :
       {"button.backward", "button.left", "button.center", "button.forward", "button.right"})
    sources_.push_back({.type = &hal::port_type<hal::Buttons>(), .name = button, .words = 1});
  if (calibration_.node != 0) network_.expect(calibration_.node);
}

// --- who is there ---

bool Wiring::ready() const noexcept {
  return node_ != nullptr && node_->ready() && node_->generation == generation_ && trouble_.empty();
}

const Node* Wiring::find_node(std::string& trouble) const {
  const Node* found = nullptr;
  const auto is_thymio = [](const Node& node) { return node.ready() && node.description.name == kNodeName; };
  for (const std::uint8_t id : network_.known()) {
    const Node& node = network_.node(id);
    if (calibration_.node != 0 ? id != calibration_.node : !is_thymio(node)) continue;
    if (found != nullptr) {
      trouble = "several Thymios answer, nodes " + std::to_string(found->id) + " and " + std::to_string(id) +
                "; say which one in its <bridge>: node=\"" + std::to_string(found->id) + "\"";
      return nullptr;
    }
    found = &node;
  }
  if (found == nullptr || is_thymio(*found)) return found;
  if (!found->trouble.empty()) trouble = found->trouble;
  if (found->ready())
    trouble = "node " + std::to_string(found->id) + " is '" + found->description.name + "', no Thymio";
  return found->state == aseba::NodeState::Lost ? found : nullptr;
}

bool Wiring::look() noexcept {
  if (!others_are_there()) return false;
  if (ready()) return true;
  std::string trouble;
  const Node* const node = find_node(trouble);
  if (node != nullptr && node->ready()) {
    bind(*node);
  } else if (node_ == nullptr || !trouble.empty()) {
    trouble_ = trouble;
  }
  return true;
}

void Wiring::bind(const Node& node) {
  node_ = &node;
  generation_ = node.generation;
  ++times_wired_;
  firmware_told_ = false;
  told_ = {};
  held_.assign(node.description.named_words(), 0);
  held_ns_.assign(held_.size(), 0);
  trouble_.clear();
  const std::string who = "node " + std::to_string(node.id) + ": ";
  for (Source& source : sources_) {
    const aseba::Variable* const variable = node.description.variable(source.name);
    source.bound = variable != nullptr && variable->words == source.words;
    if (source.bound) {
      source.address = variable->address;
    } else if (robot_.uses(*source.type)) {
      trouble_ = who + "its variable '" + std::string(source.name) + "' is missing, or of another size than " +
                 std::to_string(source.words) + "; the controller's " + std::string(source.type->name) + " needs it";
    }
  }
  auto program = make_program(node.description);
  if (program.ok()) {
    program_ = std::move(program).value();
    resident_.begin(program_, {.beat_ns = kBeat_ns, .settle_ns = kSettle, .told = mailbox::kTold});
  } else {
    trouble_ = who + program.error().message;
  }
}

std::string Wiring::trouble_of_node() const {
  if (!trouble_.empty()) return trouble_;
  if (node_ == nullptr) {
    return calibration_.node == 0 ? "no node '" + kNodeName + "' is there"
                                  : "node " + std::to_string(calibration_.node) + " is not there";
  }
  if (!node_->ready() || node_->generation != generation_)
    return "node " + std::to_string(node_->id) + " is " + aseba::node_state_name(node_->state);
  return "";
}

std::string Wiring::needed_trouble() const {
  const std::string trouble = trouble_of_node();
  return trouble.empty() && !running() ? "its program does not run yet" : trouble;
}

std::vector<aseba::NodeStatus> Wiring::nodes() const {
  return {status_of(node_, kNodeName, true, needed_trouble(), times_wired_)};
}

void Wiring::identify(RobotIdentity& identity) const {
  if (!ready()) return;
  identity.name = node_->description.name;
  identity.address = "node " + std::to_string(node_->id);
  const auto told = [this](std::string_view name) -> std::optional<std::string> {
    const aseba::Variable* const variable = node_->description.variable(name);
    if (variable == nullptr || node_->taken_ns(variable->address) == 0) return std::nullopt;
    return std::to_string(node_->value(variable->address));
  };
  if (const auto version = told(kFirmware)) identity.firmware = "firmware " + *version;
}

// --- the program ---

bool Wiring::serve(TimeNs now) noexcept {
  if (!ready()) return false;
  if (observe_) {
    hold(now);
    return false;
  }
  hear_program(now);
  const std::uint64_t loads = resident_.loads();
  const bool due = resident_.pursue(network_, *node_, now);
  note_loads(loads);
  return due;
}

/// Looks at a mailbox that was read since the last look.
void Wiring::hear_program(TimeNs now) noexcept {
  const aseba::Variable* const product = node_->description.variable("_productId");
  if (product != nullptr && node_->taken_ns(product->address) != 0 && node_->value(product->address) != kProduct) {
    trouble_ = "node " + std::to_string(node_->id) + ": its product number is " +
               std::to_string(node_->value(product->address)) + ", a Thymio II has " + std::to_string(kProduct);
    return;
  }
  const aseba::ResidentProgram::Heard heard = resident_.hear(*node_);
  if (heard.taken_ns == 0) return;
  if (heard.began) now_runs(now);
  if (resident_.running() && heard.ours) hold(heard.taken_ns);
  statistics_.lapses += heard.lapsed ? 1 : 0;
  if (heard.lapsed && drives_) {  // else the hub has stopped it already, and said so
    restarted_ =
        "it heard nothing for " + std::to_string(calibration_.alive_ns / hal::kNsPerMs) + " ms and stopped by itself";
  }
  if (heard.gone) {
    ++statistics_.restarts;
    restarted_ = "its program is gone: it restarted, or somebody else has loaded another";
  }
  if (heard.absent) load_program(now);
}

void Wiring::now_runs(TimeNs now) noexcept {
  believed_from_ns_ = resident_.heard_ns();
  told_ = {};
  leds_.told_ns = tone_.told_ns = 0;
  leds_.number = mail(mailbox::kShown);
  tone_.number = mail(mailbox::kPlayed);
  ++rest_version_;
  ask(now);
}

/// It begins with a reset, which stops the robot.
void Wiring::load_program(TimeNs now) noexcept {
  const std::uint64_t loads = resident_.loads();
  resident_.load(network_, *node_, now);
  note_loads(loads);
}

void Wiring::note_loads(std::uint64_t before) noexcept {
  if (resident_.loads() == before) return;
  ++statistics_.programs;
  ++rest_version_;
}

// --- readings ---

TimeNs Wiring::believed_ns(std::size_t address, std::size_t count) const noexcept {
  if (!running()) return 0;
  if (address + count > held_ns_.size()) return 0;
  const auto first = held_ns_.begin() + static_cast<std::ptrdiff_t>(address);
  const TimeNs oldest = *std::min_element(first, first + static_cast<std::ptrdiff_t>(count));
  return oldest >= believed_from_ns_ ? oldest : 0;
}

/// Keeps what was read by then: newer words may be those of a robot that was reset meanwhile.
void Wiring::hold(TimeNs until) noexcept {
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (node_->image.taken_ns[i] > until) continue;
    held_[i] = node_->image.values[i];
    held_ns_[i] = node_->image.taken_ns[i];
  }
}

template <class Port>
TimeNs Wiring::taken_ns() const noexcept {
  TimeNs oldest = std::numeric_limits<TimeNs>::max();
  for (const Source& source : sources_) {
    if (source.type != &hal::port_type<Port>()) continue;
    oldest = std::min(oldest, source.bound ? believed_ns(source.address, source.words) : 0);
  }
  return oldest;
}

/// Of all variables that feed the port, one after the other.
template <class Port>
std::span<const std::int16_t> Wiring::words_of() noexcept {
  std::size_t count = 0;
  for (const Source& source : sources_) {
    if (source.type != &hal::port_type<Port>()) continue;
    std::ranges::copy(std::span<const std::int16_t>(held_).subspan(source.address, source.words),
                      gathered_.begin() + static_cast<std::ptrdiff_t>(count));
    count += source.words;
  }
  return std::span<const std::int16_t>(gathered_).first(count);
}

/// What was read stays, and grows old, while the robot is not there.
template <class Port, class Fill>
void Wiring::fill_port(TimeNs now, Fill&& fill) noexcept {
  if (!robot_.uses<Port>()) return;
  Port& port = robot_.port<Port>();
  const TimeNs taken = taken_ns<Port>();
  if (taken != 0) {
    fill(port, words_of<Port>());
    robot_.stamp(port, taken, 0, now);
  } else if (port.validity != hal::Validity::Absent) {
    robot_.stamp(port, port.taken_ns + robot_.settings().origin_ns, 0, now);
  }
}

void Wiring::fill(TimeNs now) noexcept {
  note_firmware();
  fill_wheels(now);
  fill_port<hal::Proximity>(now, [this](hal::Proximity& port, std::span<const std::int16_t> words) {
    port.count = static_cast<std::uint32_t>(words.size());
    for (std::size_t i = 0; i < words.size(); ++i)
      port.distance_m[i] = static_cast<float>(hal::distance_m_of(response_, words[i]));
  });
  fill_port<hal::Ground>(now, [this](hal::Ground& port, std::span<const std::int16_t> words) {
    port.count = static_cast<std::uint32_t>(words.size());
    for (std::size_t i = 0; i < words.size(); ++i)
      port.reflectance[i] = static_cast<float>(reflectance(words[i], calibration_.white));
  });
  fill_port<hal::Accelerometer>(now, [](hal::Accelerometer& port, std::span<const std::int16_t> words) {
    port.force_m_s2 = {static_cast<float>(acceleration_m_s2(words[1])),
                       static_cast<float>(-acceleration_m_s2(words[0])),
                       static_cast<float>(acceleration_m_s2(words[2]))};
  });
  fill_port<hal::Microphones>(now, [](hal::Microphones& port, std::span<const std::int16_t> words) {
    port.count = 1;
    port.level[0] = static_cast<float>(sound_level(words[0]));
  });
  fill_port<hal::Buttons>(now, [](hal::Buttons& port, std::span<const std::int16_t> words) {
    port.count = static_cast<std::uint32_t>(words.size());
    for (std::size_t i = 0; i < words.size(); ++i) port.pressed[i] = words[i] != 0;
  });
}

void Wiring::fill_wheels(TimeNs now) noexcept {
  if (!robot_.uses<hal::WheelEncoders>()) return;
  auto& port = robot_.port<hal::WheelEncoders>();
  const TimeNs taken = std::min(believed_ns(program_.motors.left_speed), believed_ns(program_.motors.right_speed));
  if (taken == 0) {
    if (!running()) wheels_ns_ = 0;
    if (port.validity != hal::Validity::Absent) robot_.stamp(port, port.taken_ns + robot_.settings().origin_ns, 0, now);
    return;
  }
  if (taken != wheels_ns_) {
    const double left_m_s = motor_m_s(held_[program_.motors.left_speed], calibration_.full_m_s);
    const double right_m_s = motor_m_s(held_[program_.motors.right_speed], calibration_.full_m_s);
    const TimeNs since = taken - wheels_ns_;
    if (wheels_ns_ != 0 && since > 0 && since <= kLongestRoll) {
      port.left_m += 0.5 * (left_m_s_ + left_m_s) * hal::to_seconds(since);
      port.right_m += 0.5 * (right_m_s_ + right_m_s) * hal::to_seconds(since);
    }
    wheels_ns_ = taken;
    left_m_s_ = left_m_s;
    right_m_s_ = right_m_s;
    port.left_m_s = static_cast<float>(left_m_s);
    port.right_m_s = static_cast<float>(right_m_s);
  }
  robot_.stamp(port, taken, 0, now);
}

void Wiring::ask(TimeNs /*now*/) noexcept {
  if (!ready()) return;
  const auto want = [this](std::size_t address, std::size_t count) { (void)network_.want(node_->id, address, count); };
  for (const std::uint16_t address : {program_.motors.left_target, program_.motors.right_target,
                                      program_.motors.left_speed, program_.motors.right_speed})
    want(address, 1);
  want(program_.mailbox, mailbox::kTold);
  for (const Source& source : sources_) {
    if (source.bound && robot_.uses(*source.type)) want(source.address, source.words);
  }
  for (const std::string_view once : {std::string_view("_productId"), kFirmware}) {
    const aseba::Variable* const variable = node_->description.variable(once);
    if (variable != nullptr && node_->taken_ns(variable->address) == 0) want(variable->address, 1);
  }
}

/// The version comes once, some time after the rest.
void Wiring::note_firmware() noexcept {
  if (firmware_told_ || !ready()) return;
  const aseba::Variable* const version = node_->description.variable(kFirmware);
  firmware_told_ = version != nullptr && node_->taken_ns(version->address) != 0;
  rest_version_ += firmware_told_ ? 1 : 0;
}

TimeNs Wiring::oldest_ns() const noexcept {
  if (!ready()) return 0;
  TimeNs oldest = mail_taken_ns();
  for (const std::uint16_t address : {program_.motors.left_target, program_.motors.right_target,
                                      program_.motors.left_speed, program_.motors.right_speed})
    oldest = std::min(oldest, node_->taken_ns(address));
  for (const Source& source : sources_) {
    if (source.bound && robot_.uses(*source.type))
      oldest = std::min(oldest, node_->taken_ns(source.address, source.words));
  }
  return observe_ || oldest >= believed_from_ns_ ? oldest : 0;
}

// --- commands ---

/// The motors rest, whatever program runs.
bool Wiring::write_targets() noexcept {
  constexpr std::array<std::int16_t, 1> kRest = {0};
  const bool left = network_.write(node_->id, program_.motors.left_target, kRest);
  return network_.write(node_->id, program_.motors.right_target, kRest) && left;
}

void Wiring::command(bool drive, TimeNs now) noexcept {
  if (observe_) return;
  drives_ = drive && running();
  if (!running()) return;
  write_drive(drive, now);
  write_leds(drive, now);
  write_tone(drive, now);
}

/// While it drives, every commit says that the hub is there.
void Wiring::write_drive(bool drive, TimeNs now) noexcept {
  std::array<std::int16_t, 3> words{};
  if (drive && robot_.uses<hal::WheelSpeeds>()) {
    const auto& wheels = robot_.port<hal::WheelSpeeds>();
    words = {static_cast<std::int16_t>(std::max<TimeNs>(1, calibration_.alive_ns / kBeat_ns)),
             motor_target(wheels.left_m_s, calibration_.full_m_s),
             motor_target(wheels.right_m_s, calibration_.full_m_s)};
  }
  const bool alive = words[0] != 0;
  if (!alive && told_.drive_ns != 0 && words == told_.drive) return;
  if (!write_mail(mailbox::kAlive, words)) return;
  told_.drive = words;
  told_.drive_ns = now;
}

void Wiring::write_leds(bool drive, TimeNs now) noexcept {
  if (!program_.lights || !robot_.uses<hal::RingLeds>()) return;
  std::array<std::int16_t, kLedWords> words{};
  const auto& leds = robot_.port<hal::RingLeds>();
  for (std::size_t i = 0; drive && i < hal::thymio::kCircleLeds; ++i) words[i] = yellow_lamp(leds.color(i));
  std::size_t at = hal::thymio::kCircleLeds;
  for (const std::size_t led : {hal::thymio::kBottomLeft, hal::thymio::kBottomRight, hal::thymio::kTop}) {
    const hal::Rgb color = drive ? leds.color(led) : hal::kBlack;
    for (const std::uint8_t channel : {color.r, color.g, color.b}) words[at++] = lamp(channel);
  }
  write_block(leds_, words, now);
}

void Wiring::write_tone(bool drive, TimeNs now) noexcept {
  if (!program_.sounds || !robot_.uses<hal::Speaker>()) return;
  const std::int16_t hz = drive ? whole_hz(robot_.port<hal::Speaker>().tone_Hz) : std::int16_t{0};
  const std::array<std::int16_t, 2> words = {hz, static_cast<std::int16_t>(hz > 0 ? 0 : -1)};
  write_block(tone_, words, now);
}

template <std::size_t n>
void Wiring::write_block(Block<n>& block, const std::array<std::int16_t, n>& words, TimeNs now) noexcept {
  const bool changed = block.told_ns == 0 || words != block.words;
  const bool lost = !changed && mail_taken_ns() > block.told_ns && now - block.told_ns >= kShowAgain &&
                    mail(block.done_word) != block.number;
  if (!changed && !lost) return;
  statistics_.not_shown += lost ? 1 : 0;
  std::array<std::int16_t, 1 + n> numbered{};
  numbered[0] = static_cast<std::int16_t>((block.number + 1) & 0x7FFF);
  std::ranges::copy(words, numbered.begin() + 1);
  if (!write_mail(block.number_word, numbered)) return;
  block.words = words;
  block.number = numbered[0];
  block.told_ns = now;
}

void Wiring::rest(TimeNs now) noexcept {
  drives_ = false;
  if (observe_ || !ready()) return;
  told_.drive_ns = leds_.told_ns = tone_.told_ns = 0;
  command(false, now);
  // A link that was lost and is back has perhaps not been heard of yet, and the program may go on.
  if (!running() && resident_.ran()) (void)write_mail(mailbox::kAlive, std::array<std::int16_t, 3>{});
  (void)write_targets();
  (void)network_.want(node_->id, program_.mailbox, mailbox::kTold);
  (void)network_.want(node_->id, program_.motors.left_target, 1);
  (void)network_.want(node_->id, program_.motors.right_target, 1);
}

bool Wiring::rests() const noexcept {
  if (observe_) return true;
  if (!ready() || resident_.state() == aseba::ResidentProgram::State::Unknown) return false;
  for (const std::uint16_t target : {program_.motors.left_target, program_.motors.right_target}) {
    if (node_->taken_ns(target) <= rested_ns_ || node_->value(target) != 0) return false;
  }
  // Where no program runs, none sets the targets.
  if (!resident_.running()) return true;
  return mail_taken_ns() > rested_ns_ && mail(mailbox::kAlive) == 0 && mail(mailbox::kLeft) == 0 &&
         mail(mailbox::kRight) == 0;
}

std::vector<aseba::RestMessage> Wiring::rest_messages() const {
  std::vector<aseba::RestMessage> all;
  if (node_ == nullptr || !trouble_.empty() || program_.words.empty()) return all;
  const auto set = [&](std::size_t address, std::size_t count) {
    constexpr std::array<std::int16_t, 3> kRest{};
    all.push_back(*rest_message(*node_, address, std::span(kRest).first(count), true));
  };
  if (resident_.running() || resident_.ran()) set(program_.mailbox + std::size_t{mailbox::kAlive}, 3);
  set(program_.motors.left_target, 1);
  set(program_.motors.right_target, 1);
  return all;
}

}  // namespace tandem::bridges::thymio
