#include "bridges/emulation/event_log.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>

#include "hal/unit.hpp"

namespace tandem::bridges {
namespace {

void append_text(std::string& out, std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte >= 0x7F) {
      out += "\\u00";
      out += kHex[byte >> 4U];
      out += kHex[byte & 15U];
    } else {
      out += c;
    }
  }
  out += '"';
}

struct ValueWriter {
  std::string& out;
  void operator()(bool v) const { out += v ? "true" : "false"; }
  void operator()(std::int64_t v) const { out += std::to_string(v); }
  void operator()(double v) const { out += std::isfinite(v) ? hal::format_number(v) : "null"; }
  void operator()(const std::string& v) const { append_text(out, v); }
  void operator()(const std::vector<std::int64_t>& v) const {
    out += '[';
    for (std::size_t i = 0; i < v.size(); ++i) out += (i == 0 ? "" : ",") + std::to_string(v[i]);
    out += ']';
  }
};

}  // namespace

std::string to_json(hal::TimeNs at, std::string_view event, const EventFields& fields) {
  std::string line = "{\"t_ns\":" + std::to_string(at) + ",\"event\":";
  append_text(line, event);
  for (const EventField& f : fields) {
    line += ',';
    append_text(line, f.name);
    line += ':';
    std::visit(ValueWriter{line}, f.value);
  }
  return line + "}";
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
