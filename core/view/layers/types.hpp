// The layers of this folder, one a file; `register_layers` adds them all.
#pragma once
#include "core/view/layers/layer.hpp"

namespace tandem::core {

LayerType proximity_layer();
LayerType distance_scanner_layer();
LayerType time_of_flight_layer();
LayerType light_layer();
LayerType range_and_bearing_layer();
LayerType cameras_layer();
LayerType trails_layer();
LayerType velocity_layer();
LayerType ids_layer();
LayerType hooks_layer();
LayerType measures_layer();

}  // namespace tandem::core
