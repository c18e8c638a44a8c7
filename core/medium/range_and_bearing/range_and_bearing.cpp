#include "core/medium/range_and_bearing/range_and_bearing.hpp"

namespace tandem::core {
namespace {

struct Settings {
  bool check_occlusions = true;
  void describe(hal::ParamVisitor& v) {
    v.flag("check_occlusions", check_occlusions,
           "Whether bodies, boxes and cylinders block messages; for sensors that do not say it themselves.");
  }
};

}  // namespace

void register_range_and_bearing_medium(hal::Registrar& registrar) {
  static constexpr MediumType kType{
      RangeAndBearingMedium::kKind,
      "Carries messages. Boards of one medium do not hear those of another; a board that names none hears all.",
      [](hal::ParamVisitor& visitor) { Settings{}.describe(visitor); },
      []() -> std::unique_ptr<Medium> { return std::make_unique<RangeAndBearingMedium>(); }};
  registrar.add(kType);
}

}  // namespace tandem::core
