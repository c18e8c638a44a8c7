// Event log of an emulated robot, one JSON object a line.
#pragma once
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// A name and a number, numbers, text or truth.
struct EventField {
  EventField(std::string_view n, bool v) : name(n), value(v) {}
  EventField(std::string_view n, std::integral auto v) : name(n), value(static_cast<std::int64_t>(v)) {}
  EventField(std::string_view n, double v) : name(n), value(v) {}
  EventField(std::string_view n, std::string_view v) : name(n), value(std::string(v)) {}
  EventField(std::string_view n, const std::string& v) : name(n), value(v) {}
  EventField(std::string_view n, const char* v) : name(n), value(std::string(v)) {}
  EventField(std::string_view n, std::vector<std::int64_t> v) : name(n), value(std::move(v)) {}

  std::string_view name;
  std::variant<bool, std::int64_t, double, std::string, std::vector<std::int64_t>> value;
};

using EventFields = std::vector<EventField>;

/// Takes events as they happen. `at` is CLOCK_MONOTONIC under a server, any clock in tests.
using EventSink = std::function<void(hal::TimeNs at, std::string_view event, const EventFields& fields)>;

/// {"t_ns":12,"event":"wheels","left":500,"right":-500} without line end. Texts are UTF-8; bytes
/// that are not become U+FFFD.
std::string to_json(hal::TimeNs at, std::string_view event, const EventFields& fields);

/// Appends to a file and flushes after every line, so that a killed emulator loses none.
class EventLog {
 public:
  /// Starts `path` again. Errors: the file cannot be written.
  static hal::Result<std::unique_ptr<EventLog>> open(const std::string& path);

  void write(hal::TimeNs at, std::string_view event, const EventFields& fields);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  explicit EventLog(std::FILE* file) : file_(file) {}
  std::unique_ptr<std::FILE, Close> file_;
};

/// Writes to the log of this name, if it is not empty, and hands on to `listener`, if it is not. Errors: as
/// EventLog::open.
hal::Result<EventSink> open_event_sink(const std::string& log_file, EventSink listener);

/// Stamps never go back, although a robot's are of the past by up to one turn of its server.
EventSink in_order(EventSink sink);

}  // namespace tandem::bridges
