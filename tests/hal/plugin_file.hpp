// Plug-in files as bytes, for tests that damage them.
#pragma once
#include <cstdint>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <vector>

#include "hal/surface.hpp"

namespace tandem::test {

inline std::vector<std::byte> bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

inline void write(const std::string& path, const std::vector<std::byte>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

inline void put(std::vector<std::byte>& file, std::size_t at, std::uint32_t word) {
  std::memcpy(file.data() + at, &word, sizeof word);
}

/// Where our notes of this type begin.
inline std::vector<std::size_t> notes_of(const std::vector<std::byte>& file, std::uint32_t type) {
  std::vector<std::size_t> places;
  for (std::size_t at = 12; at + 8 < file.size(); at += 4) {
    std::uint32_t words[3];
    std::memcpy(words, file.data() + at - 12, sizeof words);
    if (words[0] == 7 && words[2] == type && std::memcmp(file.data() + at, "Tandem", 7) == 0) places.push_back(at - 12);
  }
  EXPECT_FALSE(places.empty()) << "there is no such note";
  return places;
}

/// Makes the note of a surface that begins there tell another.
inline void put_surface(std::vector<std::byte>& file, std::size_t note, const hal::Surface& surface) {
  put(file, note + 20, surface.number);
  put(file, note + 24, static_cast<std::uint32_t>(surface.digest));
  put(file, note + 28, static_cast<std::uint32_t>(surface.digest >> 32));
  put(file, note + 32, surface.size);
  std::vector<char> name(hal::Surface::kLongestName + 1);
  surface.name.copy(name.data(), hal::Surface::kLongestName);
  std::memcpy(file.data() + note + 36, name.data(), name.size());
}

}  // namespace tandem::test
