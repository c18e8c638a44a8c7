#include "bridges/desk/lcm_desk.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <set>
#include <tandem/desk_command_t.hpp>
#include <tandem/desk_reply_t.hpp>
#include <utility>

#include "hal/json/json.hpp"
#include "hal/printable.hpp"
#include "hal/token.hpp"

namespace tandem::bridges::desk {
namespace {

constexpr std::size_t kLongestAnswer = std::size_t{1} << 20;
constexpr std::size_t kMostRemembered = std::size_t{1} << 16;  // numbers; then the run takes another word
constexpr auto kRefusedPatience = std::chrono::seconds(1);     // anybody may refuse: who has the key may yet answer

std::uint64_t big_endian(std::span<const std::byte> data, std::size_t at, std::size_t bytes) noexcept {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < bytes; ++i) n = n << 8U | std::to_integer<std::uint64_t>(data[at + i]);
  return n;
}

/// The generated decoder takes lengths as they come, so all is walked through before.
bool is_sound(std::span<const std::byte> data, std::int64_t hash, std::size_t longest) noexcept {
  if (data.size() < 16 || big_endian(data, 0, 8) != static_cast<std::uint64_t>(hash)) return false;
  std::size_t at = 16;
  struct Text {
    std::size_t least, most;
  };
  for (const Text& one : {Text{1, kLongestWho}, Text{1, longest}, Text{0, kLongestProof}, Text{0, kLongestProof}}) {
    if (data.size() - at < 4) return false;
    const auto length = static_cast<std::size_t>(big_endian(data, at, 4));  // with the zero at its end
    at += 4;
    if (length < one.least + 1 || length > one.most + 1 || data.size() - at < length) return false;
    const auto text = data.subspan(at, length);
    if (std::find(text.begin(), text.end(), std::byte{0}) != text.end() - 1) return false;
    at += length;
  }
  return at == data.size();
}

template <class Message>
std::optional<DeskMessage> decode(std::span<const std::byte> data, std::string Message::*text, std::size_t longest) {
  if (!is_sound(data, Message::getHash(), longest)) return {};
  Message m;
  try {
    if (m.decode(data.data(), 0, static_cast<int>(data.size())) < 0) return {};
  } catch (const std::exception&) {
    return {};
  }
  return DeskMessage{m.number, m.who, m.*text, m.run, m.proof};
}

template <class Message>
std::vector<std::byte> encode(const DeskMessage& m, std::string Message::*text) {
  Message message;
  message.number = m.number;
  message.who = m.who;
  message.*text = m.text;
  message.run = m.run;
  message.proof = m.proof;
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
  return decode(data, &desk_command_t::command, kLongestCommand);
}

std::optional<DeskMessage> decode_reply(std::span<const std::byte> data) {
  return decode(data, &desk_reply_t::answer, kLongestAnswer);
}

std::vector<std::byte> encode_command(const DeskMessage& m) {
  return encode(m, &desk_command_t::command);
}

std::vector<std::byte> encode_reply(const DeskMessage& m) {
  return encode(m, &desk_reply_t::answer);
}

struct LcmDesk::State {
  /// What is wrong with a command; empty: nothing is, and it counts now. `again`: it only lacks the word of this run.
  std::string why_not(const DeskMessage& command, const DeskKey* key, bool& again);
  void reply(const DeskMessage& command, const DeskKey* key, const std::string& answer);
  void answer(const DeskMessage& command, const std::shared_ptr<State>& self);

  std::shared_ptr<lcm_bus::LcmLink> link;
  std::string channel;
  std::vector<DeskKey> keys;
  std::mutex lock;  // held while `take` runs
  Take take;
  std::mutex run_lock;  // guards the next two
  std::string run;
  std::set<std::pair<std::string, std::int64_t>> said;  // with this word
  std::atomic<std::uint64_t> malformed{0}, refused{0};
};

std::string LcmDesk::State::why_not(const DeskMessage& command, const DeskKey* key, bool& again) {
  const std::lock_guard hold(run_lock);
  if (key == nullptr) return "this run knows no key of '" + command.who + "'";
  again = command.run != run;
  if (again) return "say it again, with the word of this run";
  const std::string right =
      proof_of(key->secret, Way::Command, channel, run, command.number, command.who, command.text);
  if (!hal::same_token(command.proof, right))
    return "the proof is wrong: this run has another key of '" + command.who + "'";
  if (!said.emplace(command.who, command.number).second) return "this was said before";
  if (said.size() < kMostRemembered) return {};
  if (auto next = hal::make_token(); next.ok()) {
    run = std::move(next).value();
    said.clear();
  }
  return {};
}

void LcmDesk::State::reply(const DeskMessage& command, const DeskKey* key, const std::string& answer) {
  DeskMessage reply{command.number, command.who, answer, {}, {}};
  {
    const std::lock_guard hold(run_lock);
    reply.run = run;
  }
  if (key != nullptr)
    reply.proof = proof_of(key->secret, Way::Reply, channel, reply.run, reply.number, reply.who, reply.text);
  (void)link->publish(channel + "/reply", encode_reply(reply));
}

/// On the link's thread.
void LcmDesk::State::answer(const DeskMessage& command, const std::shared_ptr<State>& self) {
  const DeskKey* const key = key_of(keys, command.who);
  bool again = false;
  if (const std::string why = why_not(command, key, again); !why.empty()) {
    if (!again) refused.fetch_add(1, std::memory_order_relaxed);
    hal::Json refusal = {{"ok", false}, {"error", why}};
    if (again) refusal["again"] = true;
    return reply(command, key, hal::to_text(refusal));
  }
  const std::lock_guard hold(lock);
  if (!take) return;
  take(command, key->role, [weak = std::weak_ptr(self), command, key](const std::string& text) {
    if (const auto still = weak.lock(); still != nullptr) still->reply(command, key, text);
  });
}

hal::Result<std::unique_ptr<LcmDesk>> LcmDesk::open(const std::string& url, const std::string& channel,
                                                    std::vector<DeskKey> keys, Take take) {
  auto link = lcm_bus::LcmLink::open(url);
  if (!link.ok()) return link.error();
  return open(std::move(link).value(), channel, std::move(keys), std::move(take));
}

hal::Result<std::unique_ptr<LcmDesk>> LcmDesk::open(std::shared_ptr<lcm_bus::LcmLink> link, const std::string& channel,
                                                    std::vector<DeskKey> keys, Take take) {
  auto run = hal::make_token();
  if (!run.ok()) return run.error();
  auto state = std::make_shared<State>();
  state->link = std::move(link);
  state->channel = channel;
  state->keys = std::move(keys);
  state->take = std::move(take);
  state->run = std::move(run).value();
  // The link owns the handler: what it holds of the state must not own the link in turn.
  const std::weak_ptr<State> weak = state;
  const hal::Status subscribed = state->link->subscribe(literal(channel), [weak](const lcm_bus::LcmMessage& message) {
    const auto desk = weak.lock();
    if (desk == nullptr) return;
    const auto command = decode_command(message.data);
    if (!command) {
      desk->malformed.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    desk->answer(*command, desk);
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

std::uint64_t LcmDesk::refused() const noexcept {
  return state_->refused.load(std::memory_order_relaxed);
}

namespace {

/// Answers to one command, as they come; of others nothing.
class Waiting {
 public:
  void take(const DeskMessage& reply) {
    const std::lock_guard hold(lock_);
    if (came_.size() < kMostAnswers) came_.push_back(reply);  // whoever else answers may be many
    arrived_.notify_all();
  }
  std::optional<DeskMessage> next(std::chrono::steady_clock::time_point until) {
    std::unique_lock hold(lock_);
    if (!arrived_.wait_until(hold, until, [&] { return !came_.empty(); })) return {};
    DeskMessage reply = std::move(came_.front());
    came_.pop_front();
    return reply;
  }

 private:
  static constexpr std::size_t kMostAnswers = 1000;
  std::mutex lock_;
  std::condition_variable arrived_;
  std::deque<DeskMessage> came_;
};

/// Whether a refusal asks for the word of the run. Anybody may have written it.
bool asks_again(const DeskMessage& reply) {
  const auto answer = hal::parse_json_object(reply.text);
  return answer.ok() && answer.value().contains("again") && answer.value()["again"] == true;
}

std::string error_in(const DeskMessage& reply) {
  const auto answer = hal::parse_json_object(reply.text);
  const bool said = answer.ok() && answer.value().contains("error") && answer.value()["error"].is_string();
  return said ? answer.value()["error"].get<std::string>() : "no reason";
}

}  // namespace

hal::Result<std::string> ask(const std::string& url, const std::string& channel, const DeskKey& key,
                             const DeskMessage& command, std::chrono::milliseconds patience) {
  const auto waiting = std::make_shared<Waiting>();
  auto opened = lcm_bus::LcmLink::open(url);
  if (!opened.ok()) return opened.error();
  const auto link = std::move(opened).value();
  const hal::Status subscribed = link->subscribe(
      literal(channel) + "/reply", [waiting, number = command.number, who = command.who](const lcm_bus::LcmMessage& m) {
        const auto reply = decode_reply(m.data);
        if (reply && reply->number == number && reply->who == who) waiting->take(*reply);
      });
  if (!subscribed.ok()) return subscribed.error();
  if (const hal::Status started = link->start(); !started.ok()) return started.error();
  DeskMessage said = command;
  const auto say = [&](const std::string& run) {
    said.run = run;
    said.proof = run.empty() ? "" : proof_of(key.secret, Way::Command, channel, run, said.number, said.who, said.text);
    return link->publish(channel, encode_command(said));
  };
  if (!say("")) return hal::Error{"the network does not take messages (" + link->url() + ")"};
  auto until = std::chrono::steady_clock::now() + patience;
  std::string refusal;
  while (const auto reply = waiting->next(until)) {
    const bool proved = hal::same_token(
        reply->proof, proof_of(key.secret, Way::Reply, channel, reply->run, reply->number, reply->who, reply->text));
    if (asks_again(*reply)) {
      if (reply->run != said.run && !reply->run.empty()) (void)say(reply->run);
    } else if (proved) {
      return reply->text;
    } else if (refusal.empty()) {
      refusal = error_in(*reply);
      until = std::min(until, std::chrono::steady_clock::now() + kRefusedPatience);
    }
  }
  if (!refusal.empty())
    return hal::Error{"whoever answers on " + link->url() + " channel '" + channel +
                      "' does not prove to have the key of '" + command.who +
                      "', and says: " + hal::printable(refusal)};
  return hal::Error{"nobody answers on " + link->url() + " channel '" + channel +
                    "': does the run's file have <desk lcm=…> with this address?"};
}

}  // namespace tandem::bridges::desk
