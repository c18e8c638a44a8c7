// Poses of bodies (hal/pose.hpp), by the name that all of core uses.
#pragma once
#include "hal/pose.hpp"

namespace tandem::core {

using hal::Pose;

}  // namespace tandem::core
