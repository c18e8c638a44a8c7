#include "bridges/desk/lcm_desk.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <tandem/desk_command_t.hpp>
#include <tandem/desk_reply_t.hpp>

namespace tandem::bridges::desk {
namespace {

constexpr std::size_t kLongestAnswer = std::size_t{1} << 20;

std::uint64_t big_endian(std::span<const std::byte> data, std::size_t at, std::size_t bytes) noexcept {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < bytes; ++i) n = n << 8U | std::to_integer<std::uint64_t>(data[at + i]);
  return n;
}

/// The generated decoder takes lengths as they come, so all is walked through before.
bool is_sound(std::span<const std::byte> data, std::int64_t hash, std::size_t longest) noexcept {
  if (data.size() < 16 || big_endian(data, 0, 8) != static_cast<std::uint64_t>(hash)) return false;
  std::size_t at = 16;
  for (const std::size_t most : {kLongestWho, longest}) {
    if (data.size() - at < 4) return false;
    const auto length = static_cast<std::size_t>(big_endian(data, at, 4));  // with the zero at its end
    at += 4;
    if (length < 2 || length > most + 1 || data.size() - at < length) return false;
    const auto text = data.subspan(at, length);
    if (std::find(text.begin(), text.end(), std::byte{0}) != text.end() - 1) return false;
    at += length;
  }
  return at == data.size();
}

template <class Message>
bool decode(Message& message, std::span<const std::byte> data) {
  try {
    return message.decode(data.data(), 0, static_cast<int>(data.size())) >= 0;
  } catch (const std::exception&) {
    return false;
  }
}

template <class Message>
std::vector<std::byte> encode(const Message& message) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  (void)message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

/// Every character of a name for itself, in a regular expression.
std::string literal(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (std::string_view("\\^$.|?*+()[]{}").find(c) != std::string_view::npos) text += '\\';
    text += c;
  }
  return text;
}

}  // namespace

std::optional<DeskMessage> decode_command(std::span<const std::byte> data) {
  desk_command_t message;
  if (!is_sound(data, desk_command_t::getHash(), kLongestCommand) || !decode(message, data)) return {};
  return DeskMessage{message.number, message.who, message.command};
}
std::optional<DeskMessage> decode_reply(std::span<const std::byte> data) {
  desk_reply_t message;
  if (!is_sound(data, desk_reply_t::getHash(), kLongestAnswer) || !decode(message, data)) return {};
  return DeskMessage{message.number, message.who, message.answer};
}
std::vector<std::byte> encode_command(const DeskMessage& m) {
  desk_command_t message;
  message.number = m.number;
  message.who = m.who;
  message.command = m.text;
  return encode(message);
}
std::vector<std::byte> encode_reply(const DeskMessage& m) {
  desk_reply_t message;
  message.number = m.number;
  message.who = m.who;
  message.answer = m.text;
  return encode(message);
}

struct LcmDesk::State {
  std::shared_ptr<lcm_bus::LcmLink> link;
  std::string channel;
  std::mutex lock;  // held while `take` runs
  std::function<void(DeskMessage, Reply)> take;
  std::atomic<std::uint64_t> malformed{0};
};

hal::Result<std::unique_ptr<LcmDesk>> LcmDesk::open(const std::string& url, const std::string& channel,
                                                    std::function<void(DeskMessage, Reply)> take) {
  auto link = lcm_bus::LcmLink::open(url);
  if (!link.ok()) return link.error();
  return open(std::move(link).value(), channel, std::move(take));
}

hal::Result<std::unique_ptr<LcmDesk>> LcmDesk::open(std::shared_ptr<lcm_bus::LcmLink> link, const std::string& channel,
                                                    std::function<void(DeskMessage, Reply)> take) {
  auto state = std::make_shared<State>();
  state->link = std::move(link);
  state->channel = channel;
  state->take = std::move(take);
  // The link owns the handler: what it holds of the state must not own the link in turn.
  const std::weak_ptr<State> weak = state;
  const hal::Status subscribed = state->link->subscribe(literal(channel), [weak](const lcm_bus::LcmMessage& message) {
    const auto desk = weak.lock();
    if (desk == nullptr) return;
    auto command = decode_command(message.data);
    if (!command) {
      desk->malformed.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    const std::lock_guard hold(desk->lock);
    if (!desk->take) return;
    desk->take(*command, [weak, number = command->number, who = command->who](std::string answer) {
      const auto still = weak.lock();
      if (still != nullptr) (void)still->link->publish(still->channel + "/reply", encode_reply({number, who, answer}));
    });
  });
  if (!subscribed.ok()) return subscribed.error();
  if (const hal::Status started = state->link->start(); !started.ok()) return started.error();
  return std::unique_ptr<LcmDesk>(new LcmDesk(std::move(state)));
}

LcmDesk::~LcmDesk() {
  const std::lock_guard hold(state_->lock);
  state_->take = {};
}

std::uint64_t LcmDesk::malformed() const noexcept {
  return state_->malformed.load(std::memory_order_relaxed);
}

hal::Result<std::string> ask(const std::string& url, const std::string& channel, const DeskMessage& command,
                             std::chrono::milliseconds patience) {
  struct Waiting {
    std::mutex lock;
    std::condition_variable came;
    std::optional<std::string> answer;
  };
  const auto waiting = std::make_shared<Waiting>();
  auto opened = lcm_bus::LcmLink::open(url);
  if (!opened.ok()) return opened.error();
  const auto link = std::move(opened).value();
  const hal::Status subscribed =
      link->subscribe(literal(channel) + "/reply",
                      [waiting, number = command.number, who = command.who](const lcm_bus::LcmMessage& message) {
                        const auto reply = decode_reply(message.data);
                        if (!reply || reply->number != number || reply->who != who) return;
                        const std::lock_guard hold(waiting->lock);
                        waiting->answer = reply->text;
                        waiting->came.notify_all();
                      });
  if (!subscribed.ok()) return subscribed.error();
  if (const hal::Status started = link->start(); !started.ok()) return started.error();
  const std::vector<std::byte> bytes = encode_command(command);
  std::unique_lock hold(waiting->lock);
  if (!link->publish(channel, bytes)) return hal::Error{"the network does not take messages (" + link->url() + ")"};
  if (!waiting->came.wait_for(hold, patience, [&] { return waiting->answer.has_value(); }))
    return hal::Error{"nobody answers on " + link->url() + " channel '" + channel +
                      "': does the run's file have <desk lcm=…> with this address?"};
  return *waiting->answer;
}

}  // namespace tandem::bridges::desk
