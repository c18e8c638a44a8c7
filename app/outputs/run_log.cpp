#include "app/outputs/run_log.hpp"

#include <fmt/format.h>
#include <utility>

#include "app/process/terminal.hpp"

namespace tandem::app {
namespace {

constexpr int kShown = 20;

std::string_view word_of(hal::Severity severity) {
  return severity == hal::Severity::Error ? "error" : severity == hal::Severity::Warning ? "warning" : "info";
}

}  // namespace

hal::Result<std::unique_ptr<RunLog>> RunLog::open(const std::string& path) {
  auto log = std::make_unique<RunLog>();
  if (path.empty()) return log;
  auto file = hal::OutputFile::open(path, "log");
  if (!file.ok()) return file.error();
  log->file_ = std::move(file).value();
  log->file_->keep_part();
  return log;
}

hal::Log RunLog::log() {
  return hal::Log([this](hal::Severity severity, std::string_view text) { write(severity, text); });
}

void RunLog::tell_also(std::function<void(std::string_view)> listener) {
  const std::lock_guard hold(lock_);
  listener_ = std::move(listener);
}

void RunLog::write(hal::Severity severity, std::string_view text) {
  const std::string entry = hal::printable_entry(hal::shortened(text));
  const std::lock_guard hold(lock_);
  if (++count_ <= kShown || says_elsewhere()) say(entry);  // a screen shows the newest ones, however many
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

hal::Status RunLog::close() {
  const std::lock_guard hold(lock_);
  if (count_ > kShown) {
    say(fmt::format("{} more messages{}", count_ - kShown,
                    file_ ? " are in " + file_->path() : "; --log FILE keeps all"));
  }
  if (!file_ || !written_.ok()) return written_;
  return written_ = file_->commit();
}

}  // namespace tandem::app
