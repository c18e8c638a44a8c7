// ASCII lines of the e-puck's serial protocol: the firmware's identity and its greeting. They end with CR LF.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "bridges/epuck/codec.hpp"

namespace tandem::bridges::epuck {

/// Cuts a stream of bytes into lines. Holds the newest line until the next byte.
class LineReader {
 public:
  static constexpr std::size_t kCapacity = 160;  ///< longer ones are cut; the longest that matters has 88 bytes

  /// True when `byte` ended a line that is not empty; `line()` is then that line without its end.
  bool push(std::uint8_t byte) noexcept;
  std::string_view line() const noexcept { return {text_.data(), size_}; }
  std::uint64_t cut_lines() const noexcept { return cut_lines_; }
  void clear() noexcept;

 private:
  std::array<char, kCapacity> text_{};
  std::size_t size_ = 0;
  bool ended_ = false;
  bool cut_ = false;
  std::uint64_t cut_lines_ = 0;
};

enum class Firmware : std::uint8_t { Unknown, BTcom, GCtronic, Webots, Epuck2 };
std::string_view firmware_name(Firmware firmware) noexcept;
/// Whether `wanted`, as an experiment file says it (auto, btcom, gctronic, webots, epuck2), may be `firmware`.
bool firmware_fits(std::string_view wanted, Firmware firmware) noexcept;

/// Who answered to `V`. Fixed storage: made in the middle of a session.
struct Identity {
  Firmware firmware = Firmware::Unknown;
  std::array<char, 48> version{};  ///< text after "v,", ended by 0
  std::uint32_t hardware = 0;      ///< of the line "HW version"; 0: none came
  std::string_view version_text() const noexcept;
  bool is_epuck2() const noexcept { return firmware == Firmware::Epuck2; }
};
/// Whether this is, letter for letter, what a firmware in use says of itself.
bool is_known_version(std::string_view version) noexcept;
/// Finds "v,Version …" anywhere in the line (rests of other answers may stand before it). A few letters that were lost
/// or changed on the way do not hide a known firmware.
bool parse_version(std::string_view line, Identity& identity) noexcept;
/// "HW version: 1A", hexadecimal.
bool parse_hardware(std::string_view line, std::uint32_t& hardware) noexcept;

/// Spots the start of the greeting that the firmware sends once when it starts: FF BEL "WELCOME".
class GreetingSpotter {
 public:
  /// True when `byte` completes it.
  bool push(std::uint8_t byte) noexcept;

 private:
  std::size_t matched_ = 0;
};

}  // namespace tandem::bridges::epuck
