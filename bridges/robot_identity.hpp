// Identity of a real robot: which device it answers over, and every word by which it can be told from another one.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tandem::bridges {

/// What is not known, or what such hardware does not tell, is absent: never an empty text, never zero.
struct RobotIdentity {
  std::string link;                   ///< LINK text as written, with absolute paths
  std::optional<std::string> device;  ///< that the link leads to, as resolved (link/device.hpp); absent: not open
  std::optional<std::string> firmware = {};  ///< as it calls itself
  std::optional<std::string> hardware = {};  ///< its version, or a serial number
  std::optional<std::string> address = {};   ///< on a bus or radio that several share: "node 34"
  std::optional<std::string> name = {};      ///< as it calls itself
  std::uint64_t session = 0;                 ///< how often the device was opened; 0: never

  friend bool operator==(const RobotIdentity&, const RobotIdentity&) = default;
};

/// The first word by which two identities are of different robots, for people: "firmware: 'e-puck 1.3' was armed,
/// 'asercom 2.0' answers". Empty: none. A word that only one of them has differs too. The link's text and the session
/// are no words: one device has many names, and one robot answers in many sessions.
std::string difference(const RobotIdentity& armed, const RobotIdentity& answers);
/// The same, but a word that only one of them has says nothing: one may not have answered yet.
std::string contradiction(const RobotIdentity& armed, const RobotIdentity& answers);

/// Its words for people, "Version 1.2.2 August 2008 GCtronic, hardware 1A"; empty: it has not answered.
std::string to_text(const RobotIdentity& identity);

/// One line of printable text without spaces, for lock files and packets.
std::string encode(const RobotIdentity& identity);
/// Nothing where `text` is none of those lines.
std::optional<RobotIdentity> decode_identity(std::string_view text);

}  // namespace tandem::bridges
