#include "hal/robot_log.hpp"

#include <algorithm>

#include "hal/printable.hpp"

namespace tandem::hal {

void RobotLog::write(Severity severity, std::string_view text) noexcept {
  if (sink_ == nullptr) return;
  const TimeNs now_ns = sink_->now_ns();
  // A bucket that is full at free_ns_ [generic cell rate algorithm, ITU-T I.371].
  if (free_ns_ > now_ns + kBurst * kRefill_ns) free_ns_ = now_ns;  // the run went back
  if (free_ns_ > now_ns + (kBurst - 1) * kRefill_ns) {
    if (sink_->keeps())
      sink_->keep(robot_, severity, shortened(text));
    else
      ++left_out_;
    return;
  }
  free_ns_ = std::max(free_ns_, now_ns) + kRefill_ns;
  if (text.size() > kLongestMessage) {
    sink_->write(robot_, severity, shortened(text), left_out_);
  } else {
    sink_->write(robot_, severity, text, left_out_);
  }
  left_out_ = 0;
}

std::string message_of(std::string_view robot, Tick tick, std::string_view text, std::uint32_t left_out) {
  std::string message = "robot '" + std::string(robot) + "' at tick " + std::to_string(tick) + ": " + std::string(text);
  if (left_out > 0) {
    message += " (" + std::to_string(left_out) +
               (left_out == 1 ? " message before it was" : " messages before it were") + " left out)";
  }
  return message;
}

}  // namespace tandem::hal
