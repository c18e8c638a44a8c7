#include "core/field/sound/sound.hpp"

#include "core/scenario/field_type.hpp"

namespace tandem::core {

void register_sound(hal::Registrar& registrar) {
  static constexpr FieldType kType{"sound", "The level of steady sounds, 1 at a loud source.", nullptr,
                                   [](const Element&, const FieldArea&, Problems&) -> std::unique_ptr<Field> {
                                     return std::make_unique<SoundField>();
                                   }};
  registrar.add(kType);
}

}  // namespace tandem::core
