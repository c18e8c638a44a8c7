// Window: serves the page and talks to its viewers, on a thread of its own; steps never wait for viewers.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/json/json.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "window/frame.hpp"

namespace tandem::window {

struct WindowOptions {
  std::string address = "127.0.0.1";  ///< numbers, not a name; "0.0.0.0": all of this machine
  std::uint16_t port = 0;             ///< 0: any that is free
  double most_frames_per_s = 20.0;    ///< to one viewer, unless it asks for another rate
  std::vector<std::string> origins;   ///< besides the page's own: where pages may come from, "http://host:port"
  std::size_t most_viewers = 256;     ///< those above are refused
  hal::Log log;                       ///< called on the window's thread
};

/// What viewers want to see, all of them together.
struct Wishes {
  std::vector<std::string> layers;        ///< names
  bool all_robots = false;                ///< layers of everybody
  std::vector<std::string> layer_robots;  ///< ids, unless of everybody
  std::vector<std::string> inspected;     ///< ids
  std::vector<std::string> states;        ///< names of published states, of all robots
};

/// A file that is made when it is asked for. Empty content: there is none; then `error` says why.
struct WindowFile {
  std::string content, type, error;
};

using WindowReply = std::function<void(const hal::Json& answer)>;
using WindowFileReply = std::function<void(WindowFile file)>;

class Server;  // window/server.hpp

/// All members may be called from any thread.
class Window {
 public:
  /// Errors: a port that is taken, an address that this machine does not have, no random numbers.
  static hal::Result<std::unique_ptr<Window>> open(const WindowOptions& options);
  /// Viewers learn that the window closes.
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// "http://127.0.0.1:8123/?token=…": its opener is an operator.
  const std::string& address() const noexcept;
  /// The same with the token of viewers: its opener sees, and commands nothing but an emergency stop.
  const std::string& viewers_address() const noexcept;
  std::uint16_t port() const noexcept;

  /// Carries out commands that are not the window's own (rate, layers, inspect): called on the window's thread,
  /// must not wait; `reply` may be called on any thread, once, also when the viewer or the window is gone. "by" in the
  /// command is the window's word: {"role": "operator" or "viewer", "address": numbers}.
  void set_commands(std::function<void(hal::Json command, WindowReply reply)> take);
  /// Told of commands that were refused because a viewer may not say them: on the window's thread, must not wait.
  void on_refused(std::function<void(const hal::Json& command, const hal::Json& answer)> tell);
  /// Makes "picture.svg" and "picture.png": as `set_commands`.
  void set_pictures(std::function<void(const std::string& name, WindowFileReply reply)> make);
  /// Called on the window's thread when a viewer came or wishes changed: a frame is to be shown although nothing moved.
  void on_wish(std::function<void()> changed);

  /// Whether a viewer waits for a frame: one atomic read. False without viewers, and as long as the last frame is
  /// younger than viewers want.
  bool wants_frame() const noexcept;
  /// Whether anybody watches: one atomic read.
  bool watched() const noexcept;
  std::size_t viewers() const noexcept;
  /// Rises with every change of `wishes`: one atomic read.
  std::uint64_t wishes_version() const noexcept;
  Wishes wishes() const;
  /// An empty frame, with the memory of one that was shown.
  Frame spare_frame();
  /// Takes the frame; encoding and sending happen on the window's thread. A newer one replaces one that waits.
  void show(Frame&& frame);
  /// Takes a message for all viewers; those who come later get the last one of each "type", of "log" the last 1,000
  /// entries, of "panel" that of each layer. "inspection" and "states" go to those who asked for them, "panel" to those
  /// who look at its layer.
  void tell(hal::Json message);

 private:
  explicit Window(std::shared_ptr<Server> server);
  std::shared_ptr<Server> server_;  // replies that are still out hold it weakly
};

}  // namespace tandem::window
