// Golden values of runs: what changes one of them changes results that somebody may rely on.
//
// A file of lines `name value`, sorted by name, beside this header. With TANDEM_RENEW_GOLDEN=1 in the environment the
// values that differ are written there instead: in a commit that says why.
#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <string>
#include <string_view>

#include "tests/checkout.hpp"

namespace tandem::golden {

/// Digest of bytes (FNV-1a, 64 bits), taken piece by piece.
class Digest {
 public:
  void add(std::string_view bytes) noexcept {
    for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }
  std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value_));
    return digits;
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

/// Compares with the line `name` of tests/golden/`file`.
inline void expect(const std::string& file, const std::string& name, const std::string& value) {
  const std::string path = std::string(test::kSourceDir) + "/tests/golden/" + file;
  std::map<std::string, std::string> lines;
  std::ifstream in(path);
  for (std::string key, kept; in >> key >> kept;) lines[key] = kept;
  if (std::getenv("TANDEM_RENEW_GOLDEN") == nullptr) {
    EXPECT_EQ(lines[name], value) << "'" << name << "' of " << path
                                  << " differs. If that is meant, run this test with TANDEM_RENEW_GOLDEN=1 and say why "
                                     "in the commit";
    return;
  }
  lines[name] = value;
  std::ofstream out(path);
  for (const auto& [key, kept] : lines) out << key << ' ' << kept << '\n';
}

}  // namespace tandem::golden
