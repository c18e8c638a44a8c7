// Where a projector shows the arena: four corners, kept in a file of this user's for each experiment.
#pragma once
#include <string>

#include "hal/json/json.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// $XDG_STATE_HOME/tandem/projector/NAME-DIGITS.json (~/.local/state without that variable), where DIGITS stand for the
/// experiment's folder; empty: this user has neither.
std::string projector_file(const std::string& experiment);

/// Used by one thread.
class ProjectorFit {
 public:
  /// `experiment`: path of its file.
  explicit ProjectorFit(const std::string& experiment);

  /// {"type": "projector", "corners": [[x, y], …] or null}: of the arena's north-west, north-east, south-east and
  /// south-west, from the top left of the window to (1, 1).
  hal::Json message() const;
  /// Takes the corners of a command, and writes them. Errors: not four pairs, pairs that cross, a file that cannot be
  /// written, no place for it; of the last two they count all the same.
  hal::Status take(const hal::Json& command);

 private:
  std::string file_;
  hal::Json corners_;
};

}  // namespace tandem::app
