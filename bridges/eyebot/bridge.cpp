#include "bridges/eyebot/bridge.hpp"

#include <algorithm>
#include <random>

#include "bridges/eyebot/stop_body.hpp"
#include "bridges/eyebot_messages/codec.hpp"
#include "bridges/link/link_terms.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::bridges::eyebot {
namespace {

using hal::TimeNs;

constexpr TimeNs kLongestWait = 20 * hal::kNsPerMs;  // then deadlines and the end are looked at
constexpr TimeNs kOpenAgain = hal::kNsPerSecond;
constexpr TimeNs kMute = 3 * hal::kNsPerSecond;  // fifteen of our own heartbeats
// Numbers are for the hub and for its guardian by turns: newer is what lies less than 2^31 ahead.
constexpr std::uint32_t kTurn = 500'000'000;

BridgeSettings with_session(BridgeSettings settings) {
  while (settings.driver.session == 0) settings.driver.session = static_cast<std::int32_t>(std::random_device{}());
  return settings;
}

}  // namespace

EyebotBridge::EyebotBridge(BridgeSettings settings, LcmOpener opener, hal::Log log)
    : settings_(with_session(std::move(settings))),
      opener_(std::move(opener)),
      mail_(std::make_shared<Mail>()),
      driver_(settings_.driver, mail_->inbox, *this, std::move(log)) {}

EyebotBridge::~EyebotBridge() {
  shut_down();
}

/// Every interruption has it hover, also one that is over already.
Interruptions EyebotBridge::interruptions() const noexcept {
  const DriverStatistics& s = driver_.statistics();
  return {s.link_stops + s.watchdog_stops, driver_.liveness().restarts() + s.saved_itself};
}

bool EyebotBridge::publish(const std::string& channel, std::span<const std::byte> data) noexcept {
  return link_ && settings_.permit.granted_since(turn_) && link_->publish(channel, data);
}

// --- the thread ---

void EyebotBridge::run() {
  while (!ending_) {
    keep_link();
    TimeNs wait = 0;
    {
      const std::lock_guard lock(mutex_);
      const TimeNs now = lcm_bus::monotonic_ns();
      const RobotState before = driver_.state();
      driver_.pump(now);
      if (driver_.state() != before) changed_.notify_all();
      wait = std::clamp<TimeNs>(driver_.next_deadline() - now, 0, kLongestWait);
    }
    mail_->inbox.wait(wait);
  }
  run_shutdown();
}

/// Opening may take seconds: it is done without the lock, so that no loop waits for it.
void EyebotBridge::keep_link() {
  std::shared_ptr<lcm_bus::LcmLink> dead;  // ends after the lock
  {
    const std::lock_guard lock(mutex_);
    const TimeNs now = lcm_bus::monotonic_ns();
    if (link_ && !settings_.permit.granted_since(turn_)) {
      link_trouble_ = not_permitted().message;
      dead = std::move(link_);
    }
    const bool speaks = !settings_.driver.observe;
    const TimeNs heard_ns = std::max(opened_ns_, mail_->echo_ns.load(std::memory_order_relaxed));
    if (link_ && speaks && now - heard_ns > kMute) {
      link_trouble_ = "what is said at '" + link_->url() + "' does not come back: the network is gone";
      dead = std::move(link_);
    }
    if (dead) driver_.link_gone();
    if (link_ || (tried_ns_ != 0 && now - tried_ns_ < kOpenAgain)) return;
    tried_ns_ = now;
  }
  const std::uint32_t turn = settings_.permit.turn();
  auto opened = settings_.permit.granted_since(turn) ? open() : not_permitted();
  const std::lock_guard lock(mutex_);
  if (!opened.ok()) {
    link_trouble_ = opened.error().message;
    changed_.notify_all();
    return;
  }
  link_ = std::move(opened).value();
  if (links_opened_ > 0 && turn != turn_) {  // our guardian has used the numbers in between
    driver_.skip_ahead(2 * kTurn);
    ++withdrawals_;
  }
  turn_ = turn;
  link_trouble_.clear();
  opened_ns_ = lcm_bus::monotonic_ns();
  ++links_opened_;
}

hal::Result<std::shared_ptr<lcm_bus::LcmLink>> EyebotBridge::open() {
  auto opened = opener_();
  if (!opened.ok()) return opened;
  lcm_bus::LcmLink& link = *opened.value();
  const DriverSettings& driver = driver_.settings();
  const auto deliver = [mail = mail_, name = driver.name](const lcm_bus::LcmMessage& m) {
    if (const auto topic = topic_of(name, m.channel)) mail->inbox.deliver(*topic, m.data, m.received_ns);
  };
  const auto hubs = [mail = mail_, own = driver.hub](const lcm_bus::LcmMessage& m) {
    const std::string_view hub = hub_of(m.channel);
    if (hub == own) {
      mail->echo_ns.store(m.received_ns, std::memory_order_relaxed);
    } else if (const auto header = eyebot_messages::peek_header(m.data)) {
      mail->inbox.neighbours().hear_hub(hub, header->session);
    }
  };
  const auto commands = [mail = mail_, own = driver.session](const lcm_bus::LcmMessage& m) {
    const auto header = eyebot_messages::peek_header(m.data);
    if (header && header->session != own) mail->inbox.neighbours().hear_command(header->session, m.received_ns);
  };
  const auto robots = [mail = mail_](const lcm_bus::LcmMessage& m) {
    if (const std::string_view name = robot_of(m.channel); !name.empty()) mail->inbox.neighbours().hear_robot(name);
  };
  const std::array<std::pair<std::string, lcm_bus::LcmLink::Handler>, 4> all = {
      {{"eyebot/" + driver.name + "/[a-z_]+", deliver},
       {"hub/[^/]+/heartbeat", hubs},
       {"eyebot/" + driver.name + "/cmd/[a-z_]+", commands},
       {"eyebot/[^/]+/heartbeat", robots}}};
  for (const auto& [channels, handler] : all) {
    if (const hal::Status ready = link.subscribe(channels, handler); !ready.ok()) return ready.error();
  }
  if (const hal::Status ready = link.start(); !ready.ok()) return ready.error();
  return opened;
}

void EyebotBridge::run_shutdown() {
  ShutdownSequence sequence(settings_.shutdown);
  for (bool done = false; !done;) {
    {
      const std::lock_guard lock(mutex_);
      done = link_ == nullptr || sequence.step(driver_, lcm_bus::monotonic_ns());
    }
    if (!done) mail_->inbox.wait(kLongestWait);
  }
}

// --- the loop ---

void EyebotBridge::land(TimeNs now) noexcept {
  const std::lock_guard lock(mutex_);
  driver_.land(now);
}

// --- what is known ---

/// With the lock held. What a robot draws at its start is no word: the same robot draws another one at the next.
RobotIdentity EyebotBridge::who() const {
  RobotIdentity all;
  all.link = "lcm:" + settings_.url;
  all.session = links_opened_;
  if (links_opened_ > 0) all.device = all.link;
  if (driver_.liveness().pulse(lcm_bus::monotonic_ns()) != Pulse::Never) all.name = driver_.settings().name;
  return all;
}

StopMessages EyebotBridge::stop_messages() const {
  StopMessages messages{.robot = settings_.driver.robot.id,
                        .kind = std::string(hal::eyebot::kName),
                        .link = "lcm:" + settings_.url,
                        .body = to_stop_body(stop_details()),
                        .version = stop_version(),
                        .name = driver_.settings().name};
  messages.identity = identity();
  return messages;
}

std::uint64_t EyebotBridge::stop_version() const noexcept {
  const std::lock_guard lock(mutex_);
  const bool heard = driver_.liveness().pulse(lcm_bus::monotonic_ns()) != Pulse::Never;
  return 1 + withdrawals_.load(std::memory_order_relaxed) + links_opened_ + (heard ? 1U : 0U);
}

/// Orders alone are answered; the rest of what is said and heard is in `describe`.
LinkReport EyebotBridge::report() const {
  const std::lock_guard lock(mutex_);
  const OrderStatistics& orders = driver_.orders().statistics();
  LinkReport report;
  report.questions = orders.orders;
  report.answers = orders.accepted + orders.refused;
  report.time_outs = orders.unanswered;
  report.bad_answers = mail_->inbox.statistics().refused + driver_.statistics().not_understood;
  report.resynchronised = driver_.statistics().recovered;
  report.links_lost = driver_.statistics().lost;
  report.set(orders.round_trips);
  report.clock = driver_.clock().state(lcm_bus::monotonic_ns());
  return report;
}

void EyebotBridge::describe(StatusVisitor& visitor) const {
  const BridgeStatus s = status();
  visitor.text("state", state_name(s.state));
  visitor.text("mode", mode_name(s.flight.mode));
  visitor.flag("landed", s.landed);
  visitor.count("messages_in", s.messages.received);
  visitor.count("messages_out", s.driver.said);
  visitor.count("messages_lost", s.messages.lost);
  visitor.count("messages_old", s.messages.old);
  visitor.count("messages_replaced", s.messages.replaced);
  visitor.count("messages_refused", s.messages.refused + s.driver.not_understood);
  visitor.count("messages_unsent", s.driver.unsent);
  visitor.count("from_other_senders", s.other_senders);
  visitor.count("interruptions", s.driver.link_stops);
  visitor.count("stops_for_want_of_commands", s.driver.watchdog_stops);
  visitor.count("restarts", s.restarts);
  visitor.count("clock_jumps", s.clock_jumps);
  visitor.count("links_opened", s.links_opened);
  visitor.count("orders_said_again", s.orders.said_again);
  visitor.count("orders_refused", s.orders.refused);
  visitor.count("refused_for_another_hub", s.driver.refused_control);
  visitor.count("commands_clamped", s.driver.clamped);
  visitor.count("commands_not_finite", s.driver.not_finite);
}

BridgeStatus EyebotBridge::status() const {
  const std::lock_guard lock(mutex_);
  BridgeStatus status;
  status.state = driver_.state();
  status.trouble = any_trouble();
  status.link_trouble = link_trouble_;
  status.link = link_ ? "lcm:" + link_->url() : "";
  status.stopped = driver_.stopped();
  status.at_rest = driver_.at_rest();
  status.landed = driver_.landed();
  status.flight = driver_.status();
  status.name = driver_.settings().name;
  status.session = driver_.liveness().session();
  status.restarts = driver_.liveness().restarts();
  status.other_senders = driver_.liveness().others();
  status.controlled = driver_.controlled();
  status.clock_jumps = driver_.clock().jumps();
  status.driver = driver_.statistics();
  status.orders = driver_.orders().statistics();
  status.messages = mail_->inbox.statistics();
  for (std::size_t i = 0; i < kTopics; ++i) status.topics[i] = mail_->inbox.statistics(static_cast<Topic>(i));
  status.links_opened = links_opened_;
  return status;
}

StopDetails EyebotBridge::stop_details() const {
  const DriverSettings& driver = driver_.settings();  // does not change
  const std::uint32_t first_seq =
      static_cast<std::uint32_t>(driver.first_seq) + (2 * withdrawals_.load(std::memory_order_relaxed) + 1) * kTurn;
  return {settings_.url,
          driver.name,
          driver.hub,
          driver.session,
          settings_.shutdown.land,
          static_cast<std::int32_t>(first_seq)};
}

}  // namespace tandem::bridges::eyebot
