#include "window/wire/client.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <cstring>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace tandem::window {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPatience = std::chrono::seconds(30);

hal::Result<int> connect_to(const std::string& host, std::uint16_t port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  if (::inet_pton(AF_INET, host.c_str(), &to.sin_addr) != 1) return hal::Error{"'" + host + "' is no IPv4 address"};
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return hal::Error{std::string("no socket: ") + std::strerror(errno)};
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    const std::string why = std::strerror(errno);
    ::close(socket);
    return hal::Error{host + " port " + std::to_string(port) + ": " + why};
  }
  const int yes = 1;
  (void)::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return socket;
}

bool send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

/// Appends what comes; 0: the end, -1: nothing in time.
int take_more(int socket, std::string& in, Clock::time_point until) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd poll{socket, POLLIN, 0};
    const int ready = ::poll(&poll, 1, static_cast<int>(std::max<std::int64_t>(left, 0)));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return -1;
    constexpr std::size_t kStep = std::size_t{256} << 10;
    const std::size_t before = in.size();
    in.resize(before + kStep);
    const ssize_t got = ::recv(socket, in.data() + before, kStep, 0);
    in.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got < 0 && errno == EINTR) continue;
    return got > 0 ? 1 : 0;
  }
}

int status_of(std::string_view head) {
  const std::size_t space = head.find(' ');
  return space == std::string_view::npos ? 0 : std::atoi(std::string(head.substr(space + 1, 3)).c_str());
}

std::optional<std::size_t> content_length(std::string_view head) {
  std::string lower(head);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::string_view name = "\r\ncontent-length:";
  const std::size_t at = lower.find(name);
  if (at == std::string::npos) return {};
  return static_cast<std::size_t>(std::atoll(lower.c_str() + at + name.size()));
}

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<std::uint8_t>(byte);
  return value;
}

}  // namespace

hal::Result<HttpAnswer> ask(const std::string& host, std::uint16_t port, const std::string& request) {
  const auto socket = connect_to(host, port);
  if (!socket.ok()) return socket.error();
  (void)send_all(socket.value(), request);
  std::string in;
  HttpAnswer answer;
  const auto until = Clock::now() + kPatience;
  for (;;) {
    const std::size_t end = in.find("\r\n\r\n");
    if (end != std::string::npos) {
      answer.head = in.substr(0, end + 2);
      const auto length = content_length(answer.head);
      if (length && in.size() >= end + 4 + *length) break;
    }
    if (take_more(socket.value(), in, until) <= 0) break;
  }
  ::close(socket.value());
  const std::size_t end = in.find("\r\n\r\n");
  if (end == std::string::npos) return hal::Error{"no answer of HTTP, but " + std::to_string(in.size()) + " bytes"};
  answer.head = in.substr(0, end + 2);
  answer.body = in.substr(end + 4);
  answer.status = status_of(answer.head);
  return answer;
}

hal::Result<Client> Client::connect(const std::string& address, const std::vector<std::string>& more_headers) {
  const std::string_view scheme = "http://";
  const std::size_t slash = address.find('/', scheme.size());
  const std::size_t colon = address.find(':', scheme.size());
  if (!address.starts_with(scheme) || slash == std::string::npos || colon == std::string::npos || colon > slash)
    return hal::Error{"'" + address +
                      "' is no address of a window: a run with --view prints it, as http://127.0.0.1:8080/?token=…"};
  const std::string host = address.substr(scheme.size(), colon - scheme.size());
  const auto port = static_cast<std::uint16_t>(std::atoi(address.c_str() + colon + 1));
  const auto socket = connect_to(host, port);
  if (!socket.ok()) return socket.error();
  Client client(socket.value());
  std::string request = "GET /ws" + address.substr(address.find('?', slash)) + " HTTP/1.1\r\nHost: " + host + ":" +
                        std::to_string(port) +
                        "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  for (const std::string& header : more_headers) request += header + "\r\n";
  if (!send_all(client.socket_, request + "\r\n")) return hal::Error{"the connection ended"};
  const auto until = Clock::now() + kPatience;
  std::size_t end = std::string::npos;
  while ((end = client.in_.find("\r\n\r\n")) == std::string::npos) {
    if (!client.fill(until)) return hal::Error{"no answer to the upgrade"};
  }
  if (const int status = status_of(client.in_); status != 101)
    return hal::Error{"the upgrade was refused: " + std::to_string(status)};
  client.in_.erase(0, end + 4);
  return client;
}

Client::Client(Client&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)),
      in_(std::move(other.in_)),
      fragments_(std::move(other.fragments_)),
      bytes_(other.bytes_) {}

Client& Client::operator=(Client&& other) noexcept {
  std::swap(socket_, other.socket_);
  std::swap(in_, other.in_);
  std::swap(fragments_, other.fragments_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

Client::~Client() {
  if (socket_ >= 0) ::close(socket_);
}

bool Client::fill(Clock::time_point until) {
  const std::size_t before = in_.size();
  const int got = take_more(socket_, in_, until);
  bytes_ += in_.size() - before;
  return got > 0;
}

std::optional<Client::Received> Client::receive(std::chrono::milliseconds patience) {
  const auto until = Clock::now() + patience;
  const auto more = [&](std::size_t bytes) {
    while (in_.size() < bytes) {
      const std::size_t before = in_.size();
      const int got = take_more(socket_, in_, until);
      bytes_ += in_.size() - before;
      if (got <= 0) return got;
    }
    return 1;
  };
  for (;;) {
    std::size_t head = 2;
    int got = more(head);
    std::uint64_t size = 0;
    if (got > 0) {
      size = static_cast<std::uint8_t>(in_[1]) & 127U;
      const std::size_t wide = size == 126 ? 2 : size == 127 ? 8 : 0;
      head += wide;
      got = more(head);
      if (got > 0 && wide > 0) size = big_endian(std::string_view(in_).substr(2, wide));
      if (got > 0) got = more(head + size);
    }
    if (got == 0) return Received{Received::Kind::Close, "", 1006};
    if (got < 0) return {};
    const auto first = static_cast<std::uint8_t>(in_[0]);
    std::string payload = in_.substr(head, size);
    in_.erase(0, head + size);
    const unsigned opcode = first & 15U;
    if (opcode == 9) {
      (void)send_frame(0x8A, payload);
    } else if (opcode == 8) {
      const int code = payload.size() >= 2 ? static_cast<int>(big_endian(payload.substr(0, 2))) : 1005;
      (void)send_frame(0x88, payload);
      return Received{Received::Kind::Close, payload.size() > 2 ? payload.substr(2) : "", code};
    } else if (opcode == 1 || opcode == 2 || opcode == 0) {
      fragments_ += payload;
      if ((first & 0x80U) == 0) continue;
      return Received{opcode == 2 ? Received::Kind::Binary : Received::Kind::Text, std::exchange(fragments_, {}), 0};
    }
  }
}

hal::Status Client::send(std::string_view text) {
  return send_frame(0x81, text);
}

hal::Status Client::send_frame(std::uint8_t first, std::string_view payload, bool masked) {
  std::string frame(1, static_cast<char>(first));
  const unsigned mask_bit = masked ? 0x80U : 0U;
  std::size_t wide = 0;
  if (payload.size() < 126) {
    frame += static_cast<char>(mask_bit | payload.size());
  } else {
    wide = payload.size() < 65536 ? 2 : 8;
    frame += static_cast<char>(mask_bit | (wide == 2 ? 126U : 127U));
  }
  for (std::size_t i = wide; i-- > 0;) frame += static_cast<char>(payload.size() >> (8 * i) & 255U);
  constexpr std::array<char, 4> kMask = {0x37, 0x5A, 0x11, 0x6C};
  if (masked) frame.append(kMask.data(), kMask.size());
  for (std::size_t i = 0; i < payload.size(); ++i)
    frame += masked ? static_cast<char>(payload[i] ^ kMask[i % 4]) : payload[i];
  return send_bytes(frame);
}

hal::Status Client::send_bytes(std::string_view bytes) {
  if (!send_all(socket_, bytes)) return hal::Error{"the connection ended"};
  return {};
}

}  // namespace tandem::window
