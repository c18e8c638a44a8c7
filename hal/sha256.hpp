// SHA-256, and HMAC by it: identifies files, and proves senders of messages.
#pragma once
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace tandem::hal {

/// Digest of some bytes, 64 hexadecimal digits [FIPS 180-4].
std::string sha256(std::string_view bytes);

/// Digest of a file. Error: that of `read_whole_file`.
Result<std::string> sha256_of_file(const std::string& path);

/// Keyed digest of a message, 64 hexadecimal digits [RFC 2104, RFC 4231]: only holders of the key can make it.
std::string hmac_sha256(std::string_view key, std::string_view message);

}  // namespace tandem::hal
