// What a run reports: JSON for programs, a short table for people.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hal/result.hpp"

namespace tandem::app {

/// "0x" and 16 digits.
std::string hash_text(std::uint64_t hash);

/// Writes `text` to a file, or to standard output for "-".
hal::Status write_report(const std::string& path, const std::string& text);

/// Two columns, aligned.
void print_table(const std::vector<std::pair<std::string, std::string>>& rows);

}  // namespace tandem::app
