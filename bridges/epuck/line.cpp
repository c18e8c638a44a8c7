#include "bridges/epuck/line.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>

namespace tandem::bridges::epuck {
namespace {

constexpr std::string_view kGreeting = "\x0C\x07WELCOME";
constexpr std::string_view kVersionMark = "v,Version ";
constexpr std::string_view kHardwareMark = "HW version: ";

/// [GCtronic, EPFL, Webots] version strings of the firmwares in use. Any two differ in at least ten letters.
struct Known {
  std::string_view version;
  Firmware firmware;
};
constexpr std::array<Known, 4> kKnown = {{{"Version 2.0.0 January 2008", Firmware::BTcom},
                                          {"Version 1.2.2 August 2008 GCtronic", Firmware::GCtronic},
                                          {"Version 1.5.3 November 2016 (Webots)", Firmware::Webots},
                                          {"Version 2.0 January 2018 GCtronic", Firmware::Epuck2}}};
constexpr std::size_t kFewLetters = 4;

/// Letters to be inserted, taken away or changed to make one of the other [Levenshtein 1966].
std::size_t letters_apart(std::string_view a, std::string_view b) noexcept {
  std::array<std::size_t, 64> row{};
  if (b.size() >= row.size()) return row.size();
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

Firmware firmware_of(std::string_view version) noexcept {
  for (const Known& known : kKnown) {
    if (letters_apart(version, known.version) <= kFewLetters) return known.firmware;
  }
  if (version.find("Webots") != std::string_view::npos) return Firmware::Webots;
  if (version.starts_with("Version 2.0.0")) return Firmware::BTcom;
  if (version.starts_with("Version 2.")) return Firmware::Epuck2;
  if (version.find("GCtronic") != std::string_view::npos) return Firmware::GCtronic;
  return Firmware::Unknown;
}

}  // namespace

bool LineReader::push(std::uint8_t byte) noexcept {
  if (ended_) clear();
  if (byte == '\n') {
    while (size_ > 0 && text_[size_ - 1] == '\r') --size_;
    ended_ = true;
    return size_ > 0;
  }
  if (size_ == kCapacity) {
    // Keep the newest half: what is looked for stands at the end of a line, after rests of other answers.
    std::copy(text_.begin() + kCapacity / 2, text_.end(), text_.begin());
    size_ = kCapacity - kCapacity / 2;
    if (!cut_) ++cut_lines_;
    cut_ = true;
  }
  text_[size_++] = static_cast<char>(byte);
  return false;
}

void LineReader::clear() noexcept {
  size_ = 0;
  ended_ = false;
  cut_ = false;
}

bool firmware_fits(std::string_view wanted, Firmware firmware) noexcept {
  return wanted == "auto" || wanted.empty() || (wanted == "btcom" && firmware == Firmware::BTcom) ||
         (wanted == "gctronic" && firmware == Firmware::GCtronic) ||
         (wanted == "webots" && firmware == Firmware::Webots) || (wanted == "epuck2" && firmware == Firmware::Epuck2);
}

std::string_view firmware_name(Firmware firmware) noexcept {
  constexpr std::array<std::string_view, 5> kNames = {"unknown", "BTcom (EPFL)", "asercom (GCtronic)",
                                                      "asercom (Webots)", "asercom2 (e-puck2)"};
  return kNames[static_cast<std::size_t>(firmware)];
}

std::string_view Identity::version_text() const noexcept {
  return {version.data(), static_cast<std::size_t>(std::find(version.begin(), version.end(), '\0') - version.begin())};
}

bool is_known_version(std::string_view version) noexcept {
  return std::any_of(kKnown.begin(), kKnown.end(), [&](const Known& known) { return known.version == version; });
}

bool parse_version(std::string_view line, Identity& identity) noexcept {
  const std::size_t at = line.rfind(kVersionMark);
  if (at == std::string_view::npos) return false;
  const std::string_view version = line.substr(at + 2);
  identity = Identity{};
  identity.firmware = firmware_of(version);
  for (std::size_t i = 0; i < std::min(version.size(), identity.version.size() - 1); ++i) {
    identity.version[i] = version[i] >= ' ' && version[i] <= '~' ? version[i] : '?';
  }
  return true;
}

bool parse_hardware(std::string_view line, std::uint32_t& hardware) noexcept {
  if (!line.starts_with(kHardwareMark)) return false;
  line.remove_prefix(kHardwareMark.size());
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), hardware, 16);
  return error == std::errc{} && end == line.data() + line.size();
}

bool GreetingSpotter::push(std::uint8_t byte) noexcept {
  if (byte != static_cast<std::uint8_t>(kGreeting[matched_])) {
    matched_ = byte == static_cast<std::uint8_t>(kGreeting[0]) ? 1 : 0;
    return false;
  }
  if (++matched_ < kGreeting.size()) return false;
  matched_ = 0;
  return true;
}

}  // namespace tandem::bridges::epuck
