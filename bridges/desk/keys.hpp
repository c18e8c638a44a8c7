// Keys of people who command a run over a network, and the proofs that are made with them.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/user_role.hpp"

namespace tandem::bridges::desk {

struct DeskKey {
  std::string who;  ///< "*": the secret counts, by any name
  hal::UserRole role = hal::UserRole::Viewer;
  std::string secret;
};

inline constexpr std::size_t kShortestSecret = 16;
inline constexpr std::size_t kLongestKeyFile = std::size_t{64} << 10;

/// Reads lines "NAME ROLE SECRET", with "operator" or "viewer" for ROLE; "#" begins a comment. Errors, with the line:
/// something else, a short secret, a name twice, no key at all.
hal::Result<std::vector<DeskKey>> parse_keys(std::string_view text);
/// The same from a file. Errors besides: it cannot be read; others than its owner may read it.
hal::Result<std::vector<DeskKey>> read_keys(const std::string& path);

/// The key that `who` has, or anybody; null: none.
const DeskKey* key_of(const std::vector<DeskKey>& keys, std::string_view who) noexcept;

/// Which way a message goes.
enum class Way : std::uint8_t { Command, Reply };

/// The keyed digest of a message: nothing in it can be changed, sent another way, on another channel or to another run
/// without the secret.
std::string proof_of(std::string_view secret, Way way, std::string_view channel, std::string_view run,
                     std::int64_t number, std::string_view who, std::string_view text);

}  // namespace tandem::bridges::desk
