// Parts of any run, a robot's as well as a world's: real time, and how far it is.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "core/run/run.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {

/// Real time. Under `lock`, if there is one, what the pacer keeps changes. Both must outlive the part.
std::unique_ptr<core::RunPart> pace_part(mixed_reality::Pacer& pacer, std::mutex* lock = nullptr,
                                         mixed_reality::Pacer::Lookout lookout = {});
/// How far a run is, as `Progress` says it; `steps` 0: it has no end.
std::unique_ptr<core::RunPart> progress_part(std::int64_t steps, std::int64_t ticks_per_second,
                                             const std::string& name = {});

}  // namespace tandem::app
