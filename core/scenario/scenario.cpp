#include "core/scenario/scenario.hpp"

namespace tandem::core {

hal::Result<std::uint8_t> medium_number(const std::vector<MediumConfig>& media, std::string_view kind,
                                        const std::string& id) {
  if (id.empty()) return std::uint8_t{0};
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < media.size(); ++i) {
    if (media[i].kind != kind) continue;
    if (media[i].id == id) return static_cast<std::uint8_t>(i + 1);
    ids.push_back(media[i].id);
  }
  return hal::Error{"<media> has no <" + std::string(kind) + "> with id '" + id + "'; it has: " + listed(ids) +
                    did_you_mean(id, ids)};
}

}  // namespace tandem::core
