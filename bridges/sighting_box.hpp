// Box for a tracker thread's sightings, until the hub takes them.
#pragma once
#include <cstddef>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "bridges/tracker.hpp"

namespace tandem::bridges {

/// Holds a bounded number of sightings; when it is full the oldest goes. Allocates when it is made, never later.
class SightingBox {
 public:
  static constexpr std::size_t kRoom = 4096;
  SightingBox() : ring_(kRoom) {}

  /// One message came: with these sightings, and perhaps malformed, at least in part.
  void put(std::span<const Sighting> sightings, bool malformed);
  void set_trouble(const std::string& text);

  std::size_t take(std::span<Sighting> into) noexcept;
  TrackerReport report() const;

 private:
  mutable std::mutex mutex_;
  std::vector<Sighting> ring_;
  std::size_t first_ = 0, count_ = 0;
  TrackerReport report_;
};

}  // namespace tandem::bridges
