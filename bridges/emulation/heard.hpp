// Messages that an emulated robot hears, and its scanner's heads: common code of emulators with such devices.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "bridges/emulation/emulated_body.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::bridges {

/// A body whose radio hears messages: `Heard` has range_m, bearing_rad, elevation_rad, and `take(bytes, size)`, which
/// takes the content over.
template <class Senses, class Command, class Heard>
class HearingBodyOf : public EmulatedBodyOf<Senses, Command> {
 public:
  /// Messages that were heard since the last call.
  virtual std::vector<Heard> take_heard() = 0;
};

template <class Body, class Heard, auto read, auto write>
class HearingPortBodyOf final : public PortBodyOf<Body, read, write> {
 public:
  using PortBodyOf<Body, read, write>::PortBodyOf;

  /// Those of the newest readings, if they are others than the last time.
  std::vector<Heard> take_heard() override {
    std::vector<Heard> all;
    this->ports_.with([&](const PortBank& bank) {
      if (std::exchange(told_, this->ports_.told()) == this->ports_.told()) return;
      const auto& radio = bank.port<hal::RangeAndBearing>();
      all.resize(radio.count);
      for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].range_m = static_cast<double>(radio.range_m[i]);
        all[i].bearing_rad = static_cast<double>(radio.bearing_rad[i]);
        all[i].elevation_rad = static_cast<double>(radio.elevation_rad[i]);
        all[i].take(radio.message(i), std::size_t{radio.size[i]});
      }
    });
    return all;
  }

 private:
  std::uint64_t told_ = 0;  // readings that were taken
};

/// Commands of a scanner, and what it sends.
void write_scanner(PortBank& bank, const auto& command) {
  auto& scanner = bank.port<hal::ScannerDrive>();
  scanner.mode = static_cast<hal::ScannerMode>(command.scanner);
  scanner.speed_rad_s = command.scanner_rad_s;
  scanner.angle_rad = command.scanner_rad;
}

}  // namespace tandem::bridges
