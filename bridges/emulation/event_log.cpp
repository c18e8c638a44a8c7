#include "bridges/emulation/event_log.hpp"

#include <cerrno>
#include <cstring>

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

}  // namespace tandem::bridges
