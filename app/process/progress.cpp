#include "app/process/progress.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <unistd.h>
#include <utility>

#include "app/process/measure.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {

Progress::Progress(std::int64_t total_steps, std::int64_t ticks_per_second, std::string name)
    : total_(total_steps),
      ticks_per_second_(ticks_per_second),
      terminal_(isatty(STDERR_FILENO) != 0),
      name_(std::move(name)),
      began_s_(wall_seconds()),
      next_s_(began_s_ + (terminal_ ? 0.3 : 2.0)) {}

Progress::~Progress() {
  if (shown_) stand_last("");
}

void Progress::step(std::int64_t done) {
  if (!terminal_ && (name_.empty() || total_ <= 0)) return;
  const double now = wall_seconds();
  const double part = part_of(done);
  if (began_part_ < 0.0) began_part_ = part;
  if (now < next_s_) return;
  next_s_ = terminal_ ? now + 0.1 : now + (now - began_s_);
  if (terminal_) return draw(done, now);
  say(fmt::format("{}: {:.0f} %, about {:.0f} s left", name_, 100.0 * part, left_s(part, now)));
}

double Progress::part_of(std::int64_t done) const {
  return total_ > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0) : 0.0;
}

double Progress::left_s(double part, double now_s) {
  return part > began_part_ ? (now_s - began_s_) * (1.0 - part) / (part - began_part_) : 0.0;
}

void Progress::draw(std::int64_t done, double now_s) {
  shown_ = true;
  const double virtual_s = static_cast<double>(done) / static_cast<double>(ticks_per_second_);
  if (total_ <= 0) return stand_last(fmt::format("{:.1f} s of virtual time; Ctrl-C ends the run", virtual_s));
  constexpr int kWidth = 40;
  const double part = part_of(done);
  const int filled = static_cast<int>(part * kWidth);
  stand_last(fmt::format(
      "[{}{}] {:3.0f} %  {}{:.1f} of {:.1f} s, {:.0f} s left", std::string(static_cast<std::size_t>(filled), '#'),
      std::string(static_cast<std::size_t>(kWidth - filled), '-'), 100.0 * part, name_.empty() ? "" : name_ + ": ",
      virtual_s, static_cast<double>(total_) / static_cast<double>(ticks_per_second_), left_s(part, now_s)));
}

}  // namespace tandem::app
