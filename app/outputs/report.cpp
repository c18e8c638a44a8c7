#include "app/outputs/report.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>

#include "app/process/terminal.hpp"

namespace tandem::app {

namespace {

namespace fs = std::filesystem;

/// Also by another name, through links or folders; a file need not be there yet.
bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return fs::is_regular_file(a, error);
  const fs::path absolute_a = fs::weakly_canonical(fs::absolute(a, error), error);
  return !error && absolute_a == fs::weakly_canonical(fs::absolute(b, error), error) && !fs::exists(a, error);
}

}  // namespace

std::string hash_text(std::uint64_t hash) {
  return fmt::format("0x{:016x}", hash);
}

hal::Status check_apart(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  const auto is_file = [](const NamedFile& file) { return !file.path.empty() && file.path != "-"; };
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (!is_file(*output)) continue;
    for (const NamedFile& input : inputs) {
      if (is_file(input) && same_file(output->path, input.path))
        return hal::Error{"the " + output->what + " would overwrite the " + input.what + " '" + input.path +
                          "'; give it another name"};
    }
    for (auto other = outputs.begin(); other != output; ++other) {
      if (is_file(*other) && same_file(output->path, other->path))
        return hal::Error{"the " + output->what + " and the " + other->what + " would both be written to '" +
                          output->path + "'; give one of them another name"};
    }
  }
  return {};
}

hal::Status keep_old(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  const std::string kept = path + ".bak";
  fs::copy_file(path, kept, fs::copy_options::overwrite_existing, error);
  if (error) return hal::Error{"the old '" + path + "' cannot be kept as '" + kept + "': " + error.message()};
  say("the old '" + path + "' is kept as '" + kept + "'");
  return {};
}

void print_table(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::size_t width = 0;
  for (const auto& [name, value] : rows) width = std::max(width, name.size());
  for (const auto& [name, value] : rows)  // fmt::print would throw where the terminal is gone
    std::fputs(fmt::format("  {:<{}}  {}\n", name, width, printable(value)).c_str(), stdout);
}

}  // namespace tandem::app
