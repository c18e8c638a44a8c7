#include <cmath>
#include <exception>
#include <tandem/poses_t.hpp>

#include "bridges/trackers/decoding.hpp"

namespace tandem::bridges::trackers {
namespace {

std::uint64_t big_endian(std::span<const std::byte> data, std::size_t at, std::size_t bytes) noexcept {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < bytes; ++i) n = n << 8U | std::to_integer<std::uint64_t>(data[at + i]);
  return n;
}

/// The generated decoder takes lengths as they come, so the whole is walked through before it decodes anything.
bool has_sound_lengths(std::span<const std::byte> data) noexcept {
  constexpr std::size_t kHeader = 8 + 8 + 4, kNumbers = 6 * 8;
  if (data.size() < kHeader || big_endian(data, 0, 8) != static_cast<std::uint64_t>(poses_t::getHash())) return false;
  const std::uint64_t count = big_endian(data, 16, 4);
  if (count > kMostPoses) return false;
  std::size_t at = kHeader;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (data.size() - at < 4) return false;
    const auto length = static_cast<std::size_t>(big_endian(data, at, 4));  // with the zero at its end
    at += 4;
    if (length < 2 || length > Sighting::kLongestName + 1 || data.size() - at < length + kNumbers) return false;
    const auto text = data.subspan(at, length);
    if (std::find(text.begin(), text.end(), std::byte{0}) != text.end() - 1) return false;
    at += length + kNumbers;
  }
  return at == data.size();
}

}  // namespace

bool decode_lcm(std::span<const std::byte> data, std::vector<Sighting>& out) {
  if (!has_sound_lengths(data)) return false;
  poses_t message;
  try {
    if (message.decode(data.data(), 0, static_cast<int>(data.size())) < 0) return false;
  } catch (const std::exception&) {
    return false;
  }
  const std::size_t before = out.size();
  for (const pose_t& pose : message.poses) {
    Sighting s;
    if (message.stamp_ns != 0) s.stamp_ns = message.stamp_ns;
    s.p_m = {pose.x, pose.y, pose.z};
    if (!std::isnan(pose.heading)) s.heading_rad = pose.heading;
    s.sd_m = told(pose.sd);
    s.sd_rad = told(pose.sd_heading);
    if (!s.set_name(pose.id) || !is_sound(s)) {
      out.resize(before);
      return false;
    }
    out.push_back(s);
  }
  return true;
}

}  // namespace tandem::bridges::trackers
