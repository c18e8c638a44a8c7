// Messages that an emulated robot receives when its body is simulated elsewhere.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "bridges/port_bank.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::bridges {

/// The messages of the newest readings, if they are others than at `seen`, which becomes their number.
/// `fill(heard, bytes, size)` takes a message's content over.
template <class Heard, class Fill>
std::vector<Heard> take_messages(SharedPorts& ports, std::uint64_t& seen, Fill&& fill) {
  std::vector<Heard> all;
  ports.with([&](const PortBank& bank) {
    if (std::exchange(seen, ports.told()) == ports.told()) return;
    const auto& radio = bank.port<hal::RangeAndBearing>();
    all.resize(radio.count);
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].range_m = static_cast<double>(radio.range_m[i]);
      all[i].bearing_rad = static_cast<double>(radio.bearing_rad[i]);
      all[i].elevation_rad = static_cast<double>(radio.elevation_rad[i]);
      fill(all[i], radio.message(i), std::size_t{radio.size[i]});
    }
  });
  return all;
}

}  // namespace tandem::bridges
