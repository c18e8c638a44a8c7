// The catalog of the program for a robot's board: bridges and controllers, nothing simulated.
#include "app/board_names.hpp"
#include "app/catalog.hpp"

namespace tandem::app {

const core::KnownNames& known_names() {
  static const core::KnownNames names = board_names();
  return names;
}

}  // namespace tandem::app
