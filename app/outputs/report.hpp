// Reports of runs: JSON for programs, a short table for people.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hal/result.hpp"

namespace tandem::app {

/// "0x" and 16 digits.
std::string hash_text(std::uint64_t hash);

/// A file that the command line or the experiment names, and what it is.
struct NamedFile {
  std::string what;
  std::string path;
};
/// Error: an output would overwrite an input or another output, also by another name. Empty paths and "-" are none.
hal::Status check_apart(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// Keeps the file that will be overwritten as FILE.bak, in place of an older one, and says so. Nothing where there is
/// no ordinary file of that name.
hal::Status keep_old(const std::string& path);

/// Two columns, aligned.
void print_table(const std::vector<std::pair<std::string, std::string>>& rows);

}  // namespace tandem::app
