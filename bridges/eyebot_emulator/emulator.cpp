#include "bridges/eyebot_emulator/emulator.hpp"

#include <algorithm>
#include <deque>
#include <mutex>
#include <random>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include "bridges/eyebot_emulator/faults.hpp"
#include "bridges/eyebot_emulator/register.hpp"
#include "hal/device/flight.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using hal::TimeNs;
using lcm_bus::LcmLink;
using lcm_bus::LcmMessage;

constexpr std::string_view kLcm = "lcm:";

std::int64_t unix_us() {
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000 + t.tv_nsec / 1000;
}

/// Not 0, which stands for nobody.
std::int32_t draw_session() {
  std::random_device chance;
  for (;;) {
    if (const auto session = static_cast<std::int32_t>(chance()); session != 0) return session;
  }
}

/// What the link's thread has heard, for the thread of the robots. The oldest are lost when there is too much.
class Inbox {
 public:
  Inbox() : wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  ~Inbox() { ::close(wake_); }
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  void put(const LcmMessage& message) {
    const std::lock_guard lock(guard_);
    if (messages_.size() == kMost) messages_.pop_front();
    messages_.push_back(
        {std::string(message.channel), {message.data.begin(), message.data.end()}, message.received_ns});
    ::eventfd_write(wake_, 1);
  }
  std::deque<Datagram> take() {
    eventfd_t count = 0;
    ::eventfd_read(wake_, &count);
    const std::lock_guard lock(guard_);
    return std::exchange(messages_, {});
  }
  int descriptor() const noexcept { return wake_; }

 private:
  static constexpr std::size_t kMost = 10000;
  int wake_;
  std::mutex guard_;
  std::deque<Datagram> messages_;
};

/// A robot with its body and what may go wrong with it.
struct Flyer {
  Flyer(const Eyebot::Options& options, const Start& start, const std::optional<Room>& room, EmulatedBody* body,
        FaultPlan plan, EventSink sink)
      : own_body(start, room),
        robot(options, body != nullptr ? *body : own_body, std::move(sink)),
        faults(std::move(plan)) {}

  PointBody own_body;
  Eyebot robot;
  FaultPlan faults;
  std::deque<Datagram> to_robot;
  std::deque<Datagram> to_hub;
};

/// What another hub says that takes the robot for its own: its heartbeat, and lights.
struct SecondHub {
  std::int32_t session = draw_session();
  std::int32_t seq = 0;
  TimeNs begun_at = 0;
  TimeNs next_at = 0;
};

class EyebotServer final : public Server {
 public:
  EyebotServer(const Options& options, EventSink tell, const std::vector<Fault>& faults);

 private:
  hal::Status begin() override;
  hal::Status turn(TimeNs now) override;
  TimeNs next_wake(TimeNs now) const override;
  void add_polls(TimeNs now, std::vector<pollfd>& polls) const override;
  void end(TimeNs now, const hal::Status& served) override;

  hal::Status connect();
  /// The robots, then their namesakes.
  std::vector<Flyer*> everybody() const {
    std::vector<Flyer*> all;
    for (const auto* crew : {&flyers_, &namesakes_}) {
      for (const auto& flyer : *crew) {
        if (flyer) all.push_back(flyer.get());
      }
    }
    return all;
  }
  void distribute();
  void apply_faults(std::size_t i, TimeNs now);
  void fly(Flyer& flyer, TimeNs now);
  void publish(Flyer& flyer, TimeNs now);
  void speak(SecondHub& hub, const std::string& robot, TimeNs now);
  std::unique_ptr<Flyer> make_flyer(const std::string& name, std::size_t i, std::vector<Fault> faults, EventSink sink);

  const Options& options_;
  std::shared_ptr<LcmLink> link_;
  std::shared_ptr<Inbox> inbox_ = std::make_shared<Inbox>();
  std::vector<std::unique_ptr<Flyer>> flyers_;
  std::vector<std::unique_ptr<Flyer>> namesakes_;      // of the flyer at the same place; none: null
  std::vector<std::optional<SecondHub>> second_hubs_;  // likewise
};

EyebotServer::EyebotServer(const Options& options, EventSink tell, const std::vector<Fault>& faults)
    : Server(std::move(tell)), options_(options) {
  const auto names = names_of(options.robot.name, options.count);
  for (std::size_t i = 0; i < names.size(); ++i) flyers_.push_back(make_flyer(names[i], i, faults, tell_));
  namesakes_.resize(flyers_.size());
  second_hubs_.resize(flyers_.size());
}

// Robots stand in rows of five, two metres apart.
std::unique_ptr<Flyer> EyebotServer::make_flyer(const std::string& name, std::size_t i, std::vector<Fault> faults,
                                                EventSink sink) {
  Eyebot::Options robot = options_.robot;
  robot.name = name;
  robot.session = draw_session();
  const Start start{{2.0 * static_cast<double>(i % 5), 2.0 * static_cast<double>(i / 5), 0.0}, 0.0};
  return std::make_unique<Flyer>(robot, start, options_.room, options_.body,
                                 FaultPlan(std::move(faults), options_.seed + i), std::move(sink));
}

hal::Status EyebotServer::connect() {
  link_ = options_.shared;
  if (!link_) {
    if (!options_.link.starts_with(kLcm)) {
      return hal::Error{"an eye-bot is reached over LCM: write --link lcm:udpm://239.255.76.67:7667?ttl=0, not '" +
                        options_.link + "'"};
    }
    auto opened = LcmLink::open(options_.link.substr(kLcm.size()));
    if (!opened.ok()) return opened.error();
    link_ = std::move(opened).value();
  }
  for (const char* channels : {"eyebot/[^/]+/cmd/[^/]+", "hub/[^/]+/heartbeat"}) {
    const auto subscribed =
        link_->subscribe(channels, [inbox = inbox_](const LcmMessage& message) { inbox->put(message); });
    if (!subscribed.ok()) return subscribed;
  }
  return link_->start();
}

hal::Status EyebotServer::begin() {
  if (const hal::Status connected = connect(); !connected.ok()) return connected;
  const TimeNs start = monotonic_ns();
  tell_(start, "start",
        {{"link", link_->url()},
         {"robots", flyers_.size()},
         {"clock", options_.robot.clock_synced ? "synced" : "unsynced"},
         {"utime", unix_us()},
         {"seed", options_.seed}});
  // They do not all speak at the same moment.
  constexpr TimeNs kApartNs = hal::kNsPerMs;
  for (std::size_t i = 0; i < flyers_.size(); ++i) {
    flyers_[i]->faults.begin(start);
    flyers_[i]->robot.power_on(start + static_cast<TimeNs>(i) * kApartNs,
                               unix_us() + static_cast<std::int64_t>(i) * kApartNs / 1000);
  }
  if (options_.ready) options_.ready(link_->url());
  return {};
}

void EyebotServer::end(TimeNs at, const hal::Status& /*served*/) {
  (void)turn(at);
  for (const auto& flyer : flyers_) {
    flyer->robot.tell_sent(at);
    const Supervisor& s = flyer->robot.supervisor();
    tell_(at, "end",
          {{"robot", flyer->robot.options().name},
           {"why", "stopped"},
           {"mode", name_of(s.mode())},
           {"failsafe", name_of(s.failsafe())},
           {"rejected", flyer->robot.rejected()}});
  }
}

hal::Status EyebotServer::turn(TimeNs now) {
  for (std::size_t i = 0; i < flyers_.size(); ++i) apply_faults(i, now);
  for (std::size_t i = 0; i < flyers_.size(); ++i) {
    if (second_hubs_[i]) speak(*second_hubs_[i], flyers_[i]->robot.options().name, now);
  }
  distribute();
  for (Flyer* flyer : everybody()) fly(*flyer, now);
  return {};
}

void EyebotServer::apply_faults(std::size_t i, TimeNs now) {
  Flyer& flyer = *flyers_[i];
  while (const auto change = flyer.faults.next_change(now)) {
    const Fault& fault = *change->fault;
    apply(*change, flyer.robot, draw_session());
    if (fault.kind == FaultKind::Namesake) {
      namesakes_[i] = change->begins ? make_flyer(flyer.robot.options().name, i + 1, {}, {}) : nullptr;
      if (namesakes_[i]) namesakes_[i]->robot.power_on(change->at, unix_us() - (monotonic_ns() - change->at) / 1000);
    }
    if (fault.kind == FaultKind::SecondHub) {
      second_hubs_[i].reset();
      if (change->begins) second_hubs_[i] = SecondHub{.begun_at = change->at, .next_at = change->at};
    }
    tell_(change->at, "fault",
          {{"robot", flyer.robot.options().name}, {"fault", fault.text}, {"phase", change->begins ? "begin" : "end"}});
  }
}

// A hub's sign of life is for everybody, a command for the robot that the channel names.
void EyebotServer::distribute() {
  for (const Datagram& message : inbox_->take()) {
    for (Flyer* flyer : everybody()) {
      const bool concerns = message.channel.starts_with("hub/") ||
                            message.channel.starts_with("eyebot/" + flyer->robot.options().name + "/");
      if (!concerns) continue;
      std::vector<Datagram> arriving;
      flyer->faults.to_robot(message, arriving);
      for (Datagram& d : arriving) {
        d.at += delay_ns(options_.robot.delays.to_robot_s);
        flyer->to_robot.push_back(std::move(d));
      }
    }
  }
}

void EyebotServer::fly(Flyer& flyer, TimeNs now) {
  take_due(flyer.to_robot, now, [&](const Datagram& d) { flyer.robot.receive(d.channel, d.data, d.at); });
  flyer.robot.run_until(now);
  if (const auto at = flyer.robot.first_driven_at()) flyer.faults.driven(*at, now);
  publish(flyer, now);
}

void EyebotServer::publish(Flyer& flyer, TimeNs now) {
  std::vector<Datagram> sent;
  flyer.robot.take_sent(sent);
  std::vector<Datagram> leaving;
  for (const Datagram& message : sent) flyer.faults.to_hub(message, leaving);
  for (Datagram& d : leaving) {
    d.at += delay_ns(options_.robot.delays.to_host_s);
    flyer.to_hub.push_back(std::move(d));
  }
  take_due(flyer.to_hub, now, [&](const Datagram& message) {
    if (message.channel.ends_with("/state")) flyer.robot.state_left(monotonic_ns());
    link_->publish(message.channel, message.data);
  });
}

void EyebotServer::speak(SecondHub& hub, const std::string& robot, TimeNs now) {
  for (; hub.next_at <= now; hub.next_at += kHeartbeatPeriod_ms * hal::kNsPerMs) {
    const Header header{unix_us(), hub.seq++, hub.session};
    const std::int64_t uptime_ms = (now - hub.begun_at) / hal::kNsPerMs;
    link_->publish("hub/second/heartbeat", write_heartbeat(header, "second", uptime_ms, true));
    link_->publish("eyebot/" + robot + "/cmd/leds", write_leds(header, Lights{}));
  }
}

TimeNs EyebotServer::next_wake(TimeNs now) const {
  TimeNs wake = now + kStopNs;
  for (const Flyer* flyer : everybody()) {
    wake = std::min({wake, flyer->robot.next_event(), first_at(flyer->to_robot, wake), first_at(flyer->to_hub, wake)});
    if (const auto change = flyer->faults.next_change_at()) wake = std::min(wake, *change);
  }
  return wake;
}

void EyebotServer::add_polls(TimeNs /*now*/, std::vector<pollfd>& polls) const {
  polls.push_back({inbox_->descriptor(), POLLIN, 0});
}

bool is_robot_name(const std::string& name) {
  constexpr std::size_t kLongest = 24;
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, fits);
}

}  // namespace

std::vector<std::string> names_of(const std::string& first, int count) {
  if (count == 1) return {first};
  std::size_t digits = 0;
  while (digits < std::min<std::size_t>(first.size(), 6) && std::isdigit(first[first.size() - 1 - digits]) != 0)
    ++digits;
  const std::string stem = first.substr(0, first.size() - digits);
  const int from = digits > 0 ? std::stoi(first.substr(stem.size())) : 0;
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(stem + std::to_string(from + i));
  return names;
}

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  constexpr int kMostRobots = 250;
  if (options.count < 1 || options.count > kMostRobots) {
    return hal::Error{"--count " + std::to_string(options.count) + ": from 1 to " + std::to_string(kMostRobots)};
  }
  if (options.body != nullptr && options.count > 1) return hal::Error{"one body is for one robot: leave out --count"};
  for (const std::string& name : names_of(options.robot.name, options.count)) {
    if (!is_robot_name(name)) {
      return hal::Error{"'" + name + "' cannot be an eye-bot's name: 1 to 24 letters, digits, _ and -"};
    }
  }
  return serve_with(options, kFaults, stop, [&](const EventSink& events, const std::vector<Fault>& faults) {
    return EyebotServer(options, events, faults);
  });
}

namespace {

const EmulatorType kType{
    .name = "eyebot",
    .kind = hal::eyebot::kName,
    .summary = "Eye-bots on a network: lcm:udpm://GROUP:PORT?ttl=0.",
    .puppet = "<eyebot_puppet library=\"puppet\" …> with flight_task, quadrotor_speed, flight_state and positioning",
    .needs = &port_types_of<hal::FlightTask, hal::QuadrotorSpeed, hal::FlightState, hal::Positioning>,
    .ports = &body_ports,
    .faults = [] { return kFaults.manual(); },
    .read = &read_options<Options>,
    .run = &run_emulator<Options, PortBody, run>};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::eyebot_emulator
