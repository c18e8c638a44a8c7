#include "bridges/sighting_box.hpp"

namespace tandem::bridges {

void SightingBox::put(std::span<const Sighting> sightings, bool malformed) {
  const std::lock_guard lock(mutex_);
  ++report_.messages;
  if (malformed) ++report_.malformed;
  report_.sightings += sightings.size();
  for (const Sighting& sighting : sightings) {
    if (count_ == kRoom) {
      first_ = (first_ + 1) % kRoom;
      --count_;
      ++report_.dropped;
    }
    ring_[(first_ + count_++) % kRoom] = sighting;
  }
}

void SightingBox::set_trouble(const std::string& text) {
  const std::lock_guard lock(mutex_);
  report_.trouble = text;
}

std::size_t SightingBox::take(std::span<Sighting> into) noexcept {
  const std::lock_guard lock(mutex_);
  const std::size_t taken = std::min(into.size(), count_);
  for (std::size_t i = 0; i < taken; ++i) into[i] = ring_[(first_ + i) % kRoom];
  first_ = (first_ + taken) % kRoom;
  count_ -= taken;
  return taken;
}

TrackerReport SightingBox::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

}  // namespace tandem::bridges
