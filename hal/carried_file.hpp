// Files of the sources that a program carries: written into it by CMake's tandem_carry.
#pragma once
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tandem::hal {

struct CarriedFile {
  std::string_view name;  ///< its path in the folder that they were taken from
  std::string_view text;
};

/// @throws std::out_of_range when there is none of that name: the program's own mistake
inline std::string carried_text(std::span<const CarriedFile> files, std::string_view name) {
  for (const CarriedFile& file : files)
    if (file.name == name) return std::string(file.text);
  throw std::out_of_range("no file " + std::string(name) + " is carried");
}

}  // namespace tandem::hal
