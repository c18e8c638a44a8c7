// Needs a symbol that nobody has.
#include "hal/plugin.hpp"

namespace nobody {
int has_this(double x);
}

namespace {

void register_all(tandem::hal::Registrar& /*registrar*/) {
  (void)nobody::has_this(1.0);
}

}  // namespace

TANDEM_PLUGIN(register_all)
