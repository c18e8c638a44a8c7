#include "window/server.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <csignal>
#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include "hal/token.hpp"
#include "window/viewer.hpp"
#include "window/visitor.hpp"

namespace tandem::window {
namespace {

constexpr auto kHousekeeping = std::chrono::milliseconds(250);
constexpr auto kStateEvery = std::chrono::milliseconds(500);
constexpr auto kFarewell = std::chrono::milliseconds(500);
constexpr int kSendBuffer = 128 << 10;          // little, so that a slow viewer is not shown what was long ago
constexpr std::size_t kMostVisitors = 128;      // that have not shown the token of an operator
constexpr std::size_t kMostOfAnAddress = 64;    // of these
constexpr std::size_t kPlacesOfOperators = 16;  // of those of viewers

}  // namespace

hal::Status Server::open() {
  ErrorCode error;
  const auto where = net::ip::make_address(options.address, error);
  if (error)
    return hal::Error{"window: '" + options.address +
                      "' is no address in numbers; 127.0.0.1 is this machine alone, 0.0.0.0 all of its networks"};
  const tcp::endpoint endpoint(where, options.port);
  const auto failed = [&](const std::string& what) {
    return hal::Error{"window: " + options.address + " port " + std::to_string(options.port) + ": " + what};
  };
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
  if (error == net::error::address_in_use)
    return failed("another program has this port; choose another one, or none: then any that is free is taken");
  if (error == net::error::access_denied) return failed("ports below 1024 are the system's; choose one above");
  if (error == boost::system::errc::address_not_available) return failed("this machine does not have this address");
  if (error) return failed(error.message());
  (void)::fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);
  port = acceptor.local_endpoint(error).port();

  char name[256] = {};
  if (::gethostname(name, sizeof name - 1) == 0) doorway.machine = name;
  doorway.origins = options.origins;
  std::string host = where.is_v6() ? "[" + where.to_string() + "]" : where.to_string();
  if (where.is_unspecified() && !doorway.machine.empty()) host = doorway.machine;
  const std::string page = "http://" + host + ":" + std::to_string(port) + "/?token=";
  address = page + token;
  viewers_address = page + viewers_token;
  return {};
}

void Server::start() {
  accept();
  keep_house();
  // Signals are for the thread that steps.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread = std::thread([this] {
    for (;;) {
      try {
        io.run();
        return;
      } catch (const std::exception& e) {
        options.log.error(std::string("window: ") + e.what());
      }
    }
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void Server::stop() {
  net::post(io, [this] {
    over = true;
    ErrorCode ignored;
    acceptor.close(ignored);
    frame_due.cancel();
    for (const auto& viewer : std::vector(viewers)) viewer->close(websocket::close_code::going_away, "the run is over");
    housekeeping.expires_after(viewers.empty() ? Clock::duration::zero() : Clock::duration(kFarewell));
    housekeeping.async_wait([this](ErrorCode) { io.stop(); });
  });
  if (thread.joinable()) thread.join();
  waiting_for_picture.clear();
  viewers.clear();
}

void Server::accept() {
  acceptor.async_accept([this](ErrorCode error, tcp::socket socket) {
    if (over) return;
    if (error) {  // no more file descriptors: others come free
      if (!visitors.empty()) visitors.front()->drop();
      retry.expires_after(kHousekeeping);
      retry.async_wait([this](ErrorCode) {
        if (!over) accept();
      });
      return;
    }
    ErrorCode ignored, gone;
    (void)::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(net::socket_base::send_buffer_size(kSendBuffer), ignored);
    const std::string from = socket.remote_endpoint(gone).address().to_string();
    if (!gone) {
      const auto visitor = std::make_shared<Visitor>(std::move(socket), *this, from);
      enter(*visitor);
      visitor->read();
    }
    accept();
  });
}

// Where places are short, who comes takes that of who has waited longest, of the address that holds most: whoever sends
// a request at once is heard, however many others open connections and say nothing.
void Server::enter(Visitor& visitor) {
  std::map<std::string_view, std::size_t> held;
  for (const Visitor* const other : visitors) ++held[other->address()];
  std::string_view most = visitor.address();
  if (held[most] < kMostOfAnAddress && visitors.size() >= kMostVisitors)
    most = std::max_element(held.begin(), held.end(), [](const auto& a, const auto& b) {
             return a.second < b.second;
           })->first;
  if (held[most] >= kMostOfAnAddress || visitors.size() >= kMostVisitors) {
    const auto longest = std::find_if(visitors.begin(), visitors.end(),
                                      [most](const Visitor* other) { return other->address() == most; });
    (*longest)->drop();
  }
  visitors.push_back(&visitor);
}

void Server::leave(const Visitor& visitor) noexcept {
  std::erase(visitors, &visitor);
}

std::optional<UserRole> Server::role_of(std::string_view given) const noexcept {
  if (hal::same_token(given, token)) return UserRole::Operator;
  if (hal::same_token(given, viewers_token)) return UserRole::Viewer;
  return {};
}

bool Server::has_place(UserRole role) const noexcept {
  const std::size_t kept = role == UserRole::Operator ? 0 : std::min(kPlacesOfOperators, options.most_viewers / 2);
  return viewer_places + kept < options.most_viewers;
}

void Server::come(std::shared_ptr<Viewer> viewer) {
  if (over) return viewer->drop();
  viewers.push_back(viewer);
  viewer_count = viewers.size();
  greet(*viewer);
  if (!state.is_null()) send_state(state);
  wished();
  plan();
}

void Server::go(const Viewer& viewer) {
  const auto found = std::find_if(viewers.begin(), viewers.end(), [&](const auto& v) { return v.get() == &viewer; });
  if (found == viewers.end()) return;
  const auto keep = *found;  // `viewer` lives until the end of this
  viewers.erase(found);
  viewer_count = viewers.size();
  if (over && viewers.empty()) return io.stop();
  set_wishes();
  if (!state.is_null()) send_state(state);
  plan();
}

// Sends the frame that is shown to those who are due for it, and has a new one made when somebody has it already.
void Server::plan() {
  const Clock::time_point now = Clock::now();
  auto next = Clock::time_point::max();
  bool want = false;
  for (const auto& viewer : std::vector(viewers)) {
    if (!viewer->takes_frames()) continue;
    if (viewer->next_frame() > now) {
      next = std::min(next, viewer->next_frame());
    } else if (viewer->frame() != encoder.number()) {
      viewer->pump(now);
    } else {
      want = true;
    }
  }
  {
    const std::lock_guard lock(mutex);
    wants = want && !shown;
  }
  if (next == Clock::time_point::max()) return;
  frame_due.expires_at(next);
  frame_due.async_wait([this](ErrorCode error) {
    if (!error) plan();
  });
}

void Server::keep_house() {
  const Clock::time_point now = Clock::now();
  for (const auto& viewer : std::vector(viewers)) {
    if (viewer->stuck(now)) viewer->drop();
  }
  if (!state.is_null() && now - state_sent >= kStateEvery) send_state(state);
  if (over) return;
  housekeeping.expires_after(kHousekeeping);
  housekeeping.async_wait([this](ErrorCode error) {
    if (!error && !over) keep_house();
  });
}

void Server::show(Frame&& frame) {
  bool post = false;
  {
    const std::lock_guard lock(mutex);
    wants = false;
    post = !shown.has_value();
    if (shown && spare.size() < 2) spare.push_back(std::move(*shown));
    shown = std::move(frame);
  }
  if (!post) return;
  net::post(io, [this] {
    std::optional<Frame> taken;
    {
      const std::lock_guard lock(mutex);
      taken.swap(shown);
    }
    if (!taken || over) return;
    Frame old = encoder.take(std::move(*taken));
    {
      const std::lock_guard lock(mutex);
      if (spare.size() < 2) spare.push_back(std::move(old));
    }
    plan();
  });
}

}  // namespace tandem::window
