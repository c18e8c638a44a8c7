// Viewer: one browser's WebSocket, with what it wants to see and what waits to be sent to it.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "window/frame_encoder.hpp"
#include "window/network.hpp"
#include "window/wire/viewer_text.hpp"

namespace tandem::window {

class Server;

/// A speaker to the window: its role, and where its connection comes from, in numbers.
struct Speaker {
  UserRole role = UserRole::Viewer;
  std::string address;
};

/// One browser that watches. Used by the window's thread alone.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(tcp::socket&& socket, Server& server, std::uint64_t serial, Speaker speaker, Counted counted)
      : socket_(std::move(socket)),
        server_(server),
        serial_(serial),
        speaker_(std::move(speaker)),
        counted_(std::move(counted)) {}

  void accept(Request request);
  /// `kind`, when not empty: replaces one of the same kind that still waits.
  void send(Message message, const std::string& kind = {});
  void answer(const Json& id, const Json& answer);
  void answered() noexcept { --unanswered_; }
  /// Sends what there is to be sent, if nothing is on its way.
  void pump(Clock::time_point now);
  void close(websocket::close_code code, const std::string& why);
  void drop();

  std::uint64_t serial() const noexcept { return serial_; }
  UserRole role() const noexcept { return speaker_.role; }
  const std::string& address() const noexcept { return speaker_.address; }
  bool open() const noexcept { return open_ && !closing_; }
  bool stuck(Clock::time_point now) const noexcept;
  /// Whether it could take a frame now, and when it wants the next.
  bool takes_frames() const noexcept;
  Clock::time_point next_frame() const noexcept { return next_frame_; }
  std::uint32_t frame() const noexcept { return state_.frame; }
  const std::set<std::string>& layers() const noexcept { return layers_; }
  const std::vector<std::string>& layer_robots() const noexcept { return layer_robots_; }
  bool all_robots() const noexcept { return all_robots_; }
  const std::vector<std::string>& inspected() const noexcept { return inspected_; }
  /// The published state that it wants of all robots; empty: none.
  const std::string& state_shown() const noexcept { return state_shown_; }

 private:
  struct Queued {
    Message message;
    std::string kind;
  };
  void read();
  void took();
  void handle(const ViewerCommand& command);
  Json set_rate(const Json& command);
  Json set_layers(const Json& command);
  Json set_inspected(const Json& command);
  Json set_state_shown(const Json& command);
  void note_got(const Json& command);
  std::size_t unacknowledged() const noexcept { return acknowledges_ ? on_the_way_.size() : 0; }
  void gone();

  websocket::stream<beast::tcp_stream> socket_;
  Server& server_;
  std::uint64_t serial_;
  Speaker speaker_;
  Counted counted_;
  Request request_;
  beast::flat_buffer in_;
  bool open_ = false, closing_ = false, writing_ = false;
  Clock::time_point write_began_;
  std::deque<Queued> queue_;
  std::size_t queued_bytes_ = 0;
  ViewerState state_;
  Clock::time_point next_frame_;
  std::optional<double> rate_per_s_;
  bool acknowledges_ = false;
  std::deque<std::uint32_t> on_the_way_;  // frames
  std::set<std::string> layers_;
  bool all_robots_ = false;
  std::vector<std::string> layer_robots_, inspected_;
  std::string state_shown_;
  std::size_t unanswered_ = 0;
  Clock::time_point second_began_;
  int texts_in_second_ = 0;
};

}  // namespace tandem::window
