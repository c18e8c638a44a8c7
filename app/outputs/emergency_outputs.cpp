#include "app/outputs/emergency_outputs.hpp"

#include <unistd.h>

namespace tandem::app {

void EmergencyOutputs::save(std::string_view failure) const noexcept {
  if (outputs_.trajectory != nullptr) {
    const core::UnwrittenRecords& records = outputs_.trajectory->unwritten();
    const std::size_t size = records.size.load(std::memory_order_acquire);
    const char* const data = records.data.load(std::memory_order_relaxed);
    if (!write_now(records.descriptor, {data, size}) || !put_in_place(outputs_.trajectory->file()))
      (void)write_now(STDERR_FILENO, "error: the end of the trajectory could not be saved; it is in its .part\n");
  }
  if (outputs_.record != nullptr && !put_in_place(outputs_.record->file()))
    (void)write_now(STDERR_FILENO, "error: the record could not be put in its place; it is in its .part\n");
  EmergencyReport::save(failure);
  for (const hal::OutputFile* drawn : outputs_.at_the_end) {
    if (!drawn->part().empty()) unlink(drawn->part().c_str());
    (void)write_now(STDERR_FILENO, "no picture was drawn\n");
  }
}

}  // namespace tandem::app
