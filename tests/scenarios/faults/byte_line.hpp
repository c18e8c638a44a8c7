// The serial line of an emulated e-puck in virtual time, with the emulator's faults on it.
#pragma once
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "bridges/epuck_emulator/faults.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
#include "bridges/link/link.hpp"
#include "tests/scenarios/faults/tested_robot.hpp"

namespace tandem::faults {

/// What lies between a host and the firmware: 115200 baud each way, bursts handed over each millisecond, and faults.
/// Several may hold the line open; whoever reads first has the bytes.
class ByteLine {
 public:
  explicit ByteLine(bridges::epuck_emulator::Firmware& firmware) : firmware_(firmware) {}

  void begin_faults(const std::vector<std::string>& texts, std::uint64_t seed, TimeNs now) {
    namespace emulator = bridges::epuck_emulator;
    std::vector<emulator::Fault> faults;
    for (const std::string& text : texts) faults.push_back(emulator::kFaults.parse(text).value());
    plan_ = std::make_unique<emulator::FaultPlan>(std::move(faults), seed);
    plan_->begin(now);
  }

  void live(TimeNs now) {
    now_ = now;
    if (plan_) apply_faults(now);
    while (!to_robot_.empty() && to_robot_.front().at <= now) {
      const auto next = to_robot_.front();
      to_robot_.pop_front();
      const auto byte = plan_ ? plan_->to_robot(next.byte, next.at) : next.byte;
      if (!byte) continue;
      firmware_.receive(*byte, next.at);
      if (doubled(next.at)) firmware_.receive(*byte, next.at);
    }
    firmware_.run_until(now);
    sent_.clear();
    firmware_.take_sent(now, sent_);
    for (const auto& s : sent_) {
      const auto byte = plan_ ? plan_->to_host(s.byte, s.at) : s.byte;
      if (!byte || hung_up_) continue;
      const TimeNs at = s.at + (plan_ ? plan_->delay_ns(s.at) : 0);
      for (int times = doubled(s.at) ? 2 : 1; times > 0; --times) {
        to_host_.push_back({*byte, to_host_.empty() ? at : std::max(at, to_host_.back().at)});
      }
    }
    if (plan_ && plan_->active(bridges::epuck_emulator::FaultKind::Garbage, now) && now >= next_noise_) {
      next_noise_ = now + 5 * kMs;
      if (const auto byte = plan_->to_host(0, now)) to_host_.push_back({*byte, now});
    }
    for (; !to_host_.empty() && to_host_.front().at <= now; to_host_.pop_front()) {
      arrived_.push_back(to_host_.front());
    }
  }

  bool hung_up() const noexcept { return hung_up_; }
  /// Null while it is hung up. An open end stays hung up when the line has been so since.
  std::unique_ptr<bridges::ByteLink> open() {
    if (hung_up_) return nullptr;
    arrived_.clear();
    return std::make_unique<End>(*this);
  }

 private:
  using Byte = bridges::epuck_emulator::SentByte;
  class End final : public bridges::ByteLink {
   public:
    explicit End(ByteLine& line) : line_(line), hang_ups_(line.hang_ups_) {}
    std::size_t write(std::span<const std::uint8_t> bytes, TimeNs) noexcept override {
      if (state() != bridges::LinkState::Open) return 0;
      if (traced()) trace("host", line_.now_, hexadecimal(bytes));
      for (const std::uint8_t byte : bytes) {
        line_.free_at_ = std::max(line_.free_at_, line_.now_) + bridges::epuck_emulator::kByteNs;
        line_.to_robot_.push_back({byte, line_.free_at_});
      }
      return bytes.size();
    }
    bridges::Received read(std::span<std::uint8_t> buffer) noexcept override {
      bridges::Received got;
      got.at_ns = line_.now_;
      while (state() == bridges::LinkState::Open && got.size < buffer.size() && !line_.arrived_.empty()) {
        buffer[got.size++] = line_.arrived_.front().byte;
        line_.arrived_.pop_front();
      }
      return got;
    }
    bool wait(TimeNs) noexcept override { return !line_.arrived_.empty(); }
    bridges::LinkState state() const noexcept override {
      return line_.hang_ups_ == hang_ups_ ? bridges::LinkState::Open : bridges::LinkState::HungUp;
    }
    bridges::LinkStatistics statistics() const noexcept override { return {}; }
    std::string name() const override { return "virtual line"; }

   private:
    ByteLine& line_;
    int hang_ups_;
  };

  static std::string hexadecimal(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : bytes) text += {kDigits[byte >> 4U], kDigits[byte & 15U], ' '};
    return text;
  }
  void apply_faults(TimeNs now) {
    using bridges::epuck_emulator::FaultKind;
    while (const auto change = plan_->next_change(now)) {
      if (change->fault->kind == FaultKind::Reset) firmware_.reset(change->at, "fault");
      if (change->fault->kind == FaultKind::Truncate) firmware_.cut_next_answer();
      if (change->fault->kind != FaultKind::Hangup) continue;
      to_robot_.clear();
      to_host_.clear();
      arrived_.clear();
      hung_up_ = change->begins;
      if (change->begins) ++hang_ups_;
    }
  }
  bool doubled(TimeNs at) { return plan_ && plan_->doubles(at); }

  bridges::epuck_emulator::Firmware& firmware_;
  std::unique_ptr<bridges::epuck_emulator::FaultPlan> plan_;
  std::deque<Byte> to_robot_, to_host_, arrived_;
  std::vector<Byte> sent_;
  TimeNs now_ = 0, free_at_ = 0, next_noise_ = 0;
  bool hung_up_ = false;
  int hang_ups_ = 0;
};

}  // namespace tandem::faults
