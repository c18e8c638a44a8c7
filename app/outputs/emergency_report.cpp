#include "app/outputs/emergency_report.hpp"

#include <cstdio>
#include <unistd.h>

#include "app/process/measure.hpp"

namespace tandem::app {
namespace {

constexpr double kPrepareEvery_s = 0.5;

/// Writes `text` as the inside of a JSON string.
bool write_quoted(int descriptor, std::string_view text) noexcept {
  for (const char& c : text) {
    if ((c == '"' || c == '\\') && !write_now(descriptor, "\\")) return false;
    if (!write_now(descriptor, {&c, 1})) return false;
  }
  return true;
}

}  // namespace

bool put_in_place(const hal::OutputFile& file) noexcept {
  return file.part().empty() || std::rename(file.part().c_str(), file.target().c_str()) == 0;
}

EmergencyReport::EmergencyReport(const std::optional<hal::OutputFile>& report) noexcept
    : file_(report), prepared_s_(wall_seconds()) {
  save_in_emergency(this);
}

EmergencyReport::~EmergencyReport() {
  save_in_emergency(nullptr);
}

bool EmergencyReport::due() noexcept {
  const double now_s = wall_seconds();
  if (now_s < prepared_s_ + kPrepareEvery_s) return false;
  prepared_s_ = now_s;
  return true;
}

void EmergencyReport::set_report(const hal::Json& members) {
  const std::string text = hal::to_text(members);
  reports_[next_] = text.substr(1, text.size() - 2);  // without the braces
  report_.store(&reports_[next_], std::memory_order_release);
  next_ = 1 - next_;
}

void EmergencyReport::save(std::string_view failure) const noexcept {
  const std::string* members = report_.load(std::memory_order_acquire);
  if (!file_ || members == nullptr) return;
  const int report = file_->descriptor();
  const bool written = write_now(report, "{\"finished\":false,\"ended\":\"failed\",\"failure\":\"") &&
                       write_quoted(report, failure) && write_now(report, "\",") && write_now(report, *members) &&
                       write_now(report, "}\n");
  if (!written || !put_in_place(*file_)) (void)write_now(STDERR_FILENO, "error: the report could not be saved\n");
}

}  // namespace tandem::app
