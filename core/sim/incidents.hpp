// Misbehaviour of controllers and bodies in a run: counted, and reported as one line a cause.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/log.hpp"

namespace tandem::core {

/// The text without its numbers, but with those of places in files ("walk.lua:12:", "line 12"): texts of one cause are
/// the same then.
std::string cause_of(std::string_view text);

/// "A (and 49 more) threw", for 49 others that did the same as A.
std::string with_others(std::string_view who, std::size_t others, std::string_view what);

/// One cause of incidents.
struct IncidentCause {
  std::string key;                 ///< as `cause_of` gives it
  std::string who, what;           ///< of the first: "robot 'ep3'" and " left the arena at tick 12"
  std::vector<std::uint32_t> met;  ///< numbers of all bodies with it, in order
  std::uint64_t told = 0;          ///< bodies that the log has counted

  std::string text() const;  ///< "robot 'ep3' (and 4 more) left the arena at tick 12"

  void remember(auto& archive) { archive(key, who, what, met, told); }
};

/// Counted misbehaviour of controllers and bodies, for the report.
struct Incidents {
  static constexpr std::size_t kCauses = 20;  ///< that are named

  std::uint64_t commands_clamped = 0;
  std::uint64_t commands_not_finite = 0;
  std::uint64_t controllers_thrown = 0;
  std::uint64_t bodies_escaped = 0;
  std::vector<IncidentCause> causes;  ///< the first few
  std::uint64_t latest = 0;           ///< of these, that happened last

  /// The first few causes, each naming a robot, tick, event, and to how many others it happened.
  std::vector<std::string> first() const;

  /// A body did or met something: "robot 'ep3'", " left the arena at tick 12"; `body` is its number.
  void note(std::uint32_t body, std::string who, std::string what);
  /// The same for a cause that begins so and has been noted, without making texts. @returns false where none has.
  bool note_again(std::uint32_t body, std::string_view begin);
  /// Logs causes that are new since the last call; with `all`, also those that more bodies have met since they were
  /// logged.
  void tell(const hal::Log& log, bool all, hal::Severity severity = hal::Severity::Warning);

  void remember(auto& archive) {
    archive(commands_clamped, commands_not_finite, controllers_thrown, bodies_escaped, causes, latest);
  }
};

}  // namespace tandem::core
