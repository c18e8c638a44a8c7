#include <cmath>
#include <string_view>

#include "bridges/trackers/decoding.hpp"
#include "hal/json/json.hpp"

namespace tandem::bridges::trackers {
namespace {

constexpr double kLatest_s = 9.0e9;  // of stamps: as nanoseconds in 64 bits

/// A member's number; false: it is there and is none.
bool read(const hal::Json& json, const char* name, std::optional<double>& value) {
  const auto at = json.find(name);
  if (at == json.end() || at->is_null()) return true;
  if (!at->is_number()) return false;
  value = at->get<double>();
  return std::isfinite(*value);
}

bool read_stamp(const hal::Json& json, std::optional<std::int64_t>& stamp_ns) {
  if (const auto at = json.find("t_ns"); at != json.end() && !at->is_null()) {
    if (!at->is_number_integer() || (at->is_number_unsigned() && at->get<std::uint64_t>() > INT64_MAX)) return false;
    stamp_ns = at->get<std::int64_t>();
    return true;
  }
  std::optional<double> seconds;
  if (!read(json, "t", seconds)) return false;
  if (!seconds) return true;
  if (std::fabs(*seconds) > kLatest_s) return false;
  stamp_ns = static_cast<std::int64_t>(std::llround(*seconds * 1e9));
  return true;
}

bool read_name(const hal::Json& json, Sighting& sighting) {
  const auto at = json.find("id");
  if (at == json.end()) return false;
  if (at->is_string()) return sighting.set_name(at->text());
  return at->is_number_unsigned() && sighting.set_name(std::to_string(at->get<std::uint64_t>()));
}

bool read_pose(const hal::Json& json, const std::optional<std::int64_t>& stamp_ns, std::vector<Sighting>& out) {
  if (!json.is_object() || out.size() >= kMostPoses) return false;
  Sighting s;
  s.stamp_ns = stamp_ns;
  std::optional<double> x_m, y_m, z_m;
  if (!read_stamp(json, s.stamp_ns) || !read_name(json, s) || !read(json, "x", x_m) || !read(json, "y", y_m) ||
      !read(json, "z", z_m) || !read(json, "heading", s.heading_rad) || !read(json, "sd", s.sd_m) ||
      !read(json, "sd_heading", s.sd_rad) || !x_m || !y_m)
    return false;
  s.p_m = {*x_m, *y_m, z_m.value_or(0.0)};
  out.push_back(s);
  return is_sound(s);
}

bool read_line(std::string_view line, std::vector<Sighting>& out) {
  const auto parsed = hal::parse_json_object(line);
  if (!parsed.ok()) return false;
  const hal::Json& json = parsed.value();
  const auto poses = json.find("poses");
  if (poses == json.end()) return read_pose(json, {}, out);
  std::optional<std::int64_t> stamp_ns;
  if (!poses->is_array() || !read_stamp(json, stamp_ns)) return false;
  for (const hal::Json& pose : *poses) {
    if (!read_pose(pose, stamp_ns, out)) return false;
  }
  return true;
}

}  // namespace

bool is_sound(const Sighting& s) noexcept {
  const auto positive = [](const std::optional<double>& sd) { return !sd || (std::isfinite(*sd) && *sd > 0.0); };
  return std::isfinite(s.p_m[0]) && std::isfinite(s.p_m[1]) && std::isfinite(s.p_m[2]) &&
         std::isfinite(s.heading_rad.value_or(0.0)) && positive(s.sd_m) && positive(s.sd_rad);
}

bool decode_json(std::span<const std::byte> data, std::vector<Sighting>& out) {
  const std::string_view text(reinterpret_cast<const char*>(data.data()), data.size());
  std::vector<Sighting> found;
  bool any = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    any = true;
    if (!read_line(line, found)) return false;
  }
  out.insert(out.end(), found.begin(), found.end());
  return any;
}

}  // namespace tandem::bridges::trackers
