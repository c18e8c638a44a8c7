// A report of the validation as a page, as a PDF, and as JSON.
#pragma once
#include <string>
#include <vector>

#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "validate/row.hpp"

namespace tandem::validate {

/// What a row's last column says; "" without a contract.
const char* word_of(Verdict verdict);

/// The whole report.
struct Report {
  std::vector<std::pair<std::string, std::string>> about;  ///< machine, release, commit, date, fingerprint
  std::vector<Part> parts;
};

/// Rows by verdict.
struct Count {
  int met = 0, not_met = 0, not_made = 0, told = 0;
};
Count count(const Report& report);
/// The same in a sentence.
std::string summary_of(const Report& report);

/// Self-contained HTML; figures are files in the folder `figures` beside it.
std::string page_of(const Report& report);
hal::Json json_of(const Report& report);

/// Sheets of a PDF as SVG, A4, `figures` the SVG of each figure by part and place.
std::vector<std::string> sheets_of(const Report& report, const std::vector<std::vector<std::string>>& figures);

}  // namespace tandem::validate
