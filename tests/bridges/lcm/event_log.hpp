// Reads the files that LCM's recorder writes.
#pragma once
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace tandem::bridges::lcm_bus {

struct LoggedEvent {
  std::int64_t number = 0;
  std::int64_t utime = 0;  // microseconds since 1970
  std::string channel;
  std::string data;
};

/// Events of a file as far as they are whole. Each: the word EDA1DA01, then, all big-endian, number and time in 8 bytes
/// each, lengths of channel and data in 4 each, channel, data [lcm 1.3.1, eventlog.c].
inline std::vector<LoggedEvent> read_event_log(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::uint64_t n = 0;
    for (std::size_t i = 0; i < bytes; ++i) n = n << 8 | static_cast<std::uint8_t>(all[at + i]);
    return n;
  };
  std::vector<LoggedEvent> events;
  for (std::size_t at = 0; at + 28 <= all.size();) {
    if (number(at, 4) != 0xEDA1DA01U) break;
    const auto channel = static_cast<std::size_t>(number(at + 20, 4)),
               data = static_cast<std::size_t>(number(at + 24, 4));
    if (at + 28 + channel + data > all.size()) break;
    events.push_back({static_cast<std::int64_t>(number(at + 4, 8)), static_cast<std::int64_t>(number(at + 12, 8)),
                      all.substr(at + 28, channel), all.substr(at + 28 + channel, data)});
    at += 28 + channel + data;
  }
  return events;
}

}  // namespace tandem::bridges::lcm_bus
