// Drawings of records, and areas as records have them.
#pragma once
#include <vector>

#include "core/record/record_source.hpp"
#include "core/view/drawing.hpp"
#include "core/view/trails.hpp"
#include "hal/json/json.hpp"

namespace tandem::core {

/// The areas of an experiment.
std::vector<Drawing::Area> areas_of(const SafetyConfig& safety);

/// What the run would have drawn, but for what is wrong with real robots. Refers to the record's space for the floor.
/// Of `look`, whether ids are asked for counts. `trails`: null: none
Drawing drawing_of(RecordSource& record, const PictureLook& look, const Trails* trails);

PictureLook::Area arena_of(const Space& space);

}  // namespace tandem::core
