#include "bridges/desk/keys.hpp"

#include <algorithm>
#include <sys/stat.h>

#include "hal/input_file.hpp"
#include "hal/sha256.hpp"

namespace tandem::bridges::desk {
namespace {

constexpr std::string_view kBlank = " \t\r";

/// Takes the next word off the front; empty: there is none.
std::string_view next_word(std::string_view& line) {
  const std::size_t first = line.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return line = {};
  line.remove_prefix(first);
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

hal::Result<DeskKey> key_in(std::string_view line) {
  const std::string_view who = next_word(line), role = next_word(line), secret = next_word(line);
  if (secret.empty() || !next_word(line).empty()) return hal::Error{"a line is NAME ROLE SECRET"};
  if (role != "operator" && role != "viewer")
    return hal::Error{"'" + std::string(role) + "' is no role; there are operator and viewer"};
  if (secret.size() < kShortestSecret)
    return hal::Error{"the secret of '" + std::string(who) + "' is short: it has " + std::to_string(kShortestSecret) +
                      " characters or more, at random"};
  return DeskKey{std::string(who), role == "operator" ? hal::UserRole::Operator : hal::UserRole::Viewer,
                 std::string(secret)};
}

/// No two lists of fields look the same: each says how long it is.
void add(std::string& all, std::string_view field) {
  all += std::to_string(field.size());
  all += ':';
  all += field;
}

}  // namespace

hal::Result<std::vector<DeskKey>> parse_keys(std::string_view text) {
  std::vector<DeskKey> keys;
  for (int number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(kBlank) == std::string_view::npos) continue;
    auto key = key_in(line);
    const auto wrong = [number](const std::string& why) {
      return hal::Error{"line " + std::to_string(number) + ": " + why};
    };
    if (!key.ok()) return wrong(key.error().message);
    const bool twice = std::any_of(keys.begin(), keys.end(), [&](const DeskKey& k) { return k.who == key->who; });
    if (twice) return wrong("'" + key->who + "' has a key already");
    keys.push_back(std::move(key).value());
  }
  if (keys.empty()) return hal::Error{"there is no key; a line is NAME ROLE SECRET"};
  return keys;
}

hal::Result<std::vector<DeskKey>> read_keys(const std::string& path) {
  struct stat info {};
  const auto text = hal::read_whole_file(path, "the keys", kLongestKeyFile);
  if (!text.ok()) return text.error();
  if (::stat(path.c_str(), &info) != 0 || (info.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    return hal::Error{"the keys '" + path + "': others may read them: chmod 600 '" + path + "'"};
  auto keys = parse_keys(text.value());
  if (!keys.ok()) return hal::Error{"the keys '" + path + "': " + keys.error().message};
  return keys;
}

const DeskKey* key_of(const std::vector<DeskKey>& keys, std::string_view who) noexcept {
  const DeskKey* any = nullptr;
  for (const DeskKey& key : keys) {
    if (key.who == who) return &key;
    if (key.who == "*") any = &key;
  }
  return any;
}

std::string proof_of(std::string_view secret, Way way, std::string_view channel, std::string_view run,
                     std::int64_t number, std::string_view who, std::string_view text) {
  std::string all;
  add(all, way == Way::Command ? "command" : "reply");
  add(all, channel);
  add(all, run);
  add(all, std::to_string(number));
  add(all, who);
  add(all, text);
  return hal::hmac_sha256(secret, all);
}

}  // namespace tandem::bridges::desk
