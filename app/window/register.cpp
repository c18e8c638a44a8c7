#include "app/window/register.hpp"

#include "app/command/command.hpp"
#include "app/run/run_module.hpp"
#include "app/window/view_part.hpp"

namespace tandem::app {
namespace {

constexpr RunModule kWindow = {"window", nullptr, nullptr, nullptr, &add_view, &view_space};

}  // namespace

void register_window(hal::Registrar& registrar) {
  registrar.add(view_command);
  registrar.add(kWindow);
}

}  // namespace tandem::app
