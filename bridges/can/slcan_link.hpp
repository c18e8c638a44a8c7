// A CAN bus behind an adapter that speaks slcan on a serial line.
#pragma once
#include <memory>

#include "bridges/can/can_link.hpp"
#include "bridges/can/slcan_text.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges {

struct SlcanSettings {
  std::uint32_t bits_per_s = 1'000'000;
  /// Whether an adapter that does not answer the start is refused; some clones never answer.
  bool strict = false;
  hal::TimeNs drain_ns = 50 * hal::kNsPerMs;    ///< to let old bytes come before the start
  hal::TimeNs answer_ns = 500 * hal::kNsPerMs;  ///< to wait for each answer
  hal::TimeNs flags_ns = hal::kNsPerSecond;     ///< the adapter's status flags are asked for this often; 0: never
};

/// Speaks through a byte link that it owns. What the serial line has not taken yet stays in order and goes first.
class SlcanLink final : public CanLink {
 public:
  /// Closes the adapter's channel, sets the bit rate and opens it. Blocks up to about 2 s.
  /// Errors: a bit rate that slcan has no digit for; the line hung up; the adapter refuses; strict, and no answer.
  static hal::Result<std::unique_ptr<CanLink>> open(std::unique_ptr<ByteLink> line, const SlcanSettings& settings = {});
  /// Closes the channel, as far as the line takes it.
  ~SlcanLink() override;

  Sent send(const CanFrame& frame) noexcept override;
  bool receive(CanFrame& frame) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  int descriptor() const noexcept override { return line_->descriptor(); }
  BusState state() const noexcept override { return record_.state(); }
  CanStatistics statistics() const noexcept override { return record_.counts; }
  std::string name() const override { return "slcan over " + line_->name(); }

 private:
  SlcanLink(std::unique_ptr<ByteLink> line, const SlcanSettings& settings);
  enum class Answer : std::uint8_t { Yes, No, None };
  Answer ask(std::string_view command);
  bool next_saying() noexcept;
  void flush() noexcept;
  void ask_flags() noexcept;
  void note(const SlcanSaying& saying) noexcept;
  void note_flags(std::uint8_t flags) noexcept;

  std::unique_ptr<ByteLink> line_;
  SlcanSettings settings_;
  SlcanReader reader_;
  std::array<std::uint8_t, 256> buffer_{};
  std::size_t read_ = 0;  // of the buffer's `filled_`
  std::size_t filled_ = 0;
  hal::TimeNs arrived_ns_ = 0;
  SlcanLine unsent_;
  std::size_t sent_ = 0;  // of `unsent_`
  hal::TimeNs asked_flags_ns_ = 0;
  bool flags_awaited_ = false;
  BusRecord record_;
};

}  // namespace tandem::bridges
