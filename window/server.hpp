// Server: listens, and joins visitors, viewers and the watched run.
//
//   Visitor (HTTP)  ->  Viewer (WebSocket)  <->  Server  <->  Window  <->  the run
//
// One thread of its own, "the window's", runs all that is done with the network.
#pragma once
#include <atomic>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "window/doorway.hpp"
#include "window/frame_encoder.hpp"
#include "window/network.hpp"
#include "window/window.hpp"
#include "window/wire/viewer_text.hpp"

namespace tandem::window {

class Viewer;
class Visitor;

class Server : public std::enable_shared_from_this<Server> {
 public:
  /// Frames name the floor's address with the token of viewers: everybody gets them.
  Server(WindowOptions options_given, std::string operators, std::string viewers_given)
      : options(std::move(options_given)),
        token(std::move(operators)),
        viewers_token(std::move(viewers_given)),
        encoder("&token=" + viewers_token) {}

  hal::Status open();  ///< takes the port
  void start();        ///< the thread
  void stop();

  // Any thread (server.cpp, server_messages.cpp).
  void show(Frame&& frame);
  void tell(Json message);

  // The window's thread: connections and frames (server.cpp).
  void accept();
  /// Of a request's token; none: it is neither.
  std::optional<UserRole> role_of(std::string_view given) const noexcept;
  /// Whether there is a place for one more viewer. The last ones are kept for operators.
  bool has_place(UserRole role) const noexcept;
  void enter(Visitor& visitor);
  void leave(const Visitor& visitor) noexcept;
  void come(std::shared_ptr<Viewer> viewer);
  void go(const Viewer& viewer);
  void plan();
  void keep_house();
  Clock::duration frame_interval() const { return interval_of(options.most_frames_per_s); }

  // The window's thread: what is told to viewers, and what they want (server_messages.cpp).
  void greet(Viewer& viewer);
  void told(Json message);
  void send_to_all(const Json& message, const std::string& type);
  void send_state(const Json& state);
  void send_inspection(const Json& message);
  void set_wishes();
  void wished();
  void carry_out(Viewer& viewer, const ViewerCommand& command);
  /// Why this role may not say anything like this command now; empty: nothing is in the way.
  std::string too_much(UserRole role, const std::string& command);
  std::shared_ptr<const std::string> floor_png(const FrameScene& scene);
  /// False: no pictures are made here.
  bool make_picture(const std::string& name, const std::shared_ptr<Visitor>& visitor);

  WindowOptions options;
  std::string token, viewers_token, address, viewers_address;
  std::uint16_t port = 0;
  Doorway doorway;

  std::list<Visitor*> visitors;   // without an operator's token, the one that waits longest first
  std::size_t viewer_places = 0;  // taken
  net::io_context io{1};          // its handlers hold visitors and viewers, which use what stands above
  tcp::acceptor acceptor{io};
  net::steady_timer frame_due{io}, housekeeping{io}, retry{io};
  std::thread thread;

  // Of the window's thread.
  FrameEncoder encoder;
  std::shared_ptr<const core::FloorImage> floor;  // that was packed last
  std::shared_ptr<const std::string> packed_floor;
  std::vector<std::shared_ptr<Viewer>> viewers;
  std::map<std::uint64_t, std::shared_ptr<Visitor>> waiting_for_picture;
  std::uint64_t serials = 0;
  bool over = false;
  std::map<std::string, std::shared_ptr<const std::string>> last;  // texts by type
  Json state;
  Clock::time_point state_sent, viewers_second;
  int viewers_said = 0, viewers_stopped = 0;  // commands of those who have that role, in this second
  std::deque<Json> log;
  std::vector<std::string> layer_names;

  // Of all threads.
  std::atomic<bool> wants{false};
  std::atomic<std::size_t> viewer_count{0};
  std::atomic<std::uint64_t> wishes_version{0};
  mutable std::mutex mutex;  // guards the rest
  Wishes wishes;
  std::function<void(Json, WindowReply)> take_command;
  std::function<void(const Json&, const Json&)> tell_refused;
  std::function<void(const std::string&, WindowFileReply)> picture_maker;
  std::function<void()> on_wish;
  std::optional<Frame> shown;  // waits to be encoded
  std::vector<Frame> spare;
};

}  // namespace tandem::window
