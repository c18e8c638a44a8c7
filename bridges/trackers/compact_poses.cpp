#include <bit>
#include <cmath>

#include "bridges/trackers/decoding.hpp"

namespace tandem::bridges::trackers {
namespace {

constexpr std::array<unsigned char, 4> kMagic = {'T', 'D', 'P', '1'};
constexpr std::size_t kHeader = 16, kName = 16, kRow = 40;

std::uint64_t little_endian(std::span<const std::byte> data, std::size_t at, std::size_t bytes) noexcept {
  std::uint64_t n = 0;
  for (std::size_t i = bytes; i-- > 0;) n = n << 8U | std::to_integer<std::uint64_t>(data[at + i]);
  return n;
}

double number(std::span<const std::byte> data, std::size_t at) noexcept {
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(little_endian(data, at, 4))));
}

}  // namespace

bool is_compact(std::span<const std::byte> data) noexcept {
  if (data.size() < kMagic.size()) return false;
  for (std::size_t i = 0; i < kMagic.size(); ++i) {
    if (std::to_integer<unsigned char>(data[i]) != kMagic[i]) return false;
  }
  return true;
}

bool decode_compact(std::span<const std::byte> data, std::vector<Sighting>& out) {
  if (data.size() < kHeader || !is_compact(data)) return false;
  const std::uint64_t count = little_endian(data, 4, 2), flags = little_endian(data, 6, 2);
  if (flags != 0 || count > kMostPoses || data.size() != kHeader + kRow * count) return false;
  const auto stamp_ns = static_cast<std::int64_t>(little_endian(data, 8, 8));
  const std::size_t before = out.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = data.subspan(kHeader + kRow * i, kRow);
    Sighting s;
    std::string_view name(reinterpret_cast<const char*>(row.data()), kName);
    name = name.substr(0, name.find('\0'));
    if (stamp_ns != 0) s.stamp_ns = stamp_ns;
    s.p_m = {number(row, kName), number(row, kName + 4), number(row, kName + 8)};
    const double heading_rad = number(row, kName + 12);
    if (!std::isnan(heading_rad)) s.heading_rad = heading_rad;
    s.sd_m = told(number(row, kName + 16));
    s.sd_rad = told(number(row, kName + 20));
    if (!s.set_name(name) || !is_sound(s)) {
      out.resize(before);
      return false;
    }
    out.push_back(s);
  }
  return true;
}

}  // namespace tandem::bridges::trackers
