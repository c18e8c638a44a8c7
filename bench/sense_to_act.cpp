// Latency from an eye-bot's state report to the command that answers it, over LCM. Emulated robots report 50 times a
// second, and each is driven by a bridge that answers every report with another velocity; both sides share this machine
// and its multicast on the loopback, not their threads or sockets. Times are taken by the emulated robots: from when a
// report was handed to the system until the next command was received.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <fmt/format.h>
#include <memory>
#include <mutex>
#include <sched.h>
#include <thread>
#include <vector>

#include "app/exit_code.hpp"
#include "bench/bench.hpp"
#include "bridges/eyebot/driver.hpp"
#include "bridges/eyebot_emulator/emulator.hpp"
#include "bridges/lcm/lcm_link.hpp"
#include "hal/device/flight.hpp"

namespace tandem::bench {
namespace {

namespace bridge = bridges::eyebot;
namespace emulator = bridges::eyebot_emulator;
using bridges::EventField;
using bridges::EventFields;
using bridges::lcm_bus::LcmLink;
using bridges::lcm_bus::LcmMessage;

struct Asked {
  std::int64_t robots = 20;
  double seconds = 5.0;  ///< that are timed, once all robots fly
};

/// A network of its own, so that nobody else's robots are flown.
constexpr const char* kUrl = "udpm://239.255.76.68:7668?ttl=0";
constexpr auto kPatience = std::chrono::seconds(20);

template <class T>
const T* value_of(const EventFields& fields, std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const EventField& f) { return f.name == name; });
  return found == fields.end() ? nullptr : std::get_if<T>(&found->value);
}

/// Takes the robots' own times out of what they tell of themselves.
class Witness {
 public:
  void note(hal::TimeNs at, std::string_view event, const EventFields& fields) {
    const std::lock_guard lock(guard_);
    if (event == "mode" && *value_of<std::string>(fields, "to") == "velocity") {
      ++flying_;
      changed_.notify_all();
    }
    if (event != "command" || !timing_ || *value_of<std::string>(fields, "channel") != "cmd/velocity") return;
    ++commands_;
    refused_ += *value_of<std::string>(fields, "verdict") == "ok" ? 0 : 1;
    if (*value_of<bool>(fields, "first")) times_ns_.push_back(at - *value_of<std::int64_t>(fields, "state_sent_ns"));
  }
  bool wait_flying(std::int64_t robots) {
    std::unique_lock lock(guard_);
    return changed_.wait_for(lock, kPatience, [&] { return flying_ >= robots; });
  }
  void set_timing(bool timing) {
    const std::lock_guard lock(guard_);
    timing_ = timing;
  }

  // Once nobody notes any more.
  std::int64_t commands() const { return commands_; }
  std::int64_t refused() const { return refused_; }
  std::vector<hal::TimeNs>& times_ns() { return times_ns_; }

 private:
  std::mutex guard_;
  std::condition_variable changed_;
  std::int64_t flying_ = 0;
  bool timing_ = false;
  std::int64_t commands_ = 0;
  std::int64_t refused_ = 0;
  std::vector<hal::TimeNs> times_ns_;
};

/// Emulated robots on a thread of their own.
class Robots {
 public:
  Robots(std::int64_t count, Witness& witness) {
    options_.link = std::string("lcm:") + kUrl;
    options_.count = static_cast<int>(count);
    options_.events = [&witness](hal::TimeNs at, std::string_view event, const EventFields& fields) {
      witness.note(at, event, fields);
    };
    thread_ = std::thread([this] { ended_ = emulator::run(options_, stop_); });
  }
  ~Robots() { (void)end(); }
  Robots(const Robots&) = delete;
  Robots& operator=(const Robots&) = delete;

  hal::Status end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return ended_;
  }

 private:
  emulator::Options options_;
  std::atomic<bool> stop_{false};
  hal::Status ended_;
  std::thread thread_;
};

/// Bridge and controller of one robot. Everything happens on the link's thread, as messages come.
class Flown final : private bridge::Outbox {
 public:
  Flown(std::string name, std::int32_t session, LcmLink& link)
      : link_(link), driver_(settings(std::move(name), session), inbox_, *this) {
    hal::Robot& robot = driver_.robot();
    place_ = &robot.sensor<hal::Positioning>();
    task_ = &robot.actuator<hal::FlightTask>();
    speed_ = &robot.actuator<hal::QuadrotorSpeed>();
  }

  const std::string& name() const { return driver_.settings().name; }

  void hear(const LcmMessage& message) {
    const auto topic = bridge::topic_of(name(), message.channel);
    if (!topic) return;
    inbox_.deliver(*topic, message.data, message.received_ns);
    const hal::TimeNs now = bridges::lcm_bus::monotonic_ns();
    driver_.pump(now);
    if (*topic != bridge::Topic::State) return;
    driver_.latch(tick_++, now);
    step();
    driver_.commit(bridges::lcm_bus::monotonic_ns());
  }

 private:
  static bridge::DriverSettings settings(std::string name, std::int32_t session) {
    bridge::DriverSettings s;
    s.robot.id = std::move(name);
    s.robot.tick_ns = 20 * hal::kNsPerMs;
    s.session = session;
    return s;
  }
  /// Takes off, then pulls back to where it started while circling: another velocity in every tick.
  void step() {
    if (tick_ == 1) home_ = place_->p_WB;
    const bool up = rises_ && place_->p_WB[2] - home_[2] >= 0.9;
    if (up) rises_ = false;
    task_->order = rises_ ? hal::FlightOrder::TakeOff : hal::FlightOrder::Fly;
    const double angle_rad = 0.02 * static_cast<double>(tick_);
    const auto back = [&](std::size_t i) { return 0.5 * (home_[i] - place_->p_WB[i]); };
    speed_->set(back(0) + 0.2 * std::cos(angle_rad), back(1) + 0.2 * std::sin(angle_rad),
                0.5 * (home_[2] + 1.0 - place_->p_WB[2]), 0.0);
  }
  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept override {
    return link_.publish(channel, data);
  }

  LcmLink& link_;
  bridge::Inbox inbox_;
  bridge::EyebotDriver driver_;
  const hal::Positioning* place_;
  hal::FlightTask* task_;
  hal::QuadrotorSpeed* speed_;
  hal::Tick tick_ = 0;
  bool rises_ = true;
  std::array<double, 3> home_{};
};

/// From now on, for this thread and those that it makes.
hal::Status use_real_time() {
  sched_param parameter{};
  parameter.sched_priority = 10;
  if (::sched_setscheduler(0, SCHED_FIFO, &parameter) == 0) return {};
  return hal::Error{"SCHED_FIFO is not permitted: run it as root, or with CAP_SYS_NICE, or leave out --real-time"};
}

const char* scheduling_class() {
  const int policy = ::sched_getscheduler(0);
  return policy == SCHED_FIFO ? "SCHED_FIFO" : policy == SCHED_RR ? "SCHED_RR" : "SCHED_OTHER";
}

double at_share_us(const std::vector<hal::TimeNs>& sorted, double share) {
  const auto i = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size()))) - 1;
  return static_cast<double>(sorted[i]) / 1000.0;
}

void print(const Asked& c, Witness& witness) {
  auto& times = witness.times_ns();
  std::sort(times.begin(), times.end());
  print_line({{"bench", "sense_to_act"},
              {"robots", c.robots},
              {"rate_hz", static_cast<std::int64_t>(emulator::Eyebot::kStateRate_Hz)},
              {"seconds", c.seconds},
              {"scheduling", scheduling_class()},
              {"reports_answered", static_cast<std::int64_t>(times.size())},
              {"commands", witness.commands()},
              {"commands_refused", witness.refused()},
              {"p50_us", at_share_us(times, 0.5)},
              {"p99_us", at_share_us(times, 0.99)},
              {"max_us", at_share_us(times, 1.0)}});
}

hal::Status measure_once(const Asked& c, const std::atomic<bool>& stop) {
  Witness witness;
  Robots robots(c.robots, witness);
  auto opened = LcmLink::open(kUrl);
  if (!opened.ok()) return opened.error();
  std::vector<std::unique_ptr<Flown>> flown;  // outlives the link's thread
  const std::shared_ptr<LcmLink> link = std::move(opened).value();
  const auto names = emulator::names_of("eb0", static_cast<int>(c.robots));
  for (std::size_t i = 0; i < names.size(); ++i) {
    flown.push_back(std::make_unique<Flown>(names[i], static_cast<std::int32_t>(i + 1), *link));
  }
  for (const auto& one : flown) {
    const auto ready = link->subscribe("eyebot/" + one->name() + "/[a-z_]+",
                                       [robot = one.get()](const LcmMessage& m) { robot->hear(m); });
    if (!ready.ok()) return ready;
  }
  if (const hal::Status started = link->start(); !started.ok()) return started;
  if (!witness.wait_flying(c.robots)) {
    const hal::Status ended = robots.end();
    return ended.ok() ? hal::Error{"not all robots took off within 20 s"} : ended;
  }
  witness.set_timing(true);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(c.seconds);
  while (std::chrono::steady_clock::now() < end && !stop.load())
    std::this_thread::sleep_until(
        std::min<decltype(end)>(end, std::chrono::steady_clock::now() + std::chrono::milliseconds(100)));
  witness.set_timing(false);
  if (const hal::Status ended = robots.end(); !ended.ok()) return ended;
  if (witness.times_ns().empty()) return hal::Error{"no report was answered"};
  print(c, witness);
  return {};
}

}  // namespace

hal::Result<int> bench_sense_to_act(const Call& call) {
  constexpr std::int64_t kMostRobots = 100;
  for (const std::int64_t robots : call.options.robots_or({20})) {
    if (robots > kMostRobots) return refuse(app::kWrongUsage, fmt::format("at most {} eye-bots", kMostRobots));
    if (call.options.real_time) {
      if (const hal::Status permitted = use_real_time(); !permitted.ok()) return permitted.error();
    }
    for (std::int64_t i = 0; i < call.options.repeat && !call.stop.load(); ++i) {
      if (const hal::Status done = measure_once({robots, call.options.seconds}, call.stop); !done.ok())
        return done.error();
    }
  }
  return app::kDone;
}

}  // namespace tandem::bench
