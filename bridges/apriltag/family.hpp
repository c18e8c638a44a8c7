// Families of AprilTags, and their patterns.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

struct apriltag_family;

namespace tandem::bridges::apriltag {

/// tag36h11 first, which suits most.
std::span<const std::string_view> family_names() noexcept;

/// The library's own, of that name.
std::shared_ptr<apriltag_family> make_family(std::string_view name);

/// A tag as it is printed.
struct Pattern {
  std::size_t cells = 0;            ///< along a side, with the white edge
  std::size_t size_cells = 0;       ///< along a side of the square between whose corners a tag's size is measured
  std::vector<std::uint8_t> white;  ///< of each cell: 1 white, 0 black; from the upper left, line by line
};

/// Errors: no such family, no such tag of it.
hal::Result<Pattern> pattern(std::string_view family, std::size_t id);
/// Errors: no such family.
hal::Result<std::size_t> count_of_tags(std::string_view family);

}  // namespace tandem::bridges::apriltag
