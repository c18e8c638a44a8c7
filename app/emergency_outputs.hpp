// The outputs of a run whose process must end at once.
#pragma once
#include <array>
#include <atomic>
#include <string>

#include "app/emergency.hpp"
#include "app/run_outputs.hpp"

namespace tandem::app {

/// Saves records in whole lines, and the newest report that was prepared, for as long as it lives. At most one at a
/// time.
class EmergencyOutputs final : public EmergencySaver {
 public:
  /// `outputs` must outlive this, and not be closed before.
  explicit EmergencyOutputs(const RunOutputs& outputs) noexcept;
  ~EmergencyOutputs() override;
  EmergencyOutputs(const EmergencyOutputs&) = delete;
  EmergencyOutputs& operator=(const EmergencyOutputs&) = delete;

  /// The members of the report's object but "finished", "ended" and "failure", which are put before them.
  void set_report(std::string members);

  void save(std::string_view failure) const noexcept override;

 private:
  const RunOutputs& outputs_;
  std::array<std::string, 2> reports_;  // one is shown while the other is made
  std::size_t next_ = 0;
  std::atomic<const std::string*> report_{nullptr};
};

}  // namespace tandem::app
