// The files of the page, which are carried in the program.
#pragma once
#include <span>
#include <string_view>

namespace tandem::window {

struct PageFile {
  std::string_view path;  ///< as browsers ask for it: "/index.html"
  std::string_view type;  ///< "text/javascript; charset=utf-8"
  std::string_view content;
  std::string_view packed;  ///< the same by gzip
  std::string_view tag;     ///< differs when the content does, in quotes: an ETag
};

std::span<const PageFile> page_files() noexcept;

/// Null: there is none.
const PageFile* find_page_file(std::string_view path) noexcept;

}  // namespace tandem::window
