#include "core/medium/medium.hpp"

#include <array>
#include <string>

#include "hal/element.hpp"

namespace tandem::core {

hal::Result<Medium*> Media::of(const hal::Catalog& catalog, std::string_view kind) {
  for (const auto& [type, medium] : all_) {
    if (type->name == kind) return medium.get();
  }
  const auto* const type = catalog.find<MediumType>(kind);
  if (type == nullptr || type->make == nullptr) {
    return hal::Error{"there is no medium '" + std::string(kind) +
                      "' to work in; there are: " + hal::listed(catalog.names(MediumType::kCategory))};
  }
  all_.emplace_back(type, type->make());
  return all_.back().second.get();
}

void register_unused_media(hal::Registrar& registrar) {
  static constexpr auto kNothing = [](hal::ParamVisitor&) {};
  static constexpr std::array<MediumType, 3> kAll = {{
      {"directional_led", "Accepted for ARGoS files; no device here uses it.", kNothing},
      {"tag", "Accepted for ARGoS files; no device here uses it.", kNothing},
      {"simple_radio", "Accepted for ARGoS files; no device here uses it.", kNothing},
  }};
  for (const MediumType& type : kAll) registrar.add(type);
}

}  // namespace tandem::core
