#include "core/live/repeat.hpp"

#include "core/live/touch.hpp"
#include "core/record/record_reader.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::core {

using hal::Json;

hal::Result<Repeatable> read_repeatable(const std::string& record) {
  auto opened = RecordReader::open(record);
  if (!opened.ok()) return opened.error();
  RecordReader& reader = opened.value();
  Repeatable all;
  const Json& start = reader.start();
  if (const Json* const seed = hal::member_of(start, "seed"); seed != nullptr && seed->is_number_unsigned())
    all.seed = seed->get<std::uint64_t>();
  all.experiment = hal::text_of(start, "experiment");
  all.scripts = hal::object_of(start, "scripts");
  while (const auto entry = reader.next()) {
    if (entry->type == RecordBlock::Fingerprint) all.fingerprints[entry->tick] = entry->fingerprint;
    if (entry->type != RecordBlock::Event) continue;
    const Json& event = entry->json;
    const auto kind = event.find("kind");
    if (kind == event.end() || !kind->is_string()) continue;
    const auto bad = [&] {
      return hal::Error{record + ": at tick " + std::to_string(entry->tick) + ": \"" + hal::to_text(event) +
                        "\" makes no sense"};
    };
    if (*kind == "back") {
      const auto before = event.find("before");
      const auto to = event.find("to");
      if (before == event.end() || !before->is_array() || to == event.end() || !to->is_number_integer()) return bad();
      all.fingerprints.erase(all.fingerprints.lower_bound(to->get<hal::Tick>()), all.fingerprints.end());
      all.actions.clear();
      for (const Json& one : *before) {
        if (!one.is_object() || !one.contains("step") || !one["step"].is_number_integer() || !one.contains("action") ||
            !one["action"].is_object())
          return bad();
        all.actions.push_back({one["step"].get<std::int64_t>(), one["action"]});
      }
    } else if (*kind == "action") {
      const auto action = event.find("action");
      const auto step = event.find("step");
      if (action == event.end() || !action->is_object() || (step != event.end() && !step->is_number_integer()))
        return bad();
      if (event.contains("repeatable")) {
        all.real_robots = true;
        if (!is_touch(hal::text_of(*action, "do"))) continue;
      }
      all.actions.push_back({step == event.end() ? entry->tick : step->get<std::int64_t>(), *action});
    }
  }
  for (const RepeatedAction& action : all.actions) {
    if (hal::text_of(action.action, "do") == "reset") all.fingerprints.clear();  // ticks are had twice
  }
  return all;
}

}  // namespace tandem::core
