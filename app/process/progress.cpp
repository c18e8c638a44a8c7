#include "app/process/progress.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <unistd.h>

#include "app/process/measure.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {

Progress::Progress(std::int64_t total_steps, std::int64_t ticks_per_second)
    : total_(total_steps),
      ticks_per_second_(ticks_per_second),
      terminal_(isatty(STDERR_FILENO) != 0),
      began_s_(wall_seconds()),
      next_s_(began_s_ + 0.3) {}

Progress::~Progress() {
  if (shown_) stand_last("");
}

void Progress::step(std::int64_t done) {
  if (!terminal_) return;
  const double now = wall_seconds();
  if (now < next_s_) return;
  next_s_ = now + 0.1;
  draw(done, now);
}

void Progress::draw(std::int64_t done, double now_s) {
  shown_ = true;
  const double virtual_s = static_cast<double>(done) / static_cast<double>(ticks_per_second_);
  if (total_ <= 0) return stand_last(fmt::format("{:.1f} s of virtual time; Ctrl-C ends the run", virtual_s));
  constexpr int kWidth = 40;
  const double part = std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0);
  const int filled = static_cast<int>(part * kWidth);
  const double left_s = part > 0.0 ? (now_s - began_s_) * (1.0 - part) / part : 0.0;
  stand_last(fmt::format("[{}{}] {:3.0f} %  {:.1f} of {:.1f} s, {:.0f} s left",
                         std::string(static_cast<std::size_t>(filled), '#'),
                         std::string(static_cast<std::size_t>(kWidth - filled), '-'), 100.0 * part, virtual_s,
                         static_cast<double>(total_) / static_cast<double>(ticks_per_second_), left_s));
}

}  // namespace tandem::app
