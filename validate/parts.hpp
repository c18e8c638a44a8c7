// Parts of the validation, each in a file of its own.
#pragma once
#include "validate/row.hpp"

namespace tandem::validate {

Part engine_part(Depth depth);  ///< engines against closed forms
Part sensor_part(Depth depth);  ///< sensors against a ray caster of its own
Part noise_part(Depth depth);   ///< noise against the distributions that the manual names

}  // namespace tandem::validate
