// Parts of the validation, each in a file of its own.
#pragma once
#include "validate/row.hpp"

namespace tandem::validate {

Part engine_part(Depth depth);   ///< engines against closed forms
Part sensor_part(Depth depth);   ///< sensors against a ray caster of its own
Part noise_part(Depth depth);    ///< noise against the distributions that the manual names
Part mixed_part(Depth depth);    ///< twin, filter and fit against emulated robots' logs
Part barrier_part(Depth depth);  ///< contacts of real robots over hidden delay

Part case_study_part(Depth depth);  ///< the published table made again; figure 12 by the model

}  // namespace tandem::validate
