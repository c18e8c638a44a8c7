#include "core/view/layers/layers.hpp"

#include <array>

#include "core/view/layers/types.hpp"

namespace tandem::core {

void register_layers(hal::Registrar& registrar) {
  static const std::array all = {proximity_layer(), distance_scanner_layer(),  time_of_flight_layer(),
                                 light_layer(),     range_and_bearing_layer(), cameras_layer(),
                                 trails_layer(),    velocity_layer(),          ids_layer(),
                                 hooks_layer(),     measures_layer()};
  for (const LayerType& type : all) registrar.add(type);
}

}  // namespace tandem::core
