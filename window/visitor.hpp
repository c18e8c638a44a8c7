// Visitor: one connection over HTTP, which is given the page, the floor and pictures, or becomes a viewer.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "window/network.hpp"
#include "window/page_files.hpp"

namespace tandem::window {

class Server;
using Response = http::response<http::span_body<const char>>;

/// One connection that asks for files. Becomes a viewer when it asks for that.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(tcp::socket&& socket, Server& server, Counted counted)
      : stream_(std::move(socket)), server_(server), counted_(std::move(counted)) {}
  void read();
  void respond(http::status status, std::string_view type, std::shared_ptr<const std::string> content);

 private:
  void handle();
  void respond_page(const PageFile& file);
  void send(http::status status, std::string_view type, std::string_view content);
  Response head(http::status status) const;
  void write();
  void end();

  beast::tcp_stream stream_;
  Server& server_;
  Counted counted_;
  beast::flat_buffer in_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<Response> response_;
  std::optional<http::response_serializer<http::span_body<const char>>> serializer_;
  std::shared_ptr<const std::string> content_;
  bool keep_alive_ = false;
};

}  // namespace tandem::window
