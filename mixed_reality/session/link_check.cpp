// Stops robots whose links are swapped, as far as trackers see them.
#include "hal/unit.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/tracking/fused_pose.hpp"

namespace tandem::mixed_reality {

/// By the wheels as they were latched last, and what trackers have seen since.
void MixedSession::compare_links() {
  if (trackers_.empty() || phase_ != RunPhase::Running) return;
  links_.resize(twins_.size());
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    const auto* const encoders = twins_[i]->encoders();
    if (encoders == nullptr || fused_[i] == nullptr) continue;
    const double wheel_base_m = world_->space().kind(twins_[i]->robot()).drive()->wheel_base_m;
    links_.note(i, *encoders, wheel_base_m, fused_[i]->newest_sighting(), now_);
  }
  for (const SwappedLinks::Found& found : links_.judge(now_.monotonic_ns)) {
    Twin &one = *twins_[found.robot], &other = *twins_[found.moves_as];
    options_.log.error("robots '" + one.id() + "' and '" + other.id() +
                       "': their links seem to be swapped: the wheels of '" + one.id() + "' roll as '" + other.id() +
                       "' is seen to move; see <bridge link=…> and <tracker id=…>, mend it, and re-arm them");
    one.links_seem_swapped("its wheels roll as '" + other.id() + "' is seen to move: their links seem to be swapped");
    other.links_seem_swapped("it moves as the wheels of '" + one.id() + "' roll: their links seem to be swapped");
  }
}

}  // namespace tandem::mixed_reality
