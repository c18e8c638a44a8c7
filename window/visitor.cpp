#include "window/visitor.hpp"

#include "window/doorway.hpp"
#include "window/server.hpp"
#include "window/viewer.hpp"

namespace tandem::window {
namespace {

constexpr std::size_t kHeaderBytes = std::size_t{8} << 10;

}  // namespace

Visitor::~Visitor() {
  server_.leave(*this);
}

void Visitor::drop() {
  server_.leave(*this);
  stream_.close();
}

void Visitor::read() {
  parser_.emplace();
  parser_->header_limit(kHeaderBytes);
  parser_->body_limit(0);
  stream_.expires_after(kRequestPatience);
  http::async_read(stream_, in_, *parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (error) return self->end();
    self->handle();
  });
}

void Visitor::handle() {
  const Request& request = parser_->get();
  keep_alive_ = request.keep_alive();
  const auto text = [](boost::string_view view) { return std::string(view.data(), view.size()); };
  const std::string target = text(request.target());
  const std::string host = text(request[http::field::host]), origin = text(request[http::field::origin]);
  const std::string_view path = path_of(target);
  const auto refuse = [&](http::status status, std::string why) {
    keep_alive_ = false;
    respond(status, "text/plain; charset=utf-8", shared(std::move(why) + "\n"));
  };
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return refuse(http::status::method_not_allowed, "GET and HEAD are understood.");
  if (request.count(http::field::host) > 1 || request.count(http::field::origin) > 1)
    return refuse(http::status::bad_request, "There is more than one Host or Origin in this request.");
  if (!server_.doorway.host_is_ours(host))
    return refuse(http::status::forbidden, "This window does not answer to the name '" + host +
                                               "'. Where it is reached by another name or through a proxy, start "
                                               "tandem with --view-origin http://" +
                                               host + ".");
  if (!server_.doorway.origin_is_ours(origin, host))
    return refuse(http::status::forbidden, "Pages of " + origin + " may not use this window (--view-origin).");
  const std::optional<UserRole> role = server_.role_of(query_value(target, "token"));
  known_ = known_ || role == UserRole::Operator;
  server_.leave(*this);
  if (!known_) server_.visitors.push_back(this);  // it waits anew; nobody takes the place of an operator
  if (path == "/favicon.ico") return respond(http::status::no_content, "", nullptr);
  const PageFile* const file = find_page_file(path == "/"            ? "/index.html"
                                              : path == "/projector" ? "/projector.html"
                                                                     : path);
  if (file != nullptr) return respond_page(*file);  // nothing of the run; it says when the token is wrong
  if (!role) {
    return refuse(http::status::forbidden,
                  "The token is missing or wrong: open the whole address that tandem printed, with what stands behind "
                  "'?'.");
  }
  if (path == "/ws") {
    if (!websocket::is_upgrade(request)) return refuse(http::status::upgrade_required, "This is for WebSockets.");
    if (!server_.has_place(*role)) return refuse(http::status::service_unavailable, "Too many viewers watch already.");
    return watch(*role);
  }
  if (path == "/floor.png") {
    const auto& scene = server_.encoder.frame().scene;
    if (scene != nullptr && scene->floor != nullptr)
      return respond(http::status::ok, "image/png", server_.floor_png(*scene));
  }
  if ((path == "/picture.svg" || path == "/picture.png") &&
      server_.make_picture(std::string(path.substr(1)), shared_from_this()))
    return;
  refuse(http::status::not_found, "There is no '" + std::string(path) + "' here.");
}

void Visitor::watch(UserRole role) {
  server_.leave(*this);
  const auto viewer = std::make_shared<Viewer>(stream_.release_socket(), server_, ++server_.serials,
                                               Speaker{role, address_}, Counted(server_.viewer_places));
  viewer->accept(parser_->release());
}

Response Visitor::head(http::status status) const {
  Response response{status, parser_->get().version()};
  response.set(http::field::server, "tandem");
  response.set(http::field::cache_control, "no-cache");
  response.set("Referrer-Policy", "no-referrer");  // the address holds the token
  response.set("X-Content-Type-Options", "nosniff");
  response.set("X-Frame-Options", "DENY");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Content-Security-Policy",
               "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; connect-src 'self' "
               "ws: wss:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
  response.keep_alive(keep_alive_);
  return response;
}

void Visitor::respond_page(const PageFile& file) {
  const Request& request = parser_->get();
  response_ = head(http::status::ok);
  response_->set(http::field::etag, boost::string_view(file.tag.data(), file.tag.size()));
  response_->set(http::field::vary, "Accept-Encoding");
  const auto known = request[http::field::if_none_match];
  if (std::string_view(known.data(), known.size()).find(file.tag) != std::string_view::npos) {
    response_->result(http::status::not_modified);
    return send(http::status::not_modified, "", "");
  }
  const auto accepted = request[http::field::accept_encoding];
  const bool packed = std::string_view(accepted.data(), accepted.size()).find("gzip") != std::string_view::npos;
  if (packed) response_->set(http::field::content_encoding, "gzip");
  send(http::status::ok, file.type, packed ? file.packed : file.content);
}

void Visitor::respond(http::status status, std::string_view type, std::shared_ptr<const std::string> content) {
  response_ = head(status);
  content_ = std::move(content);
  send(status, type, content_ != nullptr ? std::string_view(*content_) : std::string_view());
}

void Visitor::send(http::status status, std::string_view type, std::string_view content) {
  if (!type.empty()) response_->set(http::field::content_type, boost::string_view(type.data(), type.size()));
  const bool bodiless = status == http::status::no_content || status == http::status::not_modified;
  if (!bodiless) response_->content_length(content.size());
  const bool head_alone = parser_->get().method() == http::verb::head;
  if (!head_alone && !bodiless) response_->body() = {content.data(), content.size()};
  write();
}

void Visitor::write() {
  serializer_.emplace(*response_);
  stream_.expires_after(kResponsePatience);
  http::async_write(stream_, *serializer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (error || !self->keep_alive_) return self->end();
    self->content_.reset();
    self->read();
  });
}

void Visitor::end() {
  ErrorCode ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
}

}  // namespace tandem::window
