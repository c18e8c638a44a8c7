// A viewer without a browser, for measurements and tests: WebSocket over a plain socket, nothing of the server's code.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace tandem::window {

/// What a server answered to one request of HTTP.
struct HttpAnswer {
  int status = 0;
  std::string head;  ///< as it came, up to the empty line
  std::string body;
};

/// Sends `request` as it stands, and takes what comes back until the other side closes or has sent its Content-Length.
hal::Result<HttpAnswer> ask(const std::string& host, std::uint16_t port, const std::string& request);

class Client {
 public:
  struct Received {
    enum class Kind { Text, Binary, Close } kind = Kind::Text;
    std::string bytes;  ///< of a closing one: the reason
    int code = 0;       ///< of a closing one; 1006: the connection ended without one
  };

  /// `address` is that of Window::address. Errors: no server; the upgrade was refused, with the status.
  static hal::Result<Client> connect(const std::string& address, const std::vector<std::string>& more_headers = {});
  Client(Client&& other) noexcept;
  Client& operator=(Client&& other) noexcept;
  ~Client();

  /// The next message; nothing: none came in this time.
  std::optional<Received> receive(std::chrono::milliseconds patience);
  /// Error: the connection is gone.
  hal::Status send(std::string_view text);
  /// One frame of the protocol: its first byte (FIN and opcode), and its payload.
  hal::Status send_frame(std::uint8_t first, std::string_view payload, bool masked = true);
  hal::Status send_bytes(std::string_view bytes);
  /// All bytes that have come, frames' headers among them.
  std::uint64_t bytes_received() const noexcept { return bytes_; }

 private:
  explicit Client(int socket) : socket_(socket) {}
  bool fill(std::chrono::steady_clock::time_point until);

  int socket_ = -1;
  std::string in_;
  std::string fragments_;
  std::uint64_t bytes_ = 0;
};

}  // namespace tandem::window
