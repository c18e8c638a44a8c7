#include "core/record/pose_numbers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace tandem::core {
namespace {

// Four values are worked on together: one AVX register or two SSE ones, with the same bits.
constexpr std::size_t kLanes = 4;
using Lanes = double __attribute__((vector_size(32)));
using Masks = std::int64_t __attribute__((vector_size(32)));
using Numbers = std::int32_t __attribute__((vector_size(16)));

constexpr double kLargest = 2147483647.0;

// References, because registers of this size are not passed alike by all compilations.
[[gnu::always_inline]] inline void store_rounded(const Lanes& value, std::int32_t* out) noexcept {
  const Lanes low = Lanes{} - 2147483648.0, most = Lanes{} + kLargest;
  const Lanes kept = ((value <= most) & (value >= -most)) ? value : low;  // what is no number fits neither
  const Lanes shifted = kept + 6755399441055744.0;  // 1.5 * 2^52: the nearest whole number is in the low bits
  Masks bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  const Numbers numbers = __builtin_convertvector(bits, Numbers);
  std::memcpy(out, &numbers, sizeof numbers);
}

/// After turning by an eighth, so that what is left is below 1: odd polynomial of 7 terms, fitted at Chebyshev's points
/// of [0, tan(pi/8)]; 8e-12 rad off at most.
[[gnu::always_inline]] inline void store_angle(const Lanes& c, const Lanes& s, std::int32_t* out) noexcept {
  constexpr double kEighth = 0.41421356237309503;  // tan(pi/8)
  const Lanes zero{}, one = zero + 1.0;
  const Lanes width = c < zero ? -c : c, height = s < zero ? -s : s;
  const Masks upright = height > width;
  const Lanes large = upright ? height : width, small = upright ? width : height;
  const Masks steep = small > large * kEighth;
  const Lanes over = steep ? small - large : small;
  const Lanes whole = steep ? small + large : large;
  const Lanes t = over / (whole == zero ? one : whole);
  const Lanes u = t * t;
  Lanes p = zero + 0.04713016984915703;
  p = p * u - 0.08459118463944612;
  p = p * u + 0.11041055791716257;
  p = p * u - 0.14281639390054146;
  p = p * u + 0.19999885903353987;
  p = p * u - 0.3333333212793961;
  p = p * u + 0.9999999999792089;
  Lanes angle = t * p * (1.0 / kBinaryAngle);
  angle = steep ? angle + 536870912.0 : angle;  // 2^29: an eighth of a turn
  angle = upright ? 1073741824.0 - angle : angle;
  angle = c < zero ? 2147483648.0 - angle : angle;
  const Lanes most = zero + kLargest;
  angle = angle > most ? most : angle;  // half a turn
  store_rounded(s < zero ? -angle : angle, out);
}

/// Of whole fours.
[[gnu::always_inline]] inline void metres(const double* from, std::size_t count, std::int32_t* out) noexcept {
  for (std::size_t i = 0; i + kLanes <= count; i += kLanes) {
    Lanes value;
    std::memcpy(&value, from + i, sizeof value);
    store_rounded(value * (1.0 / kMicrometre), out + i);
  }
}

[[gnu::always_inline]] inline void angles(const double* cosine, const double* sine, std::size_t count,
                                          std::int32_t* out) noexcept {
  for (std::size_t i = 0; i + kLanes <= count; i += kLanes) {
    Lanes c, s;
    std::memcpy(&c, cosine + i, sizeof c);
    std::memcpy(&s, sine + i, sizeof s);
    store_angle(c, s, out + i);
  }
}

#if defined(__x86_64__) || defined(__i386__)
__attribute__((target("avx2"))) void metres_avx2(const double* from, std::size_t count, std::int32_t* out) noexcept {
  metres(from, count, out);
}
__attribute__((target("avx2"))) void angles_avx2(const double* cosine, const double* sine, std::size_t count,
                                                 std::int32_t* out) noexcept {
  angles(cosine, sine, count, out);
}
bool detect_avx2() noexcept {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") != 0;
}
const bool kHasAvx2 = detect_avx2();
#else
constexpr bool kHasAvx2 = false;
void metres_avx2(const double* from, std::size_t count, std::int32_t* out) noexcept {
  metres(from, count, out);
}
void angles_avx2(const double* cosine, const double* sine, std::size_t count, std::int32_t* out) noexcept {
  angles(cosine, sine, count, out);
}
#endif

constexpr std::size_t whole_part(std::size_t count) noexcept {
  return count / kLanes * kLanes;
}

/// The last ones, padded to four.
struct Rest {
  Rest(std::span<const double> values, std::size_t from) {
    std::copy(values.begin() + static_cast<std::ptrdiff_t>(from), values.end(), padded.begin());
  }
  std::array<double, kLanes> padded{};
};

}  // namespace

void to_micrometres(std::span<const double> from, std::span<std::int32_t> out) noexcept {
  const std::size_t whole = whole_part(from.size());
  (kHasAvx2 ? metres_avx2 : metres)(from.data(), whole, out.data());
  if (whole == from.size()) return;
  const Rest rest(from, whole);
  std::array<std::int32_t, kLanes> last;
  metres(rest.padded.data(), kLanes, last.data());
  std::copy_n(last.begin(), from.size() - whole, out.begin() + static_cast<std::ptrdiff_t>(whole));
}

void to_binary_angles(std::span<const double> cosine, std::span<const double> sine,
                      std::span<std::int32_t> out) noexcept {
  const std::size_t whole = whole_part(cosine.size());
  (kHasAvx2 ? angles_avx2 : angles)(cosine.data(), sine.data(), whole, out.data());
  if (whole == cosine.size()) return;
  const Rest c(cosine, whole), s(sine, whole);
  std::array<std::int32_t, kLanes> last;
  angles(c.padded.data(), s.padded.data(), kLanes, last.data());
  std::copy_n(last.begin(), cosine.size() - whole, out.begin() + static_cast<std::ptrdiff_t>(whole));
}

}  // namespace tandem::core
