#include <algorithm>

#include "window/page_files.hpp"

namespace tandem::window {

const PageFile* find_page_file(std::string_view path) noexcept {
  const std::span<const PageFile> files = page_files();
  const auto found = std::find_if(files.begin(), files.end(), [&](const PageFile& file) { return file.path == path; });
  return found == files.end() ? nullptr : &*found;
}

}  // namespace tandem::window
