#include "bridges/emulation/event_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/json/json.hpp"

namespace tandem::bridges {

std::string to_json(hal::TimeNs at, std::string_view event, const EventFields& fields) {
  hal::Json line{{"t_ns", at}, {"event", event}};
  for (const EventField& f : fields) std::visit([&](const auto& value) { line[std::string(f.name)] = value; }, f.value);
  return hal::to_text(line);
}

hal::Result<std::unique_ptr<EventLog>> EventLog::open(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "we");
  if (file == nullptr) return hal::Error{"cannot write the log '" + path + "': " + std::strerror(errno)};
  return std::unique_ptr<EventLog>(new EventLog(file));
}

void EventLog::write(hal::TimeNs at, std::string_view event, const EventFields& fields) {
  const std::string line = to_json(at, event, fields) + "\n";
  std::fwrite(line.data(), 1, line.size(), file_.get());
  std::fflush(file_.get());
}

hal::Result<EventSink> open_event_sink(const std::string& log_file, EventSink listener) {
  if (log_file.empty())
    return listener ? std::move(listener) : [](hal::TimeNs, std::string_view, const EventFields&) {};
  auto opened = EventLog::open(log_file);
  if (!opened.ok()) return opened.error();
  return EventSink([log = std::shared_ptr<EventLog>(std::move(opened).value()), listener = std::move(listener)](
                       hal::TimeNs at, std::string_view event, const EventFields& fields) {
    log->write(at, event, fields);
    if (listener) listener(at, event, fields);
  });
}

EventSink in_order(EventSink sink) {
  return [sink = std::move(sink), last = std::make_shared<hal::TimeNs>(0)](hal::TimeNs at, std::string_view event,
                                                                           const EventFields& fields) {
    *last = std::max(*last, at);
    sink(*last, event, fields);
  };
}

}  // namespace tandem::bridges
