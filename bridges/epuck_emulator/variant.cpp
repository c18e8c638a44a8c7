#include "bridges/epuck_emulator/variant.hpp"

#include <array>
#include <string>

namespace tandem::bridges::epuck_emulator {
namespace {

// Public sources: gctronic/e-puck-library (BTcom.c, Asercom.c), e-puck2/e-puck2_main-processor (Asercom2.c, motors.h),
// cyberbotics/webots (transfer/firmware/firmware.c). All but BTcom answer the accelerometer filtered, which is not
// zeroed; Webots' does so in binary only.
constexpr std::size_t kImageEpuck1 = 39 * 52 * 2;
constexpr std::size_t kImageEpuck2 = 160 * 120 * 2;

constexpr std::array<VariantFacts, 4> kFacts = {{
    {Variant::Btcom, "btcom", "Version 2.0.0 January 2008", "", 1000, true, false, false, true, false, false, true, 0,
     0, kImageEpuck1},
    {Variant::Gctronic, "gctronic", "Version 1.2.2 August 2008 GCtronic", "HW version: 1", 1000, true, false, true,
     false, true, false, true, 2048, 2048, kImageEpuck1},
    {Variant::Webots, "webots", "Version 1.5.3 November 2016 (Webots)", "HW version: 1", 1000, true, false, true, true,
     true, true, false, 2048, 0, kImageEpuck1},
    {Variant::Epuck2, "epuck2", "Version 2.0 January 2018 GCtronic", "HW version: 2", 1100, false, true, true, false,
     true, false, true, 2048, 2048, kImageEpuck2},
}};

}  // namespace

const VariantFacts& facts_of(Variant variant) noexcept {
  return kFacts[static_cast<std::size_t>(variant)];
}

hal::Result<Variant> variant_from(std::string_view name) {
  std::string known;
  for (const VariantFacts& f : kFacts) {
    if (f.name == name) return f.variant;
    known += (known.empty() ? "" : ", ") + std::string(f.name);
  }
  return hal::Error{"there is no e-puck firmware '" + std::string(name) + "'; use one of: " + known};
}

}  // namespace tandem::bridges::epuck_emulator
