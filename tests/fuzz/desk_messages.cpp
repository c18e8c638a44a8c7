// Messages to a desk over LCM and files of keys, fed with anything: what is taken is a message, of just these bytes; a
// key has a name, a role and a secret that is long enough; a proof is right for its message alone.
//
// The first byte says whether it is a command or an answer, and whether the type's number and sound lengths are put
// before the rest.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "bridges/desk/keys.hpp"
#include "bridges/desk/lcm_desk.hpp"

namespace {

using namespace tandem::bridges::desk;

void feed(std::vector<std::byte> bytes, bool command) {
  const std::optional<DeskMessage> message = command ? decode_command(bytes) : decode_reply(bytes);
  if (!message) return;
  if (message->who.size() > kLongestWho || message->text.empty()) std::abort();
  if ((command ? encode_command(*message) : encode_reply(*message)) != bytes) std::abort();
}

void feed_keys(const std::string& text) {
  auto keys = parse_keys(text);
  if (!keys.ok()) return;
  if (keys->empty()) std::abort();
  for (const DeskKey& key : keys.value()) {
    if (key.who.empty() || key.secret.size() < kShortestSecret || key_of(keys.value(), key.who) != &key) std::abort();
  }
}

/// Moves a byte from one field to its neighbour: the same bytes in the same order are another message.
void feed_proof(const DeskMessage& m) {
  if (m.text.empty()) return;
  const auto proof = [](const DeskMessage& one) {
    return proof_of("a secret of some length", Way::Command, "channel", one.run, one.number, one.who, one.text);
  };
  DeskMessage moved = m;
  moved.who += moved.text.front();
  moved.text.erase(0, 1);
  if (proof(m) == proof(moved) || proof(m) != proof(DeskMessage(m))) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 3) return 0;
  const bool command = (data[0] & 1U) != 0;
  const std::string rest(data + 2, data + size);
  const std::size_t who = std::min<std::size_t>(data[1], rest.size());
  const DeskMessage whole{data[1], rest.substr(0, who), rest.substr(who), rest.substr(0, 32), rest.substr(0, 64)};
  feed_keys(rest);
  feed_proof(whole);
  std::vector<std::byte> bytes;
  if ((data[0] & 2U) != 0) {  // a message, of which some bytes are others
    bytes = command ? encode_command(whole) : encode_reply(whole);
    if ((data[0] & 4U) != 0) bytes[data[size - 1] % bytes.size()] ^= std::byte{data[0]};
    if ((data[0] & 8U) != 0) bytes.resize(bytes.size() - data[size - 1] % bytes.size());
  } else {
    if ((data[0] & 4U) != 0) {
      bytes = command ? encode_command(whole) : encode_reply(whole);
      bytes.resize(8);  // the type's number
    }
    for (const char c : rest) bytes.push_back(static_cast<std::byte>(c));
  }
  feed(std::move(bytes), command);
  return 0;
}
