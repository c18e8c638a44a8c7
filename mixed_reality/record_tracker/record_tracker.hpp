// Tracker `record`: poses of robots in a record, as fast as they were.
#pragma once
#include "bridges/tracker_type.hpp"
#include "hal/catalog.hpp"
#include "hal/params.hpp"

namespace tandem::mixed_reality {

struct RecordTrackerOptions {
  std::string file, entities = "*";
  double from_s = 0.0;
  void describe(hal::ParamVisitor& v) {
    v.text("file", file, "The record.");
    v.text("entities", entities,
           "Ids of the robots whose poses are played, separated by spaces; '*' stands for any text.");
    v.number("from", from_s, hal::unit::s, hal::kNotNegative, "Of the record's time: where it begins.");
  }
};

/// Stamps of sightings are the record's own time.
bridges::MadeTracker make_record_tracker(const bridges::TrackerRequest& request, const hal::Log& log);
hal::Status check_record_tracker(const bridges::TrackerRequest& request);

void register_record_tracker(hal::Registrar& registrar);

}  // namespace tandem::mixed_reality
