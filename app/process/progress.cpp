#include "app/process/progress.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

#include "app/process/measure.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {

std::string duration_text(double seconds) {
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  if (seconds < 100.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000.0) return fmt::format("{:.0f} minutes", seconds / 60.0);
  return fmt::format("{:.1f} hours", seconds / 3600.0);
}

Progress::Progress(std::int64_t total, std::int64_t per_unit, std::string name, std::string unit)
    : total_(total),
      per_unit_(per_unit),
      name_(std::move(name)),
      unit_(std::move(unit)),
      terminal_(isatty(STDERR_FILENO) != 0),
      began_s_(wall_seconds()),
      next_s_(began_s_ + (terminal_ ? 0.3 : 2.0)) {}

Progress::~Progress() {
  if (shown_) stand_last("");
}

void Progress::step(std::int64_t done, std::string_view more) {
  if (!terminal_ && (name_.empty() || total_ <= 0)) return;
  const double now = wall_seconds();
  const double part = part_of(done);
  if (began_part_ < 0.0) began_part_ = part;
  if (now < next_s_) return;
  next_s_ = terminal_ ? now + 0.1 : now + (now - began_s_);
  if (terminal_) return draw(done, now, more);
  say(fmt::format("{}: {:.0f} %{}{}", name_, 100.0 * part, more, left(part, now, "about ")));
}

double Progress::part_of(std::int64_t done) const {
  return total_ > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0) : 0.0;
}

/// ", 5 s left"; nothing while that is not known.
std::string Progress::left(double part, double now_s, std::string_view about) const {
  if (part <= began_part_) return {};
  const double left_s = (now_s - began_s_) * (1.0 - part) / (part - began_part_);
  return fmt::format(", {}{} left", about, duration_text(left_s));
}

/// Seconds have a decimal; what is counted one by one has none.
std::string Progress::amount(std::int64_t count) const {
  return fmt::format("{:.{}f}", static_cast<double>(count) / static_cast<double>(per_unit_), unit_ == "s" ? 1 : 0);
}

void Progress::draw(std::int64_t done, double now_s, std::string_view more) {
  shown_ = true;
  if (total_ <= 0) return stand_last(amount(done) + " s of virtual time; Ctrl-C ends the run");
  constexpr int kWidth = 30;
  const double part = part_of(done);
  const int filled = static_cast<int>(part * kWidth);
  const std::string line =
      fmt::format("[{:#<{}}{:-<{}}] {:3.0f} %  {}{} of {} {}{}{}", "", filled, "", kWidth - filled, 100.0 * part,
                  name_.empty() ? "" : name_ + ": ", amount(done), amount(total_), unit_, more, left(part, now_s, ""));
  stand_last(line.substr(0, std::max<std::size_t>(terminal_columns(), 40) - 1));
}

}  // namespace tandem::app
