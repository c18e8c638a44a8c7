#include "bridges/trackers/lcm_tracker.hpp"

#include "bridges/sighting_box.hpp"
#include "bridges/trackers/decoding.hpp"

namespace tandem::bridges::trackers {
namespace {

class LcmTracker final : public Tracker {
 public:
  LcmTracker(std::string url, std::string channel) : url_(std::move(url)), channel_(std::move(channel)) {}
  LcmTracker(std::shared_ptr<lcm_bus::LcmLink> link, std::string channel)
      : url_(link->url()), channel_(std::move(channel)), link_(std::move(link)) {}

  hal::Status start() override {
    if (started_) return {};
    if (link_ == nullptr) {
      auto opened = lcm_bus::LcmLink::open(url_);
      if (!opened.ok()) return opened.error();
      link_ = std::move(opened).value();
    }
    const hal::Status subscribed = link_->subscribe(channel_, [box = box_](const lcm_bus::LcmMessage& message) {
      std::vector<Sighting> seen;
      const bool good = decode_lcm(message.data, seen);
      for (Sighting& sighting : seen) sighting.received_ns = message.received_ns;
      box->put(seen, !good);
    });
    if (!subscribed.ok()) return subscribed;
    started_ = true;
    return link_->start();
  }
  std::size_t take(std::span<Sighting> into) noexcept override { return box_->take(into); }
  TrackerReport report() const override { return box_->report(); }

 private:
  std::string url_, channel_;
  std::shared_ptr<lcm_bus::LcmLink> link_;
  std::shared_ptr<SightingBox> box_ = std::make_shared<SightingBox>();  // the link's thread may outlive this
  bool started_ = false;
};

}  // namespace

std::unique_ptr<Tracker> make_lcm_tracker(std::shared_ptr<lcm_bus::LcmLink> link, const std::string& channel) {
  return std::make_unique<LcmTracker>(std::move(link), channel);
}

MadeTracker make_lcm_tracker(const TrackerRequest& request, const hal::Log&) {
  if (const hal::Status good = check_lcm_tracker(request); !good.ok()) return good.error();
  const auto options = options_of<LcmOptions>(request);
  return std::unique_ptr<Tracker>(std::make_unique<LcmTracker>(options.url, options.channel));
}

hal::Status check_lcm_tracker(const TrackerRequest& request) {
  if (options_of<LcmOptions>(request).channel.empty()) return hal::Error{"'channel' must not be empty"};
  return {};
}

}  // namespace tandem::bridges::trackers
