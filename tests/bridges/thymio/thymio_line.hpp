// The line of an emulated Thymio in time that a test turns by hand, with the emulator's faults on it.
#pragma once
#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "bridges/aseba/message_link.hpp"
#include "bridges/thymio_emulator/faults.hpp"
#include "bridges/thymio_emulator/thymio.hpp"

namespace tandem::bridges::thymio {

namespace emulator = thymio_emulator;

/// What lies between hosts and the node: a millisecond each way, and faults. Every end that is open sees all that the
/// robot says.
class ThymioLine {
 public:
  explicit ThymioLine(emulator::Thymio& robot) : robot_(robot) {}

  void begin_faults(const std::vector<std::string>& texts, std::uint64_t seed, hal::TimeNs now) {
    std::vector<emulator::Fault> faults;
    for (const std::string& text : texts) faults.push_back(emulator::kFaults.parse(text).value());
    plan_ = emulator::FaultPlan(std::move(faults), seed);
    plan_.begin(now);
  }

  /// Robot and line go on to `now`.
  void live(hal::TimeNs now) {
    now_ = now;
    while (const auto change = plan_.next_change(now)) {
      emulator::apply(*change, robot_);
      if (change->fault->kind != emulator::FaultKind::Hangup) continue;
      hung_up_ = change->begins;
      to_robot_.clear();
      to_hosts_.clear();
      ++hang_ups_;
    }
    for (; !to_robot_.empty() && to_robot_.front().at <= now; to_robot_.pop_front()) {
      if (plan_.reaches_robot(now)) robot_.receive(to_robot_.front().message, now);
    }
    robot_.run_until(now);
    std::vector<emulator::TimedMessage> sent, arriving;
    robot_.take_sent(sent);
    for (const emulator::TimedMessage& message : sent) plan_.to_host(message, arriving);
    to_hosts_.insert(to_hosts_.end(), arriving.begin(), arriving.end());
    for (; !to_hosts_.empty() && to_hosts_.front().at <= now; to_hosts_.pop_front()) {
      for (End* end : ends_) end->arrived_.push_back(to_hosts_.front());
    }
  }

  /// One host's end. It is Gone once the line has hung up since.
  class End final : public aseba::MessageLink {
   public:
    explicit End(ThymioLine& line) : line_(line), hang_ups_(line.hang_ups_) { line_.ends_.push_back(this); }
    ~End() override { std::erase(line_.ends_, this); }
    End(const End&) = delete;
    End& operator=(const End&) = delete;

    bool send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept override {
      if (state() != aseba::Carrier::Up) return false;
      line_.to_robot_.push_back({{aseba::kHost, type, {payload.begin(), payload.end()}}, line_.now_ + hal::kNsPerMs});
      return true;
    }
    bool receive(aseba::MessageView& view) noexcept override {
      if (state() != aseba::Carrier::Up || arrived_.empty()) return false;
      shown_ = std::move(arrived_.front());
      arrived_.pop_front();
      view = {shown_.message.source, shown_.message.type, shown_.message.payload, line_.now_};
      return true;
    }
    bool wait(hal::TimeNs) noexcept override { return false; }
    void clear() noexcept override {}
    aseba::Carrier state() const noexcept override {
      return !line_.hung_up_ && hang_ups_ == line_.hang_ups_ ? aseba::Carrier::Up : aseba::Carrier::Gone;
    }
    aseba::MessageLinkStatistics statistics() const noexcept override { return {}; }
    std::string name() const override { return "test"; }

   private:
    friend ThymioLine;
    ThymioLine& line_;
    int hang_ups_;
    std::deque<emulator::TimedMessage> arrived_;
    emulator::TimedMessage shown_;
  };

  /// The hub's end: Down while there is no line, opened again by itself.
  class HubEnd final : public aseba::MessageLink {
   public:
    explicit HubEnd(ThymioLine& line) : line_(line) {}
    void open() { wanted_ = true; }
    void close() {
      wanted_ = false;
      end_.reset();
    }
    bool send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept override {
      look_after();
      return end_ && end_->send(type, payload);
    }
    bool receive(aseba::MessageView& view) noexcept override {
      look_after();
      return end_ && end_->receive(view);
    }
    bool wait(hal::TimeNs) noexcept override { return false; }
    void clear() noexcept override {}
    aseba::Carrier state() const noexcept override {
      return end_ && end_->state() == aseba::Carrier::Up ? aseba::Carrier::Up : aseba::Carrier::Down;
    }
    aseba::MessageLinkStatistics statistics() const noexcept override { return {}; }
    std::string name() const override { return "test"; }

   private:
    void look_after() {
      if (end_ && end_->state() != aseba::Carrier::Up) end_.reset();
      if (!end_ && wanted_ && !line_.hung_up_) end_ = std::make_unique<End>(line_);
    }
    ThymioLine& line_;
    bool wanted_ = false;
    std::unique_ptr<End> end_;
  };

  bool hung_up() const noexcept { return hung_up_; }

 private:
  emulator::Thymio& robot_;
  emulator::FaultPlan plan_{{}, 1};
  hal::TimeNs now_ = 0;
  bool hung_up_ = false;
  int hang_ups_ = 0;
  std::deque<emulator::TimedMessage> to_robot_, to_hosts_;
  std::vector<End*> ends_;
};

}  // namespace tandem::bridges::thymio
