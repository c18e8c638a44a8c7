#include "app/outputs/run_log.hpp"

#include <fmt/format.h>
#include <utility>

#include "app/process/measure.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {
namespace {

constexpr int kShown = 20;

std::string_view word_of(hal::Severity severity) {
  return severity == hal::Severity::Error ? "error" : severity == hal::Severity::Warning ? "warning" : "info";
}

}  // namespace

hal::Status RunLog::open(const std::string& path) {
  if (path.empty()) return {};
  auto file = hal::OutputFile::open(path, "log");
  if (!file.ok()) return file.error();
  file_ = std::move(file).value();
  file_->keep_part();
  return {};
}

hal::Log RunLog::log() {
  return hal::Log([this](hal::Severity severity, std::string_view text) { write(severity, text, false); });
}

hal::Log RunLog::robots() {
  return hal::Log([this](hal::Severity severity, std::string_view text) { write(severity, text, true); });
}

hal::Log RunLog::excess() {
  if (!file_) return {};
  return hal::Log([this](hal::Severity severity, std::string_view text) { write_excess(severity, text); });
}

void RunLog::write_excess(hal::Severity severity, std::string_view text) {
  const std::string entry = hal::printable_entry(hal::shortened(text));
  const std::lock_guard hold(lock_);
  ++excess_;
  write_file(severity, entry);
}

void RunLog::tell_also(std::function<void(std::string_view)> listener) {
  const std::lock_guard hold(lock_);
  listener_ = std::move(listener);
}

void RunLog::write(hal::Severity severity, std::string_view text, bool about_robots) {
  const std::string entry = hal::printable_entry(hal::shortened(text));
  const std::lock_guard hold(lock_);
  if (about_robots && !says_elsewhere()) {
    robot_lines_.take(severity, entry, wall_seconds());
    tell_robots(false);
  } else if ((!about_robots && ++count_ <= kShown) || says_elsewhere()) {
    say(entry);  // a screen shows the newest ones, however many
  }
  if (listener_) listener_(entry);
  write_file(severity, entry);
  if (over_ && severity == hal::Severity::Error) ++late_errors_;
}

void RunLog::results_done() {
  const std::lock_guard hold(lock_);
  over_ = true;
}

bool RunLog::over() const {
  const std::lock_guard hold(lock_);
  return over_;
}

int RunLog::late_errors() const {
  const std::lock_guard hold(lock_);
  return late_errors_;
}

void RunLog::keep(std::string_view text) {
  const std::string entry = hal::printable_entry(hal::shortened(text));
  const std::lock_guard hold(lock_);
  write_file(hal::Severity::Info, entry);
}

/// With the lock.
void RunLog::write_file(hal::Severity severity, std::string_view entry) {
  if (!file_ || !written_.ok()) return;
  written_ = file_->write(fmt::format("{}: {}\n", word_of(severity), entry));
}

void RunLog::tell_robots(bool all) {
  for (const std::string& line : robot_lines_.due(wall_seconds(), all)) say(line);
}

void RunLog::show_robots(const std::vector<core::RollRow>& roll) {
  const std::lock_guard hold(lock_);
  tell_robots(false);
  if (says_elsewhere()) return;
  if (const std::size_t columns = terminal_columns(); columns > 0) return stand_below(roll_lines(roll, columns));
  for (const std::string& line : roll_teller_.look(roll, wall_seconds())) say(line);
}

void RunLog::end_robots() {
  const std::lock_guard hold(lock_);
  tell_robots(true);
  stand_below({});
}

hal::Status RunLog::close() {
  end_robots();
  const std::lock_guard hold(lock_);
  const std::size_t left_out =
      robot_lines_.left_out() + excess_ + (count_ > kShown ? static_cast<std::size_t>(count_ - kShown) : 0);
  if (left_out > 0)
    say(fmt::format("{} more messages{}", left_out, file_ ? " are in " + file_->path() : "; --log FILE keeps all"));
  if (!file_ || !written_.ok()) return written_;
  return written_ = file_->commit();
}

}  // namespace tandem::app
