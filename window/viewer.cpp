#include "window/viewer.hpp"

#include <algorithm>

#include "hal/json/json_access.hpp"
#include "window/server.hpp"

namespace tandem::window {
namespace {

constexpr auto kWritePatience = std::chrono::seconds(10);  // then a viewer does not read any more
constexpr std::size_t kMostQueuedBytes = std::size_t{8} << 20;
constexpr std::size_t kMostQueued = 2000;
constexpr int kMostTextsPerSecond = 200;
constexpr std::size_t kMostUnanswered = 64;
constexpr std::size_t kMostUnacknowledged = 2;
constexpr std::size_t kMostInspected = 32;
constexpr double kSlowest_per_s = 0.1, kFastest_per_s = 60.0;

}  // namespace

void Viewer::accept(Request request) {
  request_ = std::move(request);
  beast::get_lowest_layer(socket_).expires_never();
  websocket::stream_base::timeout patience = websocket::stream_base::timeout::suggested(beast::role_type::server);
  patience.handshake_timeout = kRequestPatience;
  patience.idle_timeout = std::chrono::seconds(60);
  patience.keep_alive_pings = true;
  socket_.set_option(patience);
  socket_.set_option(websocket::stream_base::decorator(
      [](websocket::response_type& response) { response.set(http::field::server, "tandem"); }));
  socket_.read_message_max(kMostTextBytes);
  socket_.auto_fragment(false);
  socket_.async_accept(request_, [self = shared_from_this()](ErrorCode error) {
    if (error) return;
    self->open_ = true;
    self->next_frame_ = self->second_began_ = Clock::now();
    self->server_.come(self);
    self->read();
  });
}

void Viewer::read() {
  socket_.async_read(in_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (error) return self->gone();  // Beast has answered what breaks the protocol: 1002, 1007, 1009
    self->took();
    if (self->open()) self->read();
  });
}

void Viewer::took() {
  const Clock::time_point now = Clock::now();
  if (now - second_began_ >= std::chrono::seconds(1)) {
    second_began_ = now;
    texts_in_second_ = 0;
  }
  if (++texts_in_second_ > kMostTextsPerSecond)
    return close(websocket::close_code::policy_error, "more than 200 messages in a second");
  if (!socket_.got_text()) return close(websocket::close_code::unknown_data, "texts are understood, bytes are not");
  const auto bytes = in_.data();
  const auto command = read_viewer_text({static_cast<const char*>(bytes.data()), bytes.size()});
  in_.consume(bytes.size());
  if (!command.ok()) return close(websocket::close_code::bad_payload, command.error().message);
  handle(command.value());
}

void Viewer::handle(const ViewerCommand& command) {
  if (command.name == "got") return note_got(command.whole);
  if (command.name == "rate") return answer(command.id, set_rate(command.whole));
  if (command.name == "layers") return answer(command.id, set_layers(command.whole));
  if (command.name == "inspect") return answer(command.id, set_inspected(command.whole));
  if (command.name == "color_by") return answer(command.id, set_state_shown(command.whole));
  if (unanswered_ >= kMostUnanswered)
    return answer(command.id, refusal("too many commands wait for their answers; wait for some"));
  ++unanswered_;
  server_.carry_out(*this, command);
}

void Viewer::note_got(const Json& command) {
  acknowledges_ = true;
  const auto frame = command.find("frame");
  if (frame == command.end() || !frame->is_number_unsigned()) return;
  const auto number = frame->get<std::uint64_t>();
  while (!on_the_way_.empty() && on_the_way_.front() <= number) on_the_way_.pop_front();
  server_.plan();
}

Json Viewer::set_rate(const Json& command) {
  const double wanted = hal::number_of(command, "frames_per_s");
  if (!(wanted >= kSlowest_per_s && wanted <= kFastest_per_s))
    return refusal("\"frames_per_s\" must be a number from 0.1 to 60");
  rate_per_s_ = wanted;
  next_frame_ = Clock::now();
  server_.plan();
  return {{"ok", true}};
}

Json Viewer::set_layers(const Json& command) {
  const auto on = text_list(command, "on");
  if (!on.ok()) return refusal(on.error().message);
  for (const std::string& name : on.value()) {
    const std::vector<std::string>& known = server_.layer_names;
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string all;
    for (const std::string& other : known) all += (all.empty() ? "" : ", ") + other;
    return refusal("there is no layer '" + name + "'; there are: " + (all.empty() ? "none" : all));
  }
  if (const auto robots = command.find("robots"); robots != command.end()) {
    all_robots_ = robots->is_string() && robots->text() == "*";
    const auto ids = all_robots_ ? std::vector<std::string>() : text_list(command, "robots");
    if (!ids.ok()) return refusal(ids.error().message + " and not \"*\"");
    layer_robots_ = ids.value();
  }
  layers_ = std::set<std::string>(on.value().begin(), on.value().end());
  server_.wished();
  return {{"ok", true}};
}

Json Viewer::set_inspected(const Json& command) {
  auto robots = text_list(command, "robots");
  if (!robots.ok()) return refusal(robots.error().message);
  if (robots.value().size() > kMostInspected)
    return refusal("at most " + std::to_string(kMostInspected) + " robots can be looked into at once");
  inspected_ = std::move(robots).value();
  server_.wished();
  return {{"ok", true}};
}

Json Viewer::set_state_shown(const Json& command) {
  state_shown_ = hal::text_of(command, "state");
  server_.wished();
  return {{"ok", true}};
}

void Viewer::answer(const Json& id, const Json& answer) {
  if (id.is_null()) return;
  Json message = {{"type", "answer"}, {"id", id}};
  message.update(answer);
  send({shared(hal::to_text(message)), false});
}

void Viewer::send(Message message, const std::string& kind) {
  if (!open()) return;
  if (!kind.empty()) {
    for (std::size_t i = writing_ ? 1 : 0; i < queue_.size(); ++i) {
      if (queue_[i].kind != kind) continue;
      queued_bytes_ = queued_bytes_ - queue_[i].message.bytes->size() + message.bytes->size();
      queue_[i].message = std::move(message);
      return;
    }
  }
  queued_bytes_ += message.bytes->size();
  queue_.push_back({std::move(message), kind});
  if (queue_.size() > kMostQueued || (queue_.size() > 1 && queued_bytes_ > kMostQueuedBytes)) return drop();
  pump(Clock::now());
}

void Viewer::pump(Clock::time_point now) {
  if (!open() || writing_) return;
  const std::uint32_t newest = server_.encoder.number();
  if (queue_.empty() && state_.frame != newest && now >= next_frame_ && unacknowledged() < kMostUnacknowledged) {
    std::vector<std::uint32_t> on;
    for (std::uint32_t i = 0; i < server_.layer_names.size(); ++i) {
      if (layers_.contains(server_.layer_names[i])) on.push_back(i);
    }
    std::vector<Message> messages;
    server_.encoder.update(state_, on, messages);
    for (Message& message : messages) {
      queued_bytes_ += message.bytes->size();
      queue_.push_back({std::move(message), ""});
    }
    if (acknowledges_) on_the_way_.push_back(newest);
    const Clock::duration interval = rate_per_s_ ? interval_of(*rate_per_s_) : server_.frame_interval();
    next_frame_ = next_frame_ + interval > now ? next_frame_ + interval : now + interval;
  }
  if (queue_.empty()) return;
  writing_ = true;
  write_began_ = now;
  const Message& message = queue_.front().message;
  socket_.text(!message.binary);
  socket_.async_write(net::buffer(*message.bytes), [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->writing_ = false;
    if (error) return self->gone();
    self->queued_bytes_ -= self->queue_.front().message.bytes->size();
    self->queue_.pop_front();
    self->pump(Clock::now());
    if (!self->writing_) self->server_.plan();
  });
}

bool Viewer::stuck(Clock::time_point now) const noexcept {
  return writing_ && now - write_began_ > kWritePatience;
}

bool Viewer::takes_frames() const noexcept {
  return open() && !writing_ && unacknowledged() < kMostUnacknowledged;
}

void Viewer::close(websocket::close_code code, const std::string& why) {
  if (!open()) return;
  closing_ = true;
  constexpr std::size_t kMostWhy = 120;  // of the protocol: 123 bytes
  std::string told = why.substr(0, kMostWhy);
  std::replace_if(
      told.begin(), told.end(), [](unsigned char c) { return c >= 128 || c < 32; }, '?');
  socket_.async_close({code, told}, [self = shared_from_this()](ErrorCode) { self->gone(); });
}

void Viewer::drop() {
  ErrorCode ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
  gone();
}

void Viewer::gone() {
  closing_ = true;
  server_.go(*this);
}

}  // namespace tandem::window
