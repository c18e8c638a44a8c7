// What a bridge tells of itself, as part of a report.
#pragma once
#include "app/json.hpp"
#include "bridges/robot_bridge.hpp"

namespace tandem::app {

/// Adds fields to the object that is open.
class JsonStatus final : public bridges::StatusVisitor {
 public:
  /// `json` must outlive this.
  explicit JsonStatus(Json& json) : json_(json) {}

  void text(std::string_view name, std::string_view value) override { json_.field(name, value); }
  void count(std::string_view name, std::uint64_t value) override { json_.field(name, value); }
  void number(std::string_view name, double value) override { json_.field(name, value); }
  void flag(std::string_view name, bool value) override { json_.field(name, value); }
  void begin_list(std::string_view name) override { json_.key(name).begin_array(); }
  void begin_row() override { json_.begin_object(); }
  void end_row() override { json_.end_object(); }
  void end_list() override { json_.end_array(); }

 private:
  Json& json_;
};

/// Adds how the conversation went to the object that is open.
inline void add_link_report(Json& json, const bridges::LinkReport& r) {
  json.field("questions", r.questions).field("answers", r.answers).field("time_outs", r.time_outs);
  json.field("bad_answers", r.bad_answers).field("resynchronised", r.resynchronised);
  json.field("links_lost", r.links_lost);
  json.field("mean_round_trip_ms", static_cast<double>(r.mean_round_trip_ns) * 1e-6);
  json.field("max_round_trip_ms", static_cast<double>(r.max_round_trip_ns) * 1e-6);
}

}  // namespace tandem::app
