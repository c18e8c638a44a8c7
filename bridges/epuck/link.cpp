#include "bridges/epuck/link.hpp"

#include <string>

#include "bridges/link/link_text.hpp"
#include "bridges/link/permitted_link.hpp"
#include "bridges/link/tcp_link.hpp"

namespace tandem::bridges::epuck {
namespace {

constexpr std::uint32_t kBaud = 115200;  // of every stock firmware

hal::Result<EpuckLink> wifi_link(std::string_view endpoint, const LinkTerms& terms) {
  const auto parsed = parse_endpoint(kWifiScheme, endpoint, kWifiPort);
  if (!parsed.ok()) return parsed.error();
  const auto connect = [e = parsed.value()] {
    return TcpLink::connect(e, kWifiScheme, "is its selector at 15, and is it in this network?");
  };
  return EpuckLink{WireForm::Wifi, permitted(connect, terms.permit), parsed.value().port};
}

hal::Result<EpuckLink> tcp_link(const LinkAddress& address, const LinkTerms& terms) {
  const auto parsed = parse_endpoint("tcp", address.target);
  if (!parsed.ok()) return parsed.error();
  const auto connect = [e = parsed.value()] {
    return TcpLink::connect(e, "tcp", "is ser2net, or what else serves the robot's serial line, running there?");
  };
  return EpuckLink{WireForm::Serial, permitted(connect, terms.permit), parsed.value().port};
}

}  // namespace

hal::Result<EpuckLink> epuck_link(std::string_view text, const LinkTerms& terms) {
  const std::string prefix = std::string(kWifiScheme) + ":";
  if (text.starts_with(prefix)) return wifi_link(text.substr(prefix.size()), terms);
  const auto address = parse_link(text);
  if (!address.ok()) return hal::Error{address.error().message + ", " + prefix + "192.168.1.20"};
  if (address.value().scheme == LinkScheme::Tcp) return tcp_link(address.value(), terms);
  if (address.value().scheme != LinkScheme::Serial) {
    return hal::Error{"link '" + std::string(text) + "' does not carry an e-puck's bytes; use " + std::string(kLinks)};
  }
  if (address.value().rate != kBaud) {
    return hal::Error{"an e-puck's firmware talks with 115200 baud, not with " + std::to_string(address.value().rate) +
                      ": write serial:" + address.value().target + "@115200"};
  }
  auto open = byte_link_opener(address.value(), terms);
  if (!open.ok()) return open.error();
  return EpuckLink{WireForm::Serial, std::move(open).value(), 0};
}

}  // namespace tandem::bridges::epuck
