// The outputs of a run whose process must end at once.
#pragma once
#include "app/outputs/emergency_report.hpp"
#include "app/outputs/run_outputs.hpp"

namespace tandem::app {

/// Saves records in whole lines as well as the report.
class EmergencyOutputs final : public EmergencyReport {
 public:
  /// `outputs` must outlive this, and not be closed before.
  explicit EmergencyOutputs(const RunOutputs& outputs) noexcept : EmergencyReport(outputs.report), outputs_(outputs) {}

  void save(std::string_view failure) const noexcept override;

 private:
  const RunOutputs& outputs_;
};

}  // namespace tandem::app
