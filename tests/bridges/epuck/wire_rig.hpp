// Driver, serial line and emulated firmware in a time that the test moves: every byte takes its 87 microseconds, and
// may be lost on the way.
#pragma once
#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <vector>

#include "bridges/epuck/driver.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges::epuck {

inline constexpr hal::TimeNs kMs = hal::kNsPerMs;

/// A body that remembers when it was last asked what it senses, and how it is driven.
class WatchedBody final : public epuck_emulator::EmulatedBody {
 public:
  epuck_emulator::BodySenses sense(hal::TimeNs now) override {
    sensed_ns = now;
    return {};
  }
  void actuate(hal::TimeNs now, const epuck_emulator::BodyCommand& command) override {
    left_m_s = command.left_m_s;
    right_m_s = command.right_m_s;
    changed_ns = now;
  }
  bool moves() const { return left_m_s != 0.0 || right_m_s != 0.0; }

  hal::TimeNs sensed_ns = 0;
  hal::TimeNs changed_ns = 0;
  double left_m_s = 0.0;
  double right_m_s = 0.0;
};

/// What the line does to bytes; both directions have their own. `fault` says what arrives of a byte, and how often.
struct Wire {
  std::function<std::vector<std::uint8_t>(std::uint8_t byte, hal::TimeNs at)> fault = {};
  double loss = 0.0;
  bool cut = false;
  hal::TimeNs delay_ns = 0;
};

class WireRig {
 public:
  explicit WireRig(DriverSettings settings = {}, std::uint64_t seed = 1,
                   epuck_emulator::Variant variant = epuck_emulator::Variant::Gctronic)
      : WireRig(std::move(settings), seed, options_of(variant)) {}
  WireRig(DriverSettings settings, std::uint64_t seed, const epuck_emulator::Firmware::Options& options)
      : driver(std::move(settings)), firmware(options, body, {}), chance_(seed) {
    plug_in();
    firmware.power_on(0);
  }

  /// A new link, as after a hang-up.
  void plug_in() {
    auto [a, b] = MemoryLink::make_pair([this] { return now; });
    near_ = std::move(a);
    far_ = std::move(b);
    to_robot_.clear();
    to_host_.clear();
  }

  void run(hal::TimeNs duration) {
    for (const hal::TimeNs end = now + duration; now < end;) {
      now += kStep;
      step_wire();
      if (stalled_until <= now) driver.pump(*near_, now);
      if (each_step) each_step();
    }
  }
  /// One control period: latch, what the test does as controller, commit, the time until the next.
  template <class F>
  void tick(hal::TimeNs tick_ns, F&& control) {
    driver.latch(ticks++, now);
    control();
    driver.commit(now);
    driver.pump(*near_, now);
    run(tick_ns);
  }
  void tick(hal::TimeNs tick_ns) {
    tick(tick_ns, [] {});
  }

  static constexpr hal::TimeNs kStep = kMs / 4;

  hal::TimeNs now = hal::kNsPerSecond;
  hal::Tick ticks = 0;
  hal::TimeNs stalled_until = 0;        ///< neither the driver's thread nor the robot's program runs
  hal::TimeNs robot_stalled_until = 0;  ///< the robot's program does not run
  hal::TimeNs heard_ns = 0;             ///< when a byte last reached the host
  Wire to_robot, to_host;
  WatchedBody body;
  std::function<void()> each_step;
  EpuckDriver driver;
  epuck_emulator::Firmware firmware;

 private:
  static epuck_emulator::Firmware::Options options_of(epuck_emulator::Variant variant) {
    epuck_emulator::Firmware::Options options;
    options.variant = variant;
    return options;
  }
  bool passes(const Wire& wire) { return !wire.cut && !(std::uniform_real_distribution<>()(chance_) < wire.loss); }

  static void travel(const Wire& wire, std::deque<epuck_emulator::SentByte>& queue, epuck_emulator::SentByte byte) {
    const hal::TimeNs earliest = queue.empty() ? 0 : queue.back().at;
    const hal::TimeNs at = std::max(earliest, byte.at + wire.delay_ns);
    if (!wire.fault) {
      queue.push_back({byte.byte, at});
      return;
    }
    for (const std::uint8_t arrives : wire.fault(byte.byte, byte.at)) queue.push_back({arrives, at});
  }

  void step_wire() {
    std::array<std::uint8_t, 256> buffer{};
    for (Received r = far_->read(buffer); r.size > 0; r = far_->read(buffer)) {
      for (std::size_t i = 0; i < r.size; ++i) {
        line_free_ns_ = std::max(line_free_ns_, now) + epuck_emulator::kByteNs;
        if (passes(to_robot)) travel(to_robot, to_robot_, {buffer[i], line_free_ns_});
      }
    }
    if (std::max(stalled_until, robot_stalled_until) > now) return;
    while (!to_robot_.empty() && to_robot_.front().at <= now) {
      firmware.receive(to_robot_.front().byte, to_robot_.front().at);
      to_robot_.pop_front();
    }
    firmware.run_until(now);
    sent_.clear();
    firmware.take_sent(now, sent_);
    for (const epuck_emulator::SentByte& b : sent_) {
      if (passes(to_host)) travel(to_host, to_host_, b);
    }
    while (!to_host_.empty() && to_host_.front().at <= now) {
      (void)far_->write(std::span(&to_host_.front().byte, 1), 0);
      heard_ns = now;
      to_host_.pop_front();
    }
  }

  std::unique_ptr<MemoryLink> near_, far_;
  std::deque<epuck_emulator::SentByte> to_robot_, to_host_;
  std::vector<epuck_emulator::SentByte> sent_;
  hal::TimeNs line_free_ns_ = 0;
  std::mt19937_64 chance_;
};

}  // namespace tandem::bridges::epuck
