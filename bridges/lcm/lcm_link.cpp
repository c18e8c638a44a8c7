#include "bridges/lcm/lcm_link.hpp"

#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <deque>
#include <lcm/lcm.h>
#include <mutex>
#include <poll.h>
#include <sys/eventfd.h>
#include <thread>
#include <unistd.h>

namespace tandem::bridges::lcm_bus {
namespace {

constexpr int kQueue = 10000;  // messages of one subscription that wait for the thread
constexpr std::size_t kLongestChannel = 63;

bool starts_with(std::string_view text, std::string_view head) {
  return text.substr(0, head.size()) == head;
}

/// Errors that LCM itself only prints, or does not notice.
hal::Status check_url(const std::string& url) {
  if (url == "memq://") return {};
  const std::string who = "LCM url '" + url + "'";
  if (!starts_with(url, "udpm://")) {
    return hal::Error{who + " is not of a kind that is known here; write udpm://GROUP:PORT?ttl=N, for example " +
                      std::string(kDefaultLcmUrl) + ", or memq:// within one program"};
  }
  const std::string group = url.substr(7, url.find_first_of(":?", 7) - 7);
  if (group.empty()) return {};  // LCM's own
  const int first = std::isdigit(static_cast<unsigned char>(group[0])) != 0 ? std::stoi(group.substr(0, 3)) : 0;
  if (first < 224 || first > 239) {
    return hal::Error{who + ": '" + group +
                      "' is no multicast group; groups lie between 224.0.0.0 and 239.255.255.255, LCM's own is "
                      "239.255.76.67"};
  }
  return {};
}

}  // namespace

struct LcmLink::Engine {
  struct Subscription {
    Engine* engine;
    Handler handler;
  };

  lcm_t* lcm = nullptr;
  int wake = -1;  // eventfd: the thread is to end
  std::mutex mutex;
  std::deque<Subscription> subscriptions;  // stay where they are
  std::thread thread;
  std::atomic<std::uint64_t> received{0}, received_bytes{0}, published{0}, published_bytes{0}, unsent{0}, dropped{0};

  static void handle(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
    const auto* subscription = static_cast<const Subscription*>(user);
    Engine& engine = *subscription->engine;
    engine.received.fetch_add(1, std::memory_order_relaxed);
    engine.received_bytes.fetch_add(buffer->data_size, std::memory_order_relaxed);
    try {
      subscription->handler(
          {channel, {static_cast<const std::byte*>(buffer->data), buffer->data_size}, monotonic_ns()});
    } catch (...) {  // must not pass through C
      engine.dropped.fetch_add(1, std::memory_order_relaxed);
    }
  }

  void drain() {
    std::array<pollfd, 2> waits = {{{lcm_get_fileno(lcm), POLLIN, 0}, {wake, POLLIN, 0}}};
    for (;;) {
      if (::poll(waits.data(), waits.size(), -1) < 0) {
        if (errno == EINTR) continue;
        return;
      }
      if (waits[1].revents != 0) return;
      if (lcm_handle(lcm) == 0) continue;
      dropped.fetch_add(1, std::memory_order_relaxed);
      const timespec pause{0, static_cast<long>(hal::kNsPerMs)};  // a broken socket must not spin
      ::nanosleep(&pause, nullptr);
    }
  }
};

LcmLink::LcmLink(std::string url) : url_(std::move(url)), engine_(std::make_unique<Engine>()) {}

hal::Result<std::shared_ptr<LcmLink>> LcmLink::open(const std::string& url) {
  std::shared_ptr<LcmLink> link(new LcmLink(url.empty() ? std::string(kDefaultLcmUrl) : url));
  if (const hal::Status usable = check_url(link->url_); !usable) return usable.error();
  link->engine_->lcm = lcm_create(link->url_.c_str());
  if (link->engine_->lcm == nullptr) {
    return hal::Error{"LCM cannot be opened at '" + link->url_ +
                      "': the group or port is none, or this machine has no route for multicast; without a network "
                      "make one with `ip link set lo up; ip route add 224.0.0.0/4 dev lo`"};
  }
  return link;
}

LcmLink::~LcmLink() {
  if (engine_->thread.joinable()) {
    const std::uint64_t one = 1;
    while (::write(engine_->wake, &one, sizeof one) < 0 && errno == EINTR) continue;
    engine_->thread.join();
  }
  if (engine_->wake >= 0) ::close(engine_->wake);
  if (engine_->lcm != nullptr) lcm_destroy(engine_->lcm);
}

hal::Status LcmLink::subscribe(const std::string& channel_regex, Handler handler) {
  const std::lock_guard lock(engine_->mutex);
  Engine::Subscription& subscription =
      engine_->subscriptions.emplace_back(Engine::Subscription{engine_.get(), std::move(handler)});
  lcm_subscription_t* made = lcm_subscribe(engine_->lcm, channel_regex.c_str(), &Engine::handle, &subscription);
  if (made == nullptr) {
    engine_->subscriptions.pop_back();
    return hal::Error{
        "LCM at '" + url_ + "' does not let '" + channel_regex +
        "' be subscribed to: it is no regular expression, or multicast does not come back to this machine"};
  }
  lcm_subscription_set_queue_capacity(made, kQueue);
  return {};
}

hal::Status LcmLink::start() {
  const std::lock_guard lock(engine_->mutex);
  if (engine_->thread.joinable()) return {};
  engine_->wake = ::eventfd(0, EFD_CLOEXEC);
  if (engine_->wake < 0) {
    return hal::Error{"LCM at '" + url_ + "' cannot be listened to: " + std::strerror(errno)};
  }
  engine_->thread = std::thread([engine = engine_.get()] { engine->drain(); });
  return {};
}

bool LcmLink::publish(const std::string& channel, std::span<const std::byte> data) noexcept {
  const bool fits = !channel.empty() && channel.size() <= kLongestChannel;
  if (!fits || lcm_publish(engine_->lcm, channel.c_str(), data.data(), static_cast<unsigned>(data.size())) != 0) {
    engine_->unsent.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  engine_->published.fetch_add(1, std::memory_order_relaxed);
  engine_->published_bytes.fetch_add(data.size(), std::memory_order_relaxed);
  return true;
}

LcmStatistics LcmLink::statistics() const noexcept {
  LcmStatistics s;
  s.received = engine_->received.load(std::memory_order_relaxed);
  s.received_bytes = engine_->received_bytes.load(std::memory_order_relaxed);
  s.published = engine_->published.load(std::memory_order_relaxed);
  s.published_bytes = engine_->published_bytes.load(std::memory_order_relaxed);
  s.unsent = engine_->unsent.load(std::memory_order_relaxed);
  s.dropped = engine_->dropped.load(std::memory_order_relaxed);
  return s;
}

}  // namespace tandem::bridges::lcm_bus
