// As a plug-in of the release before: what its note says was written by hand. It must not run.
#include <cstdlib>

#include "hal/plugin.hpp"

namespace {

struct RunsWhenLoaded {
  RunsWhenLoaded() { std::abort(); }
} runs_when_loaded;

/// The table of controllers as it may have been.
struct OldControllerType {
  static constexpr std::string_view kCategory = "controller";
  static constexpr std::uint32_t kNumber = 0;
};

void register_all(tandem::hal::Registrar& /*registrar*/) {
  tandem::hal::detail::note_surface<OldControllerType>();
}

}  // namespace

TANDEM_PLUGIN(register_all)
