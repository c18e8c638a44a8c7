#include "app/report.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

#include "app/terminal.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {

std::string hash_text(std::uint64_t hash) {
  return fmt::format("0x{:016x}", hash);
}

hal::Status write_report(const std::string& path, const std::string& text) {
  std::fflush(stdout);
  return hal::write_whole_file(path, "report", text + "\n");
}

void print_table(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::size_t width = 0;
  for (const auto& [name, value] : rows) width = std::max(width, name.size());
  for (const auto& [name, value] : rows) fmt::print("  {:<{}}  {}\n", name, width, printable(value));
}

}  // namespace tandem::app
