#include "bridges/tracker_emulator/messages.hpp"

#include <bit>
#include <limits>

#include "hal/json/json.hpp"

namespace tandem::bridges::tracker_emulator {
namespace {

using Message = std::vector<std::byte>;

constexpr std::uint64_t kPosesType = 0x3B0C721C5A9738D7;  // of tandem.poses_t
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void append(Message& message, const std::string& text, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i)
    message.push_back(i < text.size() ? static_cast<std::byte>(text[i]) : std::byte{0});
}

void append_low_first(Message& message, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) message.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFFU));
}
void append_float(Message& message, double value) {
  append_low_first(message, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
}

void append_high_first(Message& message, std::uint64_t value, int bytes) {
  for (int i = bytes; i-- > 0;) message.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFFU));
}
void append_double(Message& message, double value) {
  append_high_first(message, std::bit_cast<std::uint64_t>(value), 8);
}

}  // namespace

Message json_message(const Exposure& exposure) {
  hal::Json line;
  line["t_ns"] = exposure.stamp_ns;
  line["poses"] = hal::Json::array();
  for (const Seen& seen : exposure.seen) {
    hal::Json pose{{"id", seen.name}, {"x", seen.x_m}, {"y", seen.y_m}};
    if (seen.heading_rad) pose["heading"] = *seen.heading_rad;
    if (exposure.sd_m > 0.0) pose["sd"] = exposure.sd_m;
    if (exposure.sd_rad > 0.0) pose["sd_heading"] = exposure.sd_rad;
    line["poses"].push_back(std::move(pose));
  }
  const std::string text = hal::to_text(line) + "\n";
  Message message;
  append(message, text, text.size());
  return message;
}

Message compact_message(const Exposure& exposure) {
  Message message;
  append(message, "TDP1", 4);
  append_low_first(message, exposure.seen.size(), 2);
  append_low_first(message, 0, 2);
  append_low_first(message, static_cast<std::uint64_t>(exposure.stamp_ns), 8);
  for (const Seen& seen : exposure.seen) {
    append(message, seen.name, 16);
    for (const double value :
         {seen.x_m, seen.y_m, 0.0, seen.heading_rad.value_or(kNone), exposure.sd_m, exposure.sd_rad})
      append_float(message, value);
  }
  return message;
}

Message lcm_message(const Exposure& exposure) {
  Message message;
  append_high_first(message, kPosesType, 8);
  append_high_first(message, static_cast<std::uint64_t>(exposure.stamp_ns), 8);
  append_high_first(message, exposure.seen.size(), 4);
  for (const Seen& seen : exposure.seen) {
    append_high_first(message, seen.name.size() + 1, 4);
    append(message, seen.name, seen.name.size() + 1);
    for (const double value :
         {seen.x_m, seen.y_m, 0.0, seen.heading_rad.value_or(kNone), exposure.sd_m, exposure.sd_rad})
      append_double(message, value);
  }
  return message;
}

}  // namespace tandem::bridges::tracker_emulator
