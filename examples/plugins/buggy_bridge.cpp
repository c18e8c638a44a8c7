// The bridge to a real buggy: a thread of its own talks to it, so that nobody waits for it; and its stopper, which runs
// in the guardian process when the hub is gone.
#include <array>
#include <charconv>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "bridges/bridge_type.hpp"
#include "bridges/bridged_robot.hpp"
#include "bridges/guardian/stopper.hpp"
#include "bridges/link/device.hpp"
#include "bridges/link/link_text.hpp"
#include "buggy.hpp"
#include "hal/device/wheels.hpp"

namespace buggy {
namespace {

using namespace tandem;
using bridges::ByteLink;
using hal::kNsPerMs;
using hal::TimeNs;

constexpr TimeNs kAsk = 50 * kNsPerMs;  // an answer comes within
constexpr TimeNs kSay = 20 * kNsPerMs;  // from one to the next line

/// What one "E" line says.
struct Answer {
  double left_m = 0.0, right_m = 0.0, left_m_s = 0.0, right_m_s = 0.0;
  bool rests() const noexcept { return left_m_s == 0.0 && right_m_s == 0.0; }
};

/// Lines to and from the robot.
class Conversation {
 public:
  explicit Conversation(std::unique_ptr<ByteLink> link) : link_(std::move(link)) {}

  bool open() const noexcept { return link_->state() == bridges::LinkState::Open; }
  void say(double left_m_s, double right_m_s) noexcept {
    const std::string line =
        "V " + std::to_string(std::lround(1e3 * left_m_s)) + " " + std::to_string(std::lround(1e3 * right_m_s)) + "\n";
    link_->write({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, 10 * kNsPerMs);
  }
  /// Waits at most so long. @returns whether a whole and plausible line came; the answer is then the newest.
  bool listen(TimeNs timeout_ns, Answer& answer) noexcept {
    bool any = false;
    link_->wait(timeout_ns);
    std::array<std::uint8_t, 256> bytes;
    const bridges::Received received = link_->read(bytes);
    for (std::size_t i = 0; i < received.size; ++i) {
      if (bytes[i] != '\n') {
        if (line_.size() < 64) line_ += static_cast<char>(bytes[i]);
        continue;
      }
      any = read(answer) || any;
      line_.clear();
    }
    return any;
  }

 private:
  bool read(Answer& answer) const noexcept {
    if (!line_.starts_with("E")) return false;
    std::array<long, 4> mm{};
    const char* at = line_.data() + 1;
    const char* const end = line_.data() + line_.size();
    for (long& value : mm) {
      while (at < end && *at == ' ') ++at;
      const auto [past, error] = std::from_chars(at, end, value);
      if (error != std::errc{}) return false;
      at = past;
    }
    answer = {1e-3 * static_cast<double>(mm[0]), 1e-3 * static_cast<double>(mm[1]), 1e-3 * static_cast<double>(mm[2]),
              1e-3 * static_cast<double>(mm[3])};
    return true;
  }

  std::unique_ptr<ByteLink> link_;
  std::string line_;
};

hal::Result<bridges::LinkOpener> opener_of(const std::string& link, const bridges::LinkTerms& terms) {
  const auto address = bridges::parse_link(link);
  if (!address.ok()) return address.error();
  if (address.value().rate != kBaud)
    return hal::Error{"a buggy talks with 9600 baud: write serial:DEVICE@9600, not '" + link + "'"};
  return bridges::byte_link_opener(address.value(), terms);
}

class BuggyBridge final : public bridges::RobotBridge {
 public:
  BuggyBridge(const bridges::BridgeRequest& request, bridges::LinkOpener opener)
      : request_(request), opener_(std::move(opener)), robot_(kName, kind(), settings_of(request), types()) {}
  ~BuggyBridge() override { BuggyBridge::shut_down(); }
  BuggyBridge(const BuggyBridge&) = delete;
  BuggyBridge& operator=(const BuggyBridge&) = delete;

  hal::Robot& robot() noexcept override { return robot_; }
  void* port(const hal::PortType& type) noexcept override { return robot_.find(type); }
  std::vector<bridges::PortView> taken() const override { return robot_.taken(); }
  void set_origin(TimeNs origin_ns) noexcept override { robot_.set_origin(origin_ns); }

  void start() override {
    thread_ = std::thread([this] { run(); });
  }
  void shut_down() override {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  // --- the loop's thread ---
  void latch(hal::Tick, TimeNs now) noexcept override {
    const std::lock_guard lock(mutex_);
    auto& encoders = robot_.port<hal::WheelEncoders>();
    encoders.left_m = answer_.left_m;
    encoders.right_m = answer_.right_m;
    encoders.left_m_s = static_cast<float>(answer_.left_m_s);
    encoders.right_m_s = static_cast<float>(answer_.right_m_s);
    robot_.stamp(encoders, answered_ns_, kAsk, now);
    health_ = answered_ns_ == 0                             ? bridges::LinkHealth::Connecting
              : now - answered_ns_ < 4 * kAsk               ? bridges::LinkHealth::Active
              : now - answered_ns_ < request_.lost_after_ns ? bridges::LinkHealth::Suspect
                                                            : bridges::LinkHealth::Lost;
  }
  void commit(TimeNs now) noexcept override {
    robot_.limit_commands([](const hal::Limited&) {});
    const std::lock_guard lock(mutex_);
    committed_ns_ = now;
    if (!stopped_) wanted_ = robot_.port<hal::WheelSpeeds>();
  }
  void stop(TimeNs) noexcept override {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    wanted_ = {};
    at_rest_ = false;
  }
  void resume() noexcept override {
    const std::lock_guard lock(mutex_);
    stopped_ = false;
  }

  // --- any thread ---
  bridges::LinkHealth health() const noexcept override {
    const std::lock_guard lock(mutex_);
    return health_;
  }
  bool at_rest() const noexcept override {
    const std::lock_guard lock(mutex_);
    return stopped_ && at_rest_;
  }
  std::string trouble() const override {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }
  std::string advice() const override { return "is it switched on, and its cable in?"; }
  bridges::RobotIdentity identity() const override {
    const std::lock_guard lock(mutex_);
    return reached_;  // a buggy tells nothing of itself
  }
  bridges::StopMessages stop_messages() const override {
    return {.robot = request_.robot,
            .kind = std::string(kName),
            .link = bridges::absolute_link(request_.link),
            .body = "",
            .version = stop_version(),
            .identity = identity()};
  }
  std::uint64_t stop_version() const noexcept override {
    const std::lock_guard lock(mutex_);
    return 1 + reached_.session;
  }
  bridges::LinkReport report() const override {
    const std::lock_guard lock(mutex_);
    return report_;
  }
  void describe(bridges::StatusVisitor& visitor) const override { visitor.text("state", trouble()); }

 private:
  static bridges::RobotSettings settings_of(const bridges::BridgeRequest& request) {
    bridges::RobotSettings settings;
    settings.id = request.robot;
    settings.kind = request.robot_kind;
    settings.seed = request.seed;
    settings.tick_ns = request.tick_ns;
    settings.sensors = request.sensors;
    settings.actuators = request.actuators;
    return settings;
  }
  static std::span<const hal::PortType* const> types() {
    static const auto all = bridges::port_types_of<hal::WheelSpeeds, hal::WheelEncoders>();
    return all;
  }

  bool ending() const {
    const std::lock_guard lock(mutex_);
    return ending_;
  }
  void run() {
    while (!ending()) {
      auto opened = opener_();
      std::unique_lock lock(mutex_);
      trouble_ = opened.ok() ? "" : opened.error().message;
      if (!opened.ok()) {
        changed_.wait_for(lock, std::chrono::milliseconds(500), [this] { return ending_; });
        continue;
      }
      reached_.link = bridges::absolute_link(request_.link);
      reached_.device = bridges::device_at(request_.link);
      ++reached_.session;
      lock.unlock();
      Conversation robot(std::move(opened).value());
      while (!ending() && robot.open()) talk(robot);
      if (ending()) say_farewell(robot);
    }
  }
  void talk(Conversation& robot) noexcept {
    hal::WheelSpeeds say;
    bool stopping = false;
    {
      const std::lock_guard lock(mutex_);
      const bool obeyed = bridges::monotonic_ns() - committed_ns_ < request_.lost_after_ns;  // else the loop hangs
      if (obeyed) say = wanted_;
      stopping = stopped_;
      ++report_.questions;
    }
    robot.say(say.left_m_s, say.right_m_s);
    Answer answer;
    const bool answered = robot.listen(kAsk, answer);
    std::unique_lock lock(mutex_);
    if (!answered) {
      ++report_.time_outs;
      return;
    }
    ++report_.answers;
    answer_ = answer;
    answered_ns_ = bridges::monotonic_ns();
    at_rest_ = stopping && stopped_ && answer.rests();
    changed_.wait_for(lock, std::chrono::nanoseconds(kSay), [this] { return ending_; });
  }
  static void say_farewell(Conversation& robot) noexcept {
    Answer answer;
    for (int i = 0; i < 10; ++i) {
      robot.say(0.0, 0.0);
      if (robot.listen(kAsk, answer) && answer.rests()) return;
    }
  }

  const bridges::BridgeRequest request_;
  const bridges::LinkOpener opener_;
  bridges::BridgedRobot robot_;
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  hal::WheelSpeeds wanted_;
  Answer answer_;
  TimeNs answered_ns_ = 0, committed_ns_ = 0;
  bridges::LinkHealth health_ = bridges::LinkHealth::Connecting;
  bridges::LinkReport report_;
  bridges::RobotIdentity reached_;
  std::string trouble_;
  bool stopped_ = false, at_rest_ = false, ending_ = false;
  std::thread thread_;
};

// --- in the guardian process ---

class BuggyStopper final : public bridges::guardian::Stopper {
 public:
  explicit BuggyStopper(std::string link) : link_(std::move(link)) {}
  bridges::guardian::StopState step(TimeNs) override {
    if (robot_ == nullptr) {
      const auto opener = opener_of(link_, {.permit = {}, .beside = true});
      auto opened = opener.ok() ? opener.value()() : opener.error();
      if (!opened.ok()) {
        trouble_ = opened.error().message;
        return bridges::guardian::StopState::Unreachable;
      }
      robot_ = std::make_unique<Conversation>(std::move(opened).value());
    }
    robot_->say(0.0, 0.0);
    Answer answer;
    const bool answered = robot_->listen(40 * kNsPerMs, answer);
    if (!robot_->open()) robot_.reset();
    trouble_ = answered ? "it still moves" : "it does not answer";
    if (!answered) return bridges::guardian::StopState::Unreachable;
    return answer.rests() ? bridges::guardian::StopState::Confirmed : bridges::guardian::StopState::Stopping;
  }
  std::string trouble() const override { return trouble_; }

 private:
  std::string link_, trouble_;
  std::unique_ptr<Conversation> robot_;
};

hal::Status check(const bridges::BridgeRequest& request) {
  const auto opener = opener_of(request.link, {});
  return opener.ok() ? hal::Status{} : hal::Status{opener.error()};
}

const bridges::BridgeType kBridge{
    .name = kName,
    .summary = "serial:DEVICE@9600",
    .make = [](const bridges::BridgeRequest& request, const hal::Log&) -> bridges::MadeBridge {
      auto opener = opener_of(request.link, {.permit = request.permit});
      if (!opener.ok()) return opener.error();
      return std::unique_ptr<bridges::RobotBridge>(std::make_unique<BuggyBridge>(request, std::move(opener).value()));
    },
    .check = &check};

const bridges::guardian::StopperType kStopper{
    kName,
    [](const bridges::StopMessages& messages, bridges::guardian::StopCause)
        -> std::unique_ptr<bridges::guardian::Stopper> { return std::make_unique<BuggyStopper>(messages.link); }};

}  // namespace

void register_bridge(hal::Registrar& registrar) {
  registrar.add(kBridge);
  registrar.add(kStopper);
}

}  // namespace buggy
