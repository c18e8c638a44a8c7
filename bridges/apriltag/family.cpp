#include "bridges/apriltag/family.hpp"

#include <algorithm>
#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>
#include <array>

namespace tandem::bridges::apriltag {
namespace {

struct Entry {
  std::string_view name;
  apriltag_family_t* (*make)();
  void (*destroy)(apriltag_family_t*);
};

constexpr std::array<Entry, 6> kEntries = {{
    {"tag36h11", &tag36h11_create, &tag36h11_destroy},
    {"tag36h10", &tag36h10_create, &tag36h10_destroy},
    {"tag25h9", &tag25h9_create, &tag25h9_destroy},
    {"tag16h5", &tag16h5_create, &tag16h5_destroy},
    {"tagStandard41h12", &tagStandard41h12_create, &tagStandard41h12_destroy},
    {"tagStandard52h13", &tagStandard52h13_create, &tagStandard52h13_destroy},
}};

constexpr auto kNames = [] {
  std::array<std::string_view, kEntries.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kEntries[i].name;
  return names;
}();

hal::Error no_such(std::string_view name) {
  std::string all;
  for (const std::string_view known : kNames) all += (all.empty() ? "" : ", ") + std::string(known);
  return hal::Error{"there is no family of tags '" + std::string(name) + "'; there are: " + all};
}

}  // namespace

std::span<const std::string_view> family_names() noexcept {
  return kNames;
}

std::shared_ptr<apriltag_family> make_family(std::string_view name) {
  const auto entry = std::find_if(kEntries.begin(), kEntries.end(), [&](const Entry& e) { return e.name == name; });
  if (entry == kEntries.end()) return nullptr;
  return {entry->make(), entry->destroy};
}

hal::Result<std::size_t> count_of_tags(std::string_view family) {
  const auto made = make_family(family);
  if (made == nullptr) return no_such(family);
  return std::size_t{made->ncodes};
}

hal::Result<Pattern> pattern(std::string_view family, std::size_t id) {
  const auto made = make_family(family);
  if (made == nullptr) return no_such(family);
  if (id >= made->ncodes)
    return hal::Error{"the family " + std::string(family) + " has no tag " + std::to_string(id) + ", only 0 to " +
                      std::to_string(made->ncodes - 1)};
  image_u8_t* const image = apriltag_to_image(made.get(), static_cast<int>(id));
  Pattern pattern;
  pattern.cells = static_cast<std::size_t>(image->width);
  pattern.size_cells = static_cast<std::size_t>(made->width_at_border);
  for (std::int32_t y = 0; y < image->height; ++y) {
    for (std::int32_t x = 0; x < image->width; ++x)
      pattern.white.push_back(image->buf[y * image->stride + x] > 127 ? 1 : 0);
  }
  image_u8_destroy(image);
  return pattern;
}

}  // namespace tandem::bridges::apriltag
