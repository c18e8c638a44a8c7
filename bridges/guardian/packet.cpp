#include "bridges/guardian/packet.hpp"

#include <charconv>

namespace tandem::bridges::guardian {
namespace {

void put(std::string& out, std::string_view field) {
  out += std::to_string(field.size());
  out += ':';
  out += field;
}

/// Takes one field off `in`. False when there is none.
bool take(std::string_view& in, std::string& field) {
  std::size_t size = 0;
  const auto [end, error] = std::from_chars(in.data(), in.data() + in.size(), size);
  const auto digits = static_cast<std::size_t>(end - in.data());
  if (error != std::errc{} || digits >= in.size() || in[digits] != ':') return false;
  in.remove_prefix(digits + 1);
  if (size > in.size()) return false;
  field = in.substr(0, size);
  in.remove_prefix(size);
  return true;
}

}  // namespace

std::string encode(const Packet& packet) {
  std::string out(1, static_cast<char>(packet.word));
  const StopMessages& r = packet.robot;
  for (const std::string* field : {&r.robot, &r.kind, &r.link, &r.name, &r.body}) put(out, *field);
  put(out, std::to_string(r.version));
  put(out, encode(r.identity));
  put(out, packet.text);
  return out.size() <= kLongestPacket ? out : std::string();
}

std::optional<Packet> decode(std::string_view bytes) {
  if (bytes.empty()) return std::nullopt;
  Packet packet;
  packet.word = static_cast<Word>(bytes.front());
  bytes.remove_prefix(1);
  StopMessages& r = packet.robot;
  std::string version, who;
  for (std::string* field : {&r.robot, &r.kind, &r.link, &r.name, &r.body, &version, &who, &packet.text}) {
    if (!take(bytes, *field)) return std::nullopt;
  }
  auto identity = decode_identity(who);
  if (!identity) return std::nullopt;
  r.identity = std::move(*identity);
  const auto [end, error] = std::from_chars(version.data(), version.data() + version.size(), r.version);
  if (error != std::errc{} || end != version.data() + version.size() || !bytes.empty()) return std::nullopt;
  return packet;
}

}  // namespace tandem::bridges::guardian
