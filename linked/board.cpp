#include <array>

#include "app/module/linked_modules.hpp"
#include "app/real/register.hpp"
#include "bridges/epuck/register.hpp"
#include "bridges/eyebot/register.hpp"
#include "bridges/footbot/register.hpp"
#include "bridges/thymio/register.hpp"

namespace tandem::app {
namespace {

constexpr RealSideType kOnABoard = {"real", &check_real, &outlooks_of_trackers, &inputs_of_bridges, nullptr};

void register_bridges(hal::Registrar& registrar) {
  bridges::epuck::register_bridge(registrar);
  bridges::footbot::register_bridge(registrar);
  bridges::eyebot::register_bridge(registrar);
  bridges::thymio::register_bridge(registrar);
  registrar.add(kOnABoard);
}

}  // namespace

std::span<const LinkedModule> linked_modules() noexcept {
  static constexpr std::array<LinkedModule, 1> kAll = {{{"real", &register_bridges}}};
  return kAll;
}

}  // namespace tandem::app
