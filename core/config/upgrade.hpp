// Brings experiment files to this program's version of the vocabulary, in place: comments and layout stay.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/catalog.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// Of the vocabulary of experiment files, as <tandem version="…"> says it. Raised when an element or attribute gets
/// another name or meaning, with a step for it in upgrade.cpp. 1: Tandem's own names; without a version, a file is of
/// before, or one of ARGoS 3's.
inline constexpr std::int64_t kFileVersion = 1;

struct Upgrade {
  std::string text;                  ///< the whole file
  std::vector<std::string> changes;  ///< "line 12: …", in the order of the file; empty: it was up to date
};

/// Files of kinds of robots need no steps yet. `name` stands for the file in messages; `catalog` knows the robots and
/// devices that it may name. Errors: not XML; a later version than this program knows.
hal::Result<Upgrade> upgraded(const std::string& text, const std::string& name, const hal::Catalog& catalog);

/// Why a file of this version cannot be read; empty: it can.
std::string version_problem(std::int64_t version);

}  // namespace tandem::core
