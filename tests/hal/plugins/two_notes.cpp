// Says of one surface two things, as a library does whose parts were compiled against different headers.
#include "hal/plugin.hpp"

namespace {

struct Idle final : tandem::hal::Controller {
  explicit Idle(tandem::hal::Robot&) {}
  void step() override {}
};

struct OldControllerType {
  static constexpr std::string_view kCategory = "controller";
  static constexpr std::uint32_t kNumber = 0;
};

void register_all(tandem::hal::Registrar& registrar) {
  tandem::hal::detail::note_surface<OldControllerType>();
  registrar.add_controller<Idle>("idle", "Does nothing.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
