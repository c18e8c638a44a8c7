#include "app/report.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>

namespace tandem::app {

std::string hash_text(std::uint64_t hash) {
  return fmt::format("0x{:016x}", hash);
}

hal::Status write_report(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
    return {};
  }
  std::ofstream out(path);
  out << text << "\n";
  out.close();
  if (!out) return hal::Error{"the report '" + path + "' cannot be written; check the folder and its permissions"};
  return {};
}

void print_table(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::size_t width = 0;
  for (const auto& [name, value] : rows) width = std::max(width, name.size());
  for (const auto& [name, value] : rows) fmt::print("  {:<{}}  {}\n", name, width, value);
}

}  // namespace tandem::app
