// The report of a run whose process must end at once.
#pragma once
#include <array>
#include <atomic>
#include <optional>
#include <string>

#include "app/process/emergency.hpp"
#include "hal/json/json.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {

/// Puts a file in its place, as OutputFile::commit does; in a signal handler if need be.
bool put_in_place(const hal::OutputFile& file) noexcept;

/// Saves the newest report that was prepared, for as long as it lives. At most one at a time.
class EmergencyReport : public EmergencySaver {
 public:
  /// Nothing is saved where no report was asked for. `report` must outlive this, and not be written before.
  explicit EmergencyReport(const std::optional<hal::OutputFile>& report) noexcept;
  ~EmergencyReport() override;
  EmergencyReport(const EmergencyReport&) = delete;
  EmergencyReport& operator=(const EmergencyReport&) = delete;

  /// Whether it is time to prepare the next one: twice a second.
  bool due() noexcept;
  /// `members`: of the report, but "finished", "ended" and "failure", which are put before them.
  void set_report(const hal::Json& members);

  void save(std::string_view failure) const noexcept override;

 private:
  const std::optional<hal::OutputFile>& file_;
  std::array<std::string, 2> reports_;  // one is shown while the other is made
  std::size_t next_ = 0;
  std::atomic<const std::string*> report_{nullptr};
  double prepared_s_;
};

}  // namespace tandem::app
