#include "window/window.hpp"

#include "hal/token.hpp"
#include "window/server.hpp"

namespace tandem::window {

Window::Window(std::shared_ptr<Server> server) : server_(std::move(server)) {}

Window::~Window() {
  server_->stop();
}

hal::Result<std::unique_ptr<Window>> Window::open(const WindowOptions& options) {
  auto token = hal::make_token(), viewers_token = hal::make_token();
  if (!token.ok()) return token.error();
  if (!viewers_token.ok()) return viewers_token.error();
  try {
    auto server = std::make_shared<Server>(options, std::move(token).value(), std::move(viewers_token).value());
    if (const hal::Status opened = server->open(); !opened.ok()) return opened.error();
    server->start();
    return std::unique_ptr<Window>(new Window(std::move(server)));
  } catch (const std::exception& e) {  // of Asio's: no more file descriptors or threads
    return hal::Error{std::string("window: ") + e.what()};
  }
}

const std::string& Window::address() const noexcept {
  return server_->address;
}
const std::string& Window::viewers_address() const noexcept {
  return server_->viewers_address;
}
std::uint16_t Window::port() const noexcept {
  return server_->port;
}
void Window::set_commands(std::function<void(hal::Json, WindowReply)> take) {
  const std::lock_guard lock(server_->mutex);
  server_->take_command = std::move(take);
}
void Window::on_refused(std::function<void(const hal::Json&, const hal::Json&)> tell) {
  const std::lock_guard lock(server_->mutex);
  server_->tell_refused = std::move(tell);
}
void Window::set_pictures(std::function<void(const std::string&, WindowFileReply)> make) {
  const std::lock_guard lock(server_->mutex);
  server_->picture_maker = std::move(make);
}
void Window::on_wish(std::function<void()> changed) {
  const std::lock_guard lock(server_->mutex);
  server_->on_wish = std::move(changed);
}
bool Window::wants_frame() const noexcept {
  return server_->wants.load(std::memory_order_relaxed);
}
bool Window::watched() const noexcept {
  return server_->viewer_count.load(std::memory_order_relaxed) != 0;
}
std::size_t Window::viewers() const noexcept {
  return server_->viewer_count.load(std::memory_order_relaxed);
}
std::uint64_t Window::wishes_version() const noexcept {
  return server_->wishes_version.load(std::memory_order_acquire);
}
Wishes Window::wishes() const {
  const std::lock_guard lock(server_->mutex);
  return server_->wishes;
}
Frame Window::spare_frame() {
  const std::lock_guard lock(server_->mutex);
  if (server_->spare.empty()) return {};
  Frame frame = std::move(server_->spare.back());
  server_->spare.pop_back();
  frame.clear();
  return frame;
}
void Window::show(Frame&& frame) {
  server_->show(std::move(frame));
}
void Window::tell(hal::Json message) {
  server_->tell(std::move(message));
}

}  // namespace tandem::window
