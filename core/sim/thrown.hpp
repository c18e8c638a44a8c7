// Calls of plug-ins that may throw.
#pragma once
#include <exception>
#include <optional>
#include <string>

namespace tandem::core {

/// Makes a call into a plug-in. What it threw, behind a colon where that says something; none: nothing.
template <class Call>
std::optional<std::string> thrown(Call&& call) {
  try {
    call();
    return std::nullopt;
  } catch (const std::exception& e) {
    return std::string(": ") + e.what();
  } catch (...) {
    return std::string();
  }
}

}  // namespace tandem::core
