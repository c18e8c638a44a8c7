// Status of a bridge, as part of a report.
#pragma once
#include <string>

#include "bridges/robot_bridge.hpp"
#include "hal/json/json.hpp"

namespace tandem::app {

/// Adds members to an object.
class JsonStatus final : public bridges::StatusVisitor {
 public:
  /// `json` must outlive this.
  explicit JsonStatus(hal::Json& json) : json_(json) {}

  void text(std::string_view name, std::string_view value) override { add(name, value); }
  void count(std::string_view name, std::uint64_t value) override { add(name, value); }
  void number(std::string_view name, double value) override { add(name, value); }
  void flag(std::string_view name, bool value) override { add(name, value); }
  void begin_list(std::string_view name) override {
    list_ = name;
    json_[list_] = hal::Json::array();
  }
  void begin_row() override {
    json_[list_].push_back(hal::Json::object());
    in_row_ = true;
  }
  void end_row() override { in_row_ = false; }
  void end_list() override { list_.clear(); }

 private:
  template <class T>
  void add(std::string_view name, const T& value) {
    (in_row_ ? json_[list_].back() : json_)[std::string(name)] = value;
  }

  hal::Json& json_;
  std::string list_;  // that is open
  bool in_row_ = false;
};

/// Adds how the conversation went.
inline void add_link_report(hal::Json& json, const bridges::LinkReport& r) {
  json["questions"] = r.questions;
  json["answers"] = r.answers;
  json["time_outs"] = r.time_outs;
  json["bad_answers"] = r.bad_answers;
  json["resynchronised"] = r.resynchronised;
  json["links_lost"] = r.links_lost;
  json["mean_round_trip_ms"] = static_cast<double>(r.mean_round_trip_ns) * 1e-6;
  json["max_round_trip_ms"] = static_cast<double>(r.max_round_trip_ns) * 1e-6;
}

}  // namespace tandem::app
