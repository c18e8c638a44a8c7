// Runs that a program of one's own steps through CSimulator. libtandem.so makes them; in the tandem program there are
// none.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace tandem::compat::argos3 {

/// A world with its plug-ins and hooks, begun.
class OwnRun {
 public:
  virtual ~OwnRun() = default;
  /// One tick. @returns why the run has failed; empty: it has not
  virtual std::string step() = 0;
  virtual std::string reset(std::uint64_t seed) = 0;
};

/// The function that libtandem.so exports as `tandem_argos3_open_run`. Null: `why` names all problems.
using OpenOwnRun = OwnRun* (*)(const char* file, const std::uint64_t* seed, std::string& why);

}  // namespace tandem::compat::argos3
