#include "app/emergency_outputs.hpp"

#include <cstdio>
#include <unistd.h>

namespace tandem::app {
namespace {

/// Writes `text` as the inside of a JSON string.
bool write_quoted(int descriptor, std::string_view text) noexcept {
  for (const char& c : text) {
    if ((c == '"' || c == '\\') && !write_now(descriptor, "\\")) return false;
    if (!write_now(descriptor, {&c, 1})) return false;
  }
  return true;
}

/// Puts a file in its place, as OutputFile::commit does.
bool put_in_place(const hal::OutputFile& file) noexcept {
  return file.part().empty() || std::rename(file.part().c_str(), file.target().c_str()) == 0;
}

}  // namespace

EmergencyOutputs::EmergencyOutputs(const RunOutputs& outputs) noexcept : outputs_(outputs) {
  save_in_emergency(this);
}

EmergencyOutputs::~EmergencyOutputs() {
  save_in_emergency(nullptr);
}

void EmergencyOutputs::set_report(std::string members) {
  reports_[next_] = std::move(members);
  report_.store(&reports_[next_], std::memory_order_release);
  next_ = 1 - next_;
}

void EmergencyOutputs::save(std::string_view failure) const noexcept {
  if (outputs_.trajectory != nullptr) {
    const core::UnwrittenRecords& records = outputs_.trajectory->unwritten();
    const std::size_t size = records.size.load(std::memory_order_acquire);
    const char* const data = records.data.load(std::memory_order_relaxed);
    if (!write_now(records.descriptor, {data, size}) || !put_in_place(outputs_.trajectory->file()))
      (void)write_now(STDERR_FILENO, "error: the end of the trajectory could not be saved; it is in its .part\n");
  }
  const std::string* members = report_.load(std::memory_order_acquire);
  if (outputs_.report && members != nullptr) {
    const int report = outputs_.report->descriptor();
    const bool written = write_now(report, "{\"finished\":false,\"ended\":\"failed\",\"failure\":\"") &&
                         write_quoted(report, failure) && write_now(report, "\",") && write_now(report, *members) &&
                         write_now(report, "}\n");
    if (!written || !put_in_place(*outputs_.report))
      (void)write_now(STDERR_FILENO, "error: the report could not be saved\n");
  }
  if (outputs_.picture) {
    if (!outputs_.picture->part().empty()) unlink(outputs_.picture->part().c_str());
    (void)write_now(STDERR_FILENO, "no picture was drawn\n");
  }
}

}  // namespace tandem::app
