// Visitor: one connection over HTTP, which is given the page, the floor and pictures, or becomes a viewer.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "window/network.hpp"
#include "window/page_files.hpp"
#include "window/wire/viewer_text.hpp"

namespace tandem::window {

class Server;
using Response = http::response<http::span_body<const char>>;

/// One connection that asks for files. Becomes a viewer when it asks for that.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  /// `address`: in numbers, where the connection comes from.
  Visitor(tcp::socket&& socket, Server& server, std::string address)
      : stream_(std::move(socket)), server_(server), address_(std::move(address)) {}
  ~Visitor();
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;
  void read();
  /// Ends the connection and leaves the server's list.
  void drop();
  const std::string& address() const noexcept { return address_; }
  void respond(http::status status, std::string_view type, std::shared_ptr<const std::string> content);

 private:
  void handle();
  void watch(UserRole role);
  void respond_page(const PageFile& file);
  void send(http::status status, std::string_view type, std::string_view content);
  Response head(http::status status) const;
  void write();
  void end();

  beast::tcp_stream stream_;
  Server& server_;
  std::string address_;
  beast::flat_buffer in_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<Response> response_;
  std::optional<http::response_serializer<http::span_body<const char>>> serializer_;
  std::shared_ptr<const std::string> content_;
  bool keep_alive_ = false;
  bool known_ = false;  // as an operator
};

}  // namespace tandem::window
