#include "compat/argos3/control/controller_types.hpp"

#include <algorithm>
#include <string_view>

#include "compat/argos3/control/adapter.hpp"
#include "compat/argos3/facade/library.hpp"

namespace tandem::compat::argos3 {
namespace {

using argos::tandem_detail::SRegistration;
using Types = ClassTables<hal::ControllerType>;

struct ReadParams {
  template <std::size_t kNumber>
  static std::shared_ptr<const void> call(hal::ParamVisitor& visitor) {
    auto params = std::make_shared<Adapter::Params>();
    params->describe(visitor);
    params->registration = &Types::registration(kNumber);
    return params;
  }
};
constexpr auto kReaders = functions_by_number<ReadParams, Types::kMost>();

}  // namespace

void register_controllers(const std::vector<const SRegistration*>& registrations, hal::Registrar& registrar) {
  for (const SRegistration* const one : registrations) {
    if (one->Kind != std::string_view("controller")) continue;
    registrar.add(Types::of(*one, [&](hal::ControllerType& type, std::size_t number) {
      type = hal::controller_type<Adapter>(one->Label, "a controller of ARGoS'");
      type.read_params = kReaders[number];
    }));
  }
}

bool is_controller_of_argos(const hal::ControllerType& type) noexcept {
  return std::find(kReaders.begin(), kReaders.end(), type.read_params) != kReaders.end();
}

}  // namespace tandem::compat::argos3
