#include "core/medium/range_and_bearing/range_and_bearing.hpp"

#include <algorithm>

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

void RangeAndBearingMedium::fit(const SpaceStores& stores) {
  RowMedium::fit(stores);
  const bool longer = std::any_of(stores.groups.begin(), stores.groups.end(),
                                  [](const RobotGroup& group) { return group.rab_payload > hal::kRabPayloadMax; });
  long_.assign(longer ? rows() : 0, LongPart{});
}

void register_range_and_bearing_medium(hal::Registrar& registrar) {
  static constexpr MediumType kType{
      RangeAndBearingMedium::kKind,
      "Carries messages. Boards of one medium do not hear those of another; a board that names none hears all.",
      [](hal::ParamVisitor& visitor) { Settings{}.describe(visitor); },
      []() -> std::unique_ptr<Medium> { return std::make_unique<RangeAndBearingMedium>(); }};
  registrar.add(kType);
}

}  // namespace tandem::core
